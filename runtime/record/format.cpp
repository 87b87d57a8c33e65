#include "runtime/record/format.hpp"

#include "schema/fnv1a.hpp"

namespace wale::recording_format {

TickEntry encode(const RecordedTick& tick, std::uint64_t number) noexcept {
  TickEntry entry{.sequence = number + 1,
                  .period = tick.period,
                  .lateness = tick.lateness,
                  .counts = {tick.counts.x, tick.counts.y},
                  .velocity = {tick.velocity.x, tick.velocity.y},
                  .wanted = {tick.wanted.x, tick.wanted.y},
                  .commanded = {tick.commanded.x, tick.commanded.y},
                  .force = {tick.force.x, tick.force.y},
                  .interaction = {tick.interaction.x, tick.interaction.y},
                  .elapsed = tick.elapsed,
                  .skipped = tick.skipped,
                  .revision = tick.revision,
                  .patch = tick.patch,
                  .flags = static_cast<std::uint32_t>(tick.contact) | (tick.button ? button_flag : 0) |
                           (tick.inside ? inside_flag : 0) | tick.guards << guards_shift};
  entry.check = check_of(entry);
  return entry;
}

RecordedTick decode(const TickEntry& entry) noexcept {
  const auto pair = [](const std::array<float, 2>& both) { return glm::vec2(both[0], both[1]); };
  return {.period = entry.period,
          .lateness = entry.lateness,
          .elapsed = entry.elapsed,
          .skipped = entry.skipped,
          .counts = {entry.counts[0], entry.counts[1]},
          .contact = static_cast<Contact>(entry.flags & contact_mask),
          .button = (entry.flags & button_flag) != 0,
          .inside = (entry.flags & inside_flag) != 0,
          .patch = entry.patch,
          .revision = entry.revision,
          .guards = entry.flags >> guards_shift,
          .velocity = pair(entry.velocity),
          .wanted = pair(entry.wanted),
          .commanded = pair(entry.commanded),
          .force = pair(entry.force),
          .interaction = pair(entry.interaction)};
}

std::uint64_t hash_of(std::span<const std::byte> bytes) noexcept {
  return Fnv1a<std::uint64_t>().take_all(bytes).hash();
}

}  // namespace wale::recording_format
