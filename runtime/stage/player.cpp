#include "runtime/stage/player.hpp"

#include <algorithm>
#include <utility>

namespace wale {
namespace {

/// s; a force that nobody renewed for longer has nothing to do any more with where the hand is.
constexpr double longest_hold = 0.02;

/// What stepped in between the two.
std::uint32_t guard_bits(const GuardCounts& before, const GuardCounts& after) noexcept {
  const auto bit = [](long then, long now, GuardBit guard) {
    return now > then ? static_cast<std::uint32_t>(guard) : 0u;
  };
  return bit(before.not_a_number, after.not_a_number, GuardBit::not_a_number) |
         bit(before.device_limit, after.device_limit, GuardBit::device_limit) |
         bit(before.user_limit, after.user_limit, GuardBit::user_limit) |
         bit(before.energy, after.energy, GuardBit::energy) |
         bit(before.passivity, after.passivity, GuardBit::passivity) | bit(before.slew, after.slew, GuardBit::slew) |
         bit(before.overrun, after.overrun, GuardBit::overrun) | bit(before.stale, after.stale, GuardBit::stale) |
         bit(before.lost, after.lost, GuardBit::lost) | bit(before.restored, after.restored, GuardBit::restored);
}

}  // namespace

PlacedPatches::PlacedPatches(PlacedPatch patch) {
  const PatchSize size = patch.bank.size();
  const PatchOutline outline{patch.position, size.width, size.height};
  front_most = std::make_shared<FrontMost>(std::span(&outline, 1));
  patches.push_back(std::make_shared<PlacedPatch>(std::move(patch)));
}

Player::Player(Device& device, Exchange<PlacedPatches>& patches, Record& record, std::size_t beats, double most_newton,
               TickSink* sink)
    : device_(device),
      patches_(patches),
      record_(record),
      sink_(sink),
      position_step_(device.profile().position_step()),
      filters_x_(device.profile()),
      filters_y_(device.profile()),
      guards_(device.profile(), most_newton) {
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
  if (inside_ != patch.memory.get()) {
    const bool stays = patch.memory->follows(inside_);
    patch.memory->enter(patch.bank, hand);
    patch.memory->succeed(stays);
  }
  guards_.allow(largest_potential_range(patch.bank), patch.bank.program().description().active_watt);
  const Force force = tick(patch.bank, *patch.memory, hand);
  restored_ += patch.memory->restored() - before;
  return force;
}

std::optional<Guards::Reason> Player::reason_to_cut(const Reading& reading, const Beat& beat) const noexcept {
  if (reading.contact == Contact::lost) return Guards::Reason::lost;
  if (reading.contact == Contact::stale) return Guards::Reason::stale;
  if (static_cast<double>(beat.skipped) * record_.seconds_per_tick > longest_hold) return Guards::Reason::overrun;
  return std::nullopt;
}

void Player::serve(const Beat& beat) noexcept {
  const GuardCounts before = guards();
  device_.elapse(beat.elapsed);
  const Reading reading = device_.sample();
  const glm::dvec2 position = glm::dvec2(reading.counts) * position_step_;
  Hand hand = this->hand(reading, beat);

  if (patches_.take()) guards_.slew();
  Force wanted(0);
  const Memory* inside = nullptr;
  std::uint32_t number = RecordedTick::no_patch;
  if (const PlacedPatches* all = reading.contact == Contact::good ? patches_.held() : nullptr) {
    if (PlacedPatch* patch = all->at(position)) {
      hand.position = glm::vec2(position - glm::dvec2(patch->position));
      wanted = feel(*patch, hand);
      inside = patch->memory.get();
      number = patch->number;
    }
  }
  if (inside != inside_) guards_.slew();
  inside_ = inside;
  const auto cut = reason_to_cut(reading, beat);
  const Force commanded = cut ? guards_.cut(*cut, position, beat.elapsed) : guards_(wanted, position, beat.elapsed);
  const Force force = device_.command(commanded);
  guards_.commanded(force);

  lateness_.add(beat.lateness);
  missed_ += beat.skipped;
  record_.ticks[served_++ % record_.ticks.size()] = {
      .time = hand.time,
      .position = hand.workspace,
      .velocity = hand.velocity,
      .force = force,
      .interaction = reading.interaction,
      .lateness = static_cast<float>(static_cast<double>(beat.lateness) * 1e-9),
      .skipped = static_cast<std::uint32_t>(beat.skipped),
      .inside = inside != nullptr};
  if (sink_ != nullptr) {
    const PlacedPatches* all = patches_.held();
    sink_->append({.period = beat.period,
                   .lateness = beat.lateness,
                   .elapsed = static_cast<std::uint32_t>(beat.elapsed),
                   .skipped = static_cast<std::uint32_t>(beat.skipped),
                   .counts = reading.counts,
                   .contact = reading.contact,
                   .button = reading.button,
                   .inside = inside != nullptr,
                   .patch = number,
                   .revision = all != nullptr ? all->revision : 0,
                   .guards = guard_bits(before, guards()),
                   .velocity = hand.velocity,
                   .wanted = wanted,
                   .commanded = commanded,
                   .force = force,
                   .interaction = reading.interaction});
  }
  latest_.store({.time = hand.time,
                 .ticks_run = static_cast<long>(served_),
                 .ticks_missed = missed_,
                 .position = hand.workspace,
                 .velocity = hand.velocity,
                 .force = force,
                 .inside = inside != nullptr});
}

GuardCounts Player::guards() const noexcept {
  GuardCounts counts = guards_.counts();
  counts.restored = restored_;
  return counts;
}

void Player::finish() {
  std::vector<TickRecord>& ticks = record_.ticks;
  if (served_ > ticks.size())
    std::rotate(ticks.begin(), ticks.begin() + static_cast<std::ptrdiff_t>(served_ % ticks.size()), ticks.end());
  else
    ticks.resize(served_);
}

}  // namespace wale
