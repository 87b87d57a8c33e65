#include "feeling/mouse_hand.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>

namespace sandpaper {
namespace {

constexpr double following_seconds = 0.02;  // a little more than the time between two reports of a mouse

std::uint64_t packed(glm::vec2 at) {
  return std::uint64_t{std::bit_cast<std::uint32_t>(at.x)} << 32 | std::bit_cast<std::uint32_t>(at.y);
}

glm::vec2 unpacked(std::uint64_t both) {
  return {std::bit_cast<float>(static_cast<std::uint32_t>(both >> 32)),
          std::bit_cast<float>(static_cast<std::uint32_t>(both))};
}

}  // namespace

MouseHand::MouseHand(wale::DeviceProfile profile) : profile_(std::move(profile)) {}

void MouseHand::move(glm::vec2 to) noexcept { target_.store(packed(to), std::memory_order_relaxed); }

void MouseHand::elapse(long periods) noexcept {
  const glm::dvec2 target = unpacked(target_.load(std::memory_order_relaxed));
  const double share = 1 - std::exp(-static_cast<double>(periods) / profile_.rate / following_seconds);
  position_ += share * (target - position_);
}

wale::Reading MouseHand::sample() noexcept {
  const double step = profile_.position_step(), reach = profile_.position_counts / 2;
  const auto counts = [&](double metres) {
    return static_cast<int>(std::lround(std::clamp(metres / step, -reach, reach)));
  };
  return {.counts = {counts(position_.x), counts(position_.y)}, .button = pressed_.load(std::memory_order_relaxed)};
}

wale::Force MouseHand::command(wale::Force force) noexcept { return force; }

}  // namespace sandpaper
