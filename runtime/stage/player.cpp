#include "runtime/stage/player.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "runtime/machine/meet_edge.hpp"

namespace wale {
namespace {

/// s; a force that has been held for longer no longer fits the hand's position.
constexpr double longest_hold = 0.02;

constexpr std::size_t more_room = 20'000;  ///< beats: 1.3 MB, the work of a millisecond at most
constexpr std::size_t no_more_room = std::numeric_limits<std::size_t>::max();

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

bool all_finite(Force force) noexcept { return std::isfinite(force.x) && std::isfinite(force.y); }

}  // namespace

Reading Player::sound(Reading reading) noexcept {
  const auto is_place = [](int counts) { return counts >= -RecordedTick::most_counts && counts <= RecordedTick::most_counts; };
  if (!is_place(reading.counts.x) || !is_place(reading.counts.y)) {
    reading.contact = Contact::lost;
    reading.counts = counts_;
  }
  if (reading.contact != Contact::good && reading.contact != Contact::stale) reading.contact = Contact::lost;
  if (!all_finite(reading.interaction)) reading.interaction = Force(std::numeric_limits<float>::quiet_NaN());
  counts_ = reading.counts;
  return reading;
}

void Player::exerted(Force force) noexcept {
  if (!all_finite(force) || served_ == 0) return;
  guards_.commanded(force);
  newest().force = force;
  if (sink_ != nullptr) sink_->exerted(force);
  if (outlets_ == nullptr) return;
  state_.force = force;
  outlets_->state.store(state_);
}

Player::Player(Device& device, Exchange<PlacedPatches>& patches, Record& record, std::size_t beats, double most_newton,
               bool real_time, TickSink* sink, Outlets* outlets)
    : device_(device),
      patches_(patches),
      record_(record),
      beats_(beats),
      ring_(beats),
      sink_(sink),
      position_step_(device.profile().position_step()),
      filters_x_(device.profile()),
      filters_y_(device.profile()),
      guards_(device.profile(), most_newton),
      costs_(real_time),
      outlets_(outlets) {
  record_.seconds_per_tick = 1 / device.profile().rate;
  record_.vibrates = device.profile().shaker.has_value();
  record_.ticks.reserve(beats);
  ticks_ = record_.ticks.data();
  make_room();
}

bool Player::make_room() {
  std::size_t room = room_.load(std::memory_order_relaxed);
  if (room >= beats_) return false;  // or none is wanted any more
  const std::size_t more = std::min(beats_, room + more_room);
  record_.ticks.resize(more);  // allocates nothing
  return room_.compare_exchange_strong(room, more, std::memory_order_release) && more < beats_;
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

Force Player::feel(const PlacedPatch& patch, const Hand& hand) noexcept {
  const long before = patch.memory->restored();
  if (inside_ != patch.memory.get()) {
    const bool stays = patch.memory->follows(inside_);
    patch.memory->enter(patch.bank->registers, hand);
    patch.memory->succeed(stays);
  }
  guards_.allow(patch.potential_range, patch.bank->bank.program().description().active_watt);
  const Force force = tick(patch.bank->registers, *patch.memory, hand);
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
  const Reading reading = sound(device_.sample());
  costs_.end(TickCosts::sample);
  const glm::dvec2 position = glm::dvec2(reading.counts) * position_step_;
  Hand hand = this->hand(reading, beat);

  patches_.take();
  const PlacedPatches* all = reading.contact == Contact::good ? patches_.held() : nullptr;
  const PlacedPatch* const found = all ? all->at(position) : nullptr;
  // Slew when the patch, its parameters, its program or its position changed.
  const FeltPatch felt =
      found ? FeltPatch{found->number, found->generation, found->change, found->outline.position} : FeltPatch{};
  if (felt != felt_) guards_.slew();
  costs_.end(TickCosts::find);
  Force wanted(0);
  if (found) {
    hand.position = glm::vec2(position - glm::dvec2(found->outline.position));
    if (const Shape& shape = found->outline.shape; !shape.is_rectangle()) {
      const EdgeDistance edge = shape.edge(hand.position);
      meet_edge(hand, edge.metres, edge.slope);
    }
    wanted = feel(*found, hand);
  }
  // Another memory cannot have the address of this one: it is made before the control side gets this one back.
  inside_ = found ? found->memory.get() : nullptr;
  costs_.end(TickCosts::program);
  const auto cut = reason_to_cut(reading, beat);
  const Force commanded = cut ? guards_.cut(*cut, position, beat.elapsed) : guards_(wanted, position, beat.elapsed);
  costs_.end(TickCosts::guard);
  Force force = device_.command(commanded);
  if (!all_finite(force)) force = commanded;  // it does not know what it exerts
  guards_.commanded(force);
  costs_.end(TickCosts::command);
  if (outlets_ != nullptr) note_contacts(found, reading, hand, force);
  felt_ = felt;
  button_ = reading.button;
  note(beat, reading, hand, {wanted, commanded, force}, before);
  costs_.end(TickCosts::record);
  costs_.end_tick();
}

void Player::note(const Beat& beat, const Reading& reading, const Hand& hand, const Output& output,
                  const GuardCounts& before) noexcept {
  lateness_.add(beat.lateness);
  missed_ += beat.skipped;
  if (served_ < beats_ && ring_ == beats_) {
    std::size_t room = room_.load(std::memory_order_acquire);
    if (served_ >= room && room_.compare_exchange_strong(room, no_more_room)) ring_ = room;
  }
  ++served_;
  newest() = {
      .time = hand.time,
      .position = hand.workspace,
      .velocity = hand.velocity,
      .force = output.exerted,
      .interaction = reading.interaction,
      .lateness = static_cast<float>(static_cast<double>(beat.lateness) * 1e-9),
      .skipped = static_cast<std::uint32_t>(beat.skipped),
      .inside = inside_ != nullptr,
      .change = static_cast<std::uint32_t>(felt_.change),
      .patch = inside_ != nullptr ? patch_id(felt_.number, felt_.generation) : 0};
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
                   .patch = felt_.number,
                   .revision = all != nullptr ? all->revision : 0,
                   .guards = guard_bits(before, guards()),
                   .velocity = hand.velocity,
                   .wanted = output.wanted,
                   .commanded = output.commanded,
                   .force = output.exerted,
                   .interaction = reading.interaction});
  }
  if (outlets_ == nullptr) return;
  state_ = {.time = hand.time,
            .ticks_run = static_cast<long>(served_),
            .ticks_missed = missed_,
            .lateness = static_cast<double>(beat.lateness) * 1e-9,
            .position = hand.workspace,
            .velocity = hand.velocity,
            .force = output.exerted,
            .inside = inside_ != nullptr,
            .number = felt_.number,
            .generation = felt_.generation,
            .revision = patches_.held() != nullptr ? patches_.held()->revision : 0,
            .guards = guards()};
  outlets_->state.store(state_);
  outlets_->desk.serve(patches_.held());
}

