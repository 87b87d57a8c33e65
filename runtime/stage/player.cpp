#include "runtime/stage/player.hpp"

#include <algorithm>
#include <utility>

namespace wale {
namespace {

/// s; a force that has been held for longer no longer fits the hand's position.
constexpr double longest_hold = 0.02;

/// The guards that acted between the two counts.
std::uint32_t guard_bits(const GuardCounts& before, const GuardCounts& after) noexcept {
  const auto bit = [](long then, long now, GuardBit guard) {
    return now > then ? static_cast<std::uint32_t>(guard) : 0u;
  };
  return bit(before.not_a_number, after.not_a_number, GuardBit::not_a_number) |
         bit(before.device_limit, after.device_limit, GuardBit::device_limit) |
         bit(before.user_limit, after.user_limit, GuardBit::user_limit) | bit(before.heat, after.heat, GuardBit::heat) |
         bit(before.energy, after.energy, GuardBit::energy) |
         bit(before.passivity, after.passivity, GuardBit::passivity) | bit(before.slew, after.slew, GuardBit::slew) |
         bit(before.overrun, after.overrun, GuardBit::overrun) | bit(before.stale, after.stale, GuardBit::stale) |
         bit(before.lost, after.lost, GuardBit::lost) | bit(before.restored, after.restored, GuardBit::restored);
}

PatchOutline outline_of(const PlacedPatch& patch, glm::vec2 position) {
  const PatchSize size = patch.bank.size();
  return {position, size.width, size.height, patch.layer};
}

}  // namespace

PlacedPatches::PlacedPatches()
    : patches_(std::make_shared<const Patches>()), staying_(std::make_shared<const FrontMost>()) {}

PlacedPatches::PlacedPatches(PlacedPatch patch) {
  take({std::make_shared<PlacedPatch>(std::move(patch))});
  arrange({});
}

void PlacedPatches::arrange(std::span<const MovedPatch> moving) {
  std::vector<PatchOutline> outlines;
  outlines.reserve(patches_->size());
  for (const auto& patch : *patches_) outlines.push_back(outline_of(*patch, patch->position));
  for (const MovedPatch& each : moving) outlines[each.number].width = -1;  // contains no point
  staying_ = std::make_shared<const FrontMost>(outlines);
  move(moving);
}

void PlacedPatches::move(std::span<const MovedPatch> moving) {
  moved_.assign(moving.begin(), moving.end());
  std::vector<PatchOutline> outlines;
  for (const MovedPatch& each : moved_) outlines.push_back(outline_of(*(*patches_)[each.number], each.position));
  moving_ = moved_.empty() ? nullptr : std::make_shared<const FrontMost>(outlines);
}

PlacedPatches::Found PlacedPatches::at(glm::dvec2 point) const noexcept {
  Found found;
  std::size_t number = 0;
  if (const std::uint32_t still = staying_->at(point); still != FrontMost::none) {
    number = still;
    found = {(*patches_)[still].get(), (*patches_)[still]->position};
  }
  const std::uint32_t place = moving_ ? moving_->at(point) : FrontMost::none;
  if (place == FrontMost::none) return found;
  const MovedPatch& moved = moved_[place];
  PlacedPatch* const patch = (*patches_)[moved.number].get();
  const bool in_front = found.patch == nullptr || patch->layer > found.patch->layer ||
                        (patch->layer == found.patch->layer && moved.number > number);
  return in_front ? Found{patch, moved.position} : found;
}

Player::Player(Device& device, Exchange<PlacedPatches>& patches, Record& record, std::size_t beats, double most_newton,
               bool real_time, TickSink* sink)
    : device_(device),
      patches_(patches),
      record_(record),
      sink_(sink),
      position_step_(device.profile().position_step()),
      filters_x_(device.profile()),
      filters_y_(device.profile()),
      guards_(device.profile(), most_newton),
      costs_(real_time) {
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
  guards_.allow(patch.potential_range, patch.bank.program().description().active_watt);
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
  costs_.begin();
  device_.elapse(beat.elapsed);
  const Reading reading = device_.sample();
  costs_.end(TickCosts::sample);
  const glm::dvec2 position = glm::dvec2(reading.counts) * position_step_;
  Hand hand = this->hand(reading, beat);

  patches_.take();
  const PlacedPatches* all = reading.contact == Contact::good ? patches_.held() : nullptr;
  const PlacedPatches::Found found = all ? all->at(position) : PlacedPatches::Found{};
  // Slew when the patch, its parameters, its program or its position changed. A new patch cannot have the address of
  // the last one, because that was not freed before the new one was made.
  if (found != felt_) guards_.slew();
  felt_ = found;
  costs_.end(TickCosts::find);
  Force wanted(0);
  if (found.patch) {
    hand.position = glm::vec2(position - glm::dvec2(found.position));
    wanted = feel(*found.patch, hand);
  }
  inside_ = found.patch ? found.patch->memory.get() : nullptr;
  costs_.end(TickCosts::program);
  const auto cut = reason_to_cut(reading, beat);
  const Force commanded = cut ? guards_.cut(*cut, position, beat.elapsed) : guards_(wanted, position, beat.elapsed);
  costs_.end(TickCosts::guard);
  const Force force = device_.command(commanded);
  guards_.commanded(force);
  costs_.end(TickCosts::command);
  note(beat, reading, hand, {wanted, commanded, force}, before);
  costs_.end(TickCosts::record);
  costs_.end_tick();
}

void Player::note(const Beat& beat, const Reading& reading, const Hand& hand, const Output& output,
                  const GuardCounts& before) noexcept {
  lateness_.add(beat.lateness);
  missed_ += beat.skipped;
  record_.ticks[served_++ % record_.ticks.size()] = {
      .time = hand.time,
      .position = hand.workspace,
      .velocity = hand.velocity,
      .force = output.exerted,
      .interaction = reading.interaction,
      .lateness = static_cast<float>(static_cast<double>(beat.lateness) * 1e-9),
      .skipped = static_cast<std::uint32_t>(beat.skipped),
      .inside = inside_ != nullptr};
  if (sink_ != nullptr) {
    const PlacedPatches* all = patches_.held();
    sink_->append({.period = beat.period,
                   .lateness = beat.lateness,
                   .elapsed = static_cast<std::uint32_t>(beat.elapsed),
                   .skipped = static_cast<std::uint32_t>(beat.skipped),
                   .counts = reading.counts,
                   .contact = reading.contact,
                   .button = reading.button,
                   .inside = inside_ != nullptr,
                   .patch = felt_.patch != nullptr ? felt_.patch->number : RecordedTick::no_patch,
                   .revision = all != nullptr ? all->revision : 0,
                   .guards = guard_bits(before, guards()),
                   .velocity = hand.velocity,
                   .wanted = output.wanted,
                   .commanded = output.commanded,
                   .force = output.exerted,
                   .interaction = reading.interaction});
  }
  latest_.store({.time = hand.time,
                 .ticks_run = static_cast<long>(served_),
                 .ticks_missed = missed_,
                 .position = hand.workspace,
                 .velocity = hand.velocity,
                 .force = output.exerted,
                 .inside = inside_ != nullptr});
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
