#include "runtime/stage/player.hpp"

#include <utility>

namespace wale {

PlacedPatches::PlacedPatches(PlacedPatch patch) {
  const PatchSize size = patch.bank.size();
  const PatchOutline outline{patch.position, size.width, size.height};
  front_most = std::make_shared<FrontMost>(std::span(&outline, 1));
  patches.push_back(std::make_shared<PlacedPatch>(std::move(patch)));
}

Player::Player(Device& device, Exchange<PlacedPatches>& patches, Record& record, std::size_t beats)
    : device_(device),
      patches_(patches),
      record_(record),
      position_step_(device.profile().position_step()),
      filters_x_(device.profile()),
      filters_y_(device.profile()),
      guards_(device.profile()) {
  record_.seconds_per_tick = 1 / device.profile().rate;
  record_.vibrates = device.profile().shaker.has_value();
  record_.ticks.resize(beats);
}

Hand Player::hand(const Reading& reading, const Beat& beat) noexcept {
  const auto x = filters_x_(reading.counts.x, beat.elapsed), y = filters_y_(reading.counts.y, beat.elapsed);
  const double speed = position_step_ / record_.seconds_per_tick, jolt = speed / record_.seconds_per_tick;
  return {.velocity = glm::vec2(glm::dvec2(x.velocity, y.velocity) * speed),
          .acceleration = glm::vec2(glm::dvec2(x.acceleration, y.acceleration) * jolt),
          .raw_velocity = glm::vec2(glm::dvec2(x.raw.velocity, y.raw.velocity) * speed),
          .raw_acceleration = glm::vec2(glm::dvec2(x.raw.acceleration, y.raw.acceleration) * jolt),
          .workspace = glm::vec2(glm::dvec2(reading.counts) * position_step_),
          .time = static_cast<double>(beat.period) * record_.seconds_per_tick,
          .button = reading.button};
}

Force Player::feel(PlacedPatch& patch, const Hand& hand) noexcept {
  const long before = patch.memory->restored();
  if (inside_ != patch.memory.get()) patch.memory->enter(patch.bank, hand);
  const Force force = tick(patch.bank, *patch.memory, hand);
  restored_ += patch.memory->restored() - before;
  return force;
}

void Player::serve(const Beat& beat) noexcept {
  device_.elapse(beat.elapsed);
  const Reading reading = device_.sample();
  const glm::dvec2 position = glm::dvec2(reading.counts) * position_step_;
  Hand hand = this->hand(reading, beat);

  if (patches_.take()) guards_.slew();
  Force wanted(0);
  const Memory* inside = nullptr;
  if (const PlacedPatches* all = patches_.held()) {
    if (PlacedPatch* patch = all->at(position)) {
      hand.position = glm::vec2(position - glm::dvec2(patch->position));
      wanted = feel(*patch, hand);
      inside = patch->memory.get();
    }
  }
  if (inside != inside_) guards_.slew();
  inside_ = inside;
  const Force force = device_.command(guards_(wanted));

  lateness_.add(beat.lateness);
  missed_ += beat.skipped;
  record_.ticks[served_++] = {.time = hand.time,
                              .position = hand.workspace,
                              .velocity = hand.velocity,
                              .force = force,
                              .interaction = reading.interaction,
                              .lateness = static_cast<float>(static_cast<double>(beat.lateness) * 1e-9),
                              .skipped = static_cast<std::uint32_t>(beat.skipped),
                              .inside = inside != nullptr};
  latest_.store({.time = hand.time,
                 .ticks_run = static_cast<long>(served_),
                 .ticks_missed = missed_,
                 .position = hand.workspace,
                 .velocity = hand.velocity,
                 .force = force,
                 .inside = inside != nullptr});
}

GuardCounts Player::guards() const {
  GuardCounts counts = guards_.counts();
  counts.restored = restored_;
  return counts;
}

void Player::finish() { record_.ticks.resize(served_); }

}  // namespace wale
