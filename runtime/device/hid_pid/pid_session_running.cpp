// What a session does while it runs: forces out, positions and telemetry in.

#include <algorithm>
#include <cmath>
#include <cstdlib>

#include "runtime/device/hid_pid/pid_session.hpp"

namespace wale::hid {
namespace {

double finite_or_none(double value) noexcept { return std::isnan(value) ? 0 : std::clamp(value, -1.0, 1.0); }

}  // namespace

void PidSession::command(glm::dvec2 force, std::int64_t now) noexcept {
  if (state_ != State::running) return;
  if (pending_) ++counts_.overwritten;
  wanted_ = {finite_or_none(force.x), finite_or_none(force.y)};
  pending_ = true;
  silent_ = false;
  commanded_ = now;
}

void PidSession::hush() noexcept {
  if (state_ != State::running || silent_) return;
  silent_ = true;
  ++counts_.silences;
  wanted_ = glm::dvec2(0);
  pending_ = true;
}

void PidSession::receive(std::span<const std::uint8_t> report, std::int64_t now, bool is_old) noexcept {
  if (state_ == State::over || !layout_) return;
  if (const auto input = decode_input(*layout_, report)) {
    input_ = *input;
    heard_ = now;
    bad_inputs_ = 0;
    ++counts_.inputs;
    return;
  }
  if (telemetry_ && take_telemetry(report)) {
    ++counts_.other_reports;
    return;
  }
  if (const auto state = decode_state(*layout_, report)) {
    ++counts_.other_reports;
    ++counts_.states;
    return is_old ? take_old_state(*state) : take_state(*state, now);
  }
  const bool is_numbered = layout_->input.id != 0;
  if (is_numbered && !report.empty() && report[0] != layout_->input.id && input_bytes_[report[0]] != 0 &&
      report.size() >= input_bytes_[report[0]]) {
    ++counts_.other_reports;
    return;
  }
  ++counts_.bad_inputs;
  if (++bad_inputs_ >= options_.most_bad_inputs && state_ == State::running) {
    lose("its input reports do not match its descriptor", Outcome::failed);
  }
}

std::optional<Transfer> PidSession::running_transfer(std::int64_t now) noexcept {
  if (now - commanded_ > microseconds(options_.command_silence)) hush();
  if (in_flight_ < options_.most_in_flight) {
    // An effect that is about to end comes first: this is rare, and an effect that has ended exerts no force.
    for (std::size_t i = 0; i < effects() && duration_ != endless && !silent_; ++i) {
      if (now < refresh_at_[i]) continue;
      started_[i] = now;
      refresh_at_[i] = now + microseconds(duration_ / 3);
      ++in_flight_;
      return output(encode_start(*layout_, blocks_[i], false), Transfer::Purpose::refresh);
    }
    if (auto transfer = force_transfer()) {
      ++in_flight_;
      return transfer;
    }
    if (auto transfer = telemetry_transfer(now)) {  // no other transfer is pending
      ++in_flight_;
      return transfer;
    }
  }
  if (now - heard_ > microseconds(options_.input_silence) && !poll_under_way_) {
    poll_under_way_ = true;
    heard_ = now;  // the next poll comes after another silence
    ++counts_.polls;
    return get_report(input_report, layout_->input, Transfer::Purpose::poll);
  }
  return look_transfer(now);
}

/// The effects have no force yet, and point where their packets have told.
void PidSession::open_gate() noexcept {
  const std::int64_t full = layout_->set_constant_force.full();
  if (arrangement_ == Arrangement::combined) {
    const Number& field = layout_->set_effect.direction[0];
    gate_ = ForceGate::of_one(options_.limits, full, layout_->set_effect.direction_step, field.maximum - field.minimum);
    return;
  }
  std::array<glm::dvec2, 2> directions{{{1, 0}, {0, 1}}};
  if (arrangement_ == Arrangement::by_direction)
    directions = {unit(told_direction(*layout_, toward_x)), unit(told_direction(*layout_, toward_y))};
  gate_ = ForceGate::of_two(options_.limits, full, directions);
}

/// The part of the newest command that the device does not have yet, as far as the gate lets it through.
std::optional<Transfer> PidSession::force_transfer() noexcept {
  pending_ = false;
  const auto change = gate_.next(wanted_);
  if (!change) return std::nullopt;
  Transfer transfer;
  if (change->turns) {
    ++counts_.directions_sent;
    transfer = output(turned_effect(0, change->direction), Transfer::Purpose::force);
  } else {
    ++counts_.forces_sent[change->effect];
    transfer =
        output(encode_constant_force(*layout_, blocks_[change->effect], change->magnitude), Transfer::Purpose::force);
  }
  transfer.effect = change->effect;
  return transfer;
}

/// The next of four questions: x and y of torque and position, in turns.
std::optional<Transfer> PidSession::telemetry_transfer(std::int64_t now) noexcept {
  if (!telemetry_ || options_.telemetry_period <= 0 || now < telemetry_at_) return std::nullopt;
  telemetry_at_ = now + microseconds(options_.telemetry_period);
  openffboard::Message question;
  question.instance = static_cast<std::uint8_t>(telemetry_->asked % 2);
  question.command = telemetry_->asked / 2 % 2 == 0 ? openffboard::torque_command : openffboard::position_command;
  ++telemetry_->asked;
  return output(openffboard::encode(question), Transfer::Purpose::telemetry);
}

/// Whether a report is the vendor's; if so, keeps its torques and positions.
bool PidSession::take_telemetry(std::span<const std::uint8_t> report) noexcept {
  const auto message = openffboard::decode(report);
  if (!message) return false;
  using openffboard::Type;
  if (message->type == Type::not_found || message->type == Type::error) ++telemetry_->refused;
  if (message->type != Type::request || message->class_id != openffboard::axis_class || message->instance > 1) {
    return true;
  }
  constexpr std::int64_t full = 32767;
  const auto told = static_cast<std::int32_t>(std::clamp(message->data, -full - 1, full));
  const std::size_t axis = message->instance;
  if (message->command == openffboard::torque_command) {
    telemetry_->torque[axis] = told;
    telemetry_->most_torque[axis] = std::max(telemetry_->most_torque[axis], std::abs(told));
  } else if (message->command == openffboard::position_command) {
    telemetry_->position[axis] = told;
  } else {
    return true;
  }
  ++telemetry_->answered;
  return true;
}

}  // namespace wale::hid
