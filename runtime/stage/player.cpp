#include "runtime/stage/player.hpp"

#include <cmath>

namespace wale {

Player::Player(Device& device, Exchange<PlacedPatch>& patches, Record& record, std::size_t beats)
    : device_(device),
      patches_(patches),
      record_(record),
      position_step_(device.profile().position_step()),
      filter_x_(device.profile()),
      filter_y_(device.profile()),
      guards_(device.profile()) {
  record_.seconds_per_tick = 1 / device.profile().rate;
  record_.ticks.resize(beats);
}

void Player::serve(const Beat& beat) noexcept {
  device_.elapse(beat.elapsed);
  const Reading reading = device_.sample();
  const glm::dvec2 counts_per_tick(filter_x_(reading.counts.x, beat.elapsed),
                                   filter_y_(reading.counts.y, beat.elapsed));
  const glm::dvec2 position = glm::dvec2(reading.counts) * position_step_;
  const glm::dvec2 velocity = counts_per_tick * (position_step_ / record_.seconds_per_tick);

  if (patches_.take()) guards_.slew();
  Force wanted(0);
  bool inside = false;
  if (PlacedPatch* patch = patches_.held()) {
    const Hand hand{glm::vec2(position - glm::dvec2(patch->position)), glm::vec2(velocity)};
    const PatchSize size = patch->bank.size();
    inside = std::abs(hand.position.x) <= size.width / 2 && std::abs(hand.position.y) <= size.height / 2;
    if (inside) wanted = tick(patch->bank, hand);
  }
  if (inside != inside_) guards_.slew();
  inside_ = inside;
  const Force force = device_.command(guards_(wanted));

  lateness_.add(beat.lateness);
  missed_ += beat.skipped;
  const double time = static_cast<double>(beat.period) * record_.seconds_per_tick;
  record_.ticks[served_++] = {.time = time,
                              .position = glm::vec2(position),
                              .velocity = glm::vec2(velocity),
                              .force = force,
                              .interaction = reading.interaction,
                              .lateness = static_cast<float>(static_cast<double>(beat.lateness) * 1e-9),
                              .skipped = static_cast<std::uint32_t>(beat.skipped),
                              .inside = inside};
  latest_.store({.time = time,
                 .ticks_run = static_cast<long>(served_),
                 .ticks_missed = missed_,
                 .position = glm::vec2(position),
                 .velocity = glm::vec2(velocity),
                 .force = force,
                 .inside = inside});
}

void Player::finish() { record_.ticks.resize(served_); }

}  // namespace wale