void Player::note_contacts(const PlacedPatch* found, const Reading& reading, const Hand& hand, Force force) noexcept {
  if (!outlets_->wants_contacts.load(std::memory_order_relaxed)) return;
  const auto note = [&](ContactKind kind, std::uint32_t number, std::uint32_t generation) {
    outlets_->contacts.push({kind, number, generation, hand.time, hand.workspace, hand.velocity, force});
  };
  const bool was_on = felt_.number != RecordedTick::no_patch;
  const bool same = found && was_on && found->number == felt_.number && found->generation == felt_.generation;
  if (was_on && !same) note(ContactKind::leave, felt_.number, felt_.generation);
  if (!found) return;
  if (!same) note(ContactKind::enter, found->number, found->generation);
  if (reading.button != button_)
    note(reading.button ? ContactKind::press : ContactKind::release, found->number, found->generation);
}

GuardCounts Player::guards() const noexcept {
  GuardCounts counts = guards_.counts();
  counts.restored = restored_;
  return counts;
}

void Player::finish() {
  std::vector<TickRecord>& ticks = record_.ticks;
  ticks.resize(std::min(served_, ring_));
  if (served_ > ring_)
    std::rotate(ticks.begin(), ticks.begin() + static_cast<std::ptrdiff_t>(served_ % ring_), ticks.end());
}

}  // namespace wale
