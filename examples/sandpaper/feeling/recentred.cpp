#include "feeling/recentred.hpp"

#include <limits>

namespace sandpaper {
namespace {

std::uint64_t centre_word(glm::ivec2 counts) {
  return std::uint64_t{static_cast<std::uint32_t>(counts.x)} << 32 | static_cast<std::uint32_t>(counts.y);
}

glm::ivec2 centre_in(std::uint64_t both) {
  return {static_cast<std::int32_t>(both >> 32), static_cast<std::int32_t>(both & 0xffffffffu)};
}

/// A device may send any counts; the loop takes impossible ones as lost.
int difference(int counts, int centre) {
  const std::int64_t exact = std::int64_t{counts} - centre;
  return exact > std::numeric_limits<int>::max()   ? std::numeric_limits<int>::max()
         : exact < std::numeric_limits<int>::min() ? std::numeric_limits<int>::min()
                                                   : static_cast<int>(exact);
}

}  // namespace

glm::ivec2 Recentred::centre() const noexcept { return centre_in(centre_.load(std::memory_order_relaxed)); }

void Recentred::move_centre(glm::ivec2 counts) noexcept { centre_.store(centre_word(counts), std::memory_order_relaxed); }

wale::Reading Recentred::sample() noexcept {
  wale::Reading reading = device_->sample();
  const glm::ivec2 centre = this->centre();
  reading.counts = {difference(reading.counts.x, centre.x), difference(reading.counts.y, centre.y)};
  return reading;
}

}  // namespace sandpaper
