#include "runtime/device/hid_pid/pid_session.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <utility>

namespace wale::hid {
namespace {

// USB 2.0 section 9.4 and HID 1.11 section 7.2.
constexpr std::uint8_t get_descriptor = 6, get_report_request = 1, set_report_request = 9;
constexpr std::uint8_t standard_in = 0x81, class_in = 0xa1, class_out = 0x21;
constexpr std::uint16_t report_descriptor_type = 0x2200;
constexpr std::uint8_t input_report = 1, output_report = 2, feature_report = 3;

constexpr int most_load_attempts = 20;
constexpr double toward_x = 90, toward_y = 180;  // degrees
constexpr double degrees_per_radian = 180 / 3.14159265358979323846;

std::int64_t microseconds(double seconds) noexcept { return static_cast<std::int64_t>(seconds * 1e6); }

double finite_or_none(double value) noexcept { return std::isnan(value) ? 0 : std::clamp(value, -1.0, 1.0); }

}  // namespace

std::string_view in_words(Arrangement arrangement) noexcept {
  switch (arrangement) {
    case Arrangement::by_direction: return "one effect for each axis, by direction";
    case Arrangement::by_axis: return "one effect for each axis";
    case Arrangement::combined: break;
  }
  return "one effect, turned to the direction of the force";
}

PidSession::PidSession(const HidInterface& interface, const PidSessionOptions& options)
    : interface_(interface), options_(options) {
  options_.most_in_flight = std::max(1, options_.most_in_flight);
}

std::optional<Transfer> PidSession::next(std::int64_t now) noexcept {
  if (state_ == State::running) return running_transfer(now);
  // Nothing overtakes: a step waits until all before it has ended.
  const bool is_busy = step_under_way_ || in_flight_ > 0 || poll_under_way_ || look_under_way_;
  if (state_ == State::over || is_busy) return std::nullopt;
  auto transfer = step_transfer();
  while (!transfer && state_ != State::over && state_ != State::running) {  // steps that this device does not know
    advance(now);
    transfer = step_transfer();
  }
  step_under_way_ = transfer.has_value();
  return transfer;
}

std::optional<Transfer> PidSession::step_transfer() noexcept {
  const auto purpose = Transfer::Purpose::step;
  const auto feature_out = [&](const Packet& packet, std::uint8_t id) {
    Transfer transfer = output(packet, purpose);
    transfer.kind = Transfer::Kind::control_out;
    transfer.request_type = class_out;
    transfer.request = set_report_request;
    transfer.value = static_cast<std::uint16_t>(feature_report << 8 | id);
    transfer.index = interface_.number;
    transfer.length = packet.size;
    return transfer;
  };
  const auto control = [&](const Order& order) -> std::optional<Transfer> {
    if (!order) return std::nullopt;
    return output(encode_device_control(*layout_, order), purpose);
  };
  switch (step_) {
    case Step::read_descriptor: {
      Transfer transfer;
      transfer.kind = Transfer::Kind::control_in;
      transfer.request_type = standard_in;
      transfer.request = get_descriptor;
      transfer.value = report_descriptor_type;
      transfer.index = interface_.number;
      transfer.length = interface_.report_descriptor_bytes;
      return transfer;
    }
    case Step::read_pool:
      if (!layout_->pool) return std::nullopt;
      return get_report(feature_report, layout_->pool, purpose);
    case Step::reset:
      if (!options_.resets) return std::nullopt;
      return control(layout_->device_control.reset);
    case Step::enable: return control(layout_->device_control.enable_actuators);
    case Step::gain:
      if (!layout_->device_gain) return std::nullopt;
      return output(encode_full_gain(*layout_), purpose);
    case Step::create: return feature_out(encode_create_constant_force(*layout_), layout_->create_new_effect.id);
    case Step::load: return get_report(feature_report, layout_->block_load, purpose);
    case Step::set: return output(effect_packet(effect_), purpose);
    case Step::zero:
    case Step::leave_zero: return output(encode_constant_force(*layout_, blocks_[effect_], 0), purpose);
    case Step::start: return output(encode_start(*layout_, blocks_[effect_], duration_ == endless), purpose);
    case Step::leave_stop: return output(encode_stop(*layout_, blocks_[effect_]), purpose);
    case Step::leave_stop_all:
      if (options_.is_shared) return std::nullopt;
      return control(layout_->device_control.stop_all);
    case Step::leave_free:
      if (!layout_->block_free) return std::nullopt;
      return output(encode_block_free(*layout_, blocks_[effect_]), purpose);
    case Step::leave_disable:
      if (options_.is_shared) return std::nullopt;
      return control(layout_->device_control.disable_actuators);
    case Step::run:
    case Step::none: break;
  }
  return std::nullopt;
}

/// To the step after this one.
void PidSession::advance(std::int64_t now) noexcept {
  const auto each = [&](Step same, Step after) {  // for each effect, then on
    if (++effect_ < created_) {
      step_ = same;
    } else {
      effect_ = 0;
      step_ = after;
    }
  };
  switch (step_) {
    case Step::read_descriptor: step_ = Step::read_pool; break;
    case Step::read_pool: step_ = Step::reset; break;
    case Step::reset: step_ = Step::enable; break;
    case Step::enable: step_ = Step::gain; break;
    case Step::gain: step_ = Step::create; break;
    case Step::create: step_ = Step::load; break;
    case Step::load: step_ = created_ < effects() ? Step::create : Step::set; break;
    case Step::set: step_ = Step::zero; break;
    case Step::zero: step_ = Step::start; break;
    case Step::start:
      started_[effect_] = now;
      refresh_at_[effect_] = now + microseconds(duration_ / 3);
      each(Step::set, Step::run);
      if (step_ == Step::run) {
        state_ = State::running;
        commanded_ = heard_ = now;
        telemetry_at_ = now + microseconds(options_.telemetry_period);
        look_at_ = now + microseconds(options_.rival_check_period);
        last_load_ = blocks_[created_ - 1];
      }
      break;
    case Step::leave_zero: each(Step::leave_zero, Step::leave_stop); break;
    case Step::leave_stop: each(Step::leave_stop, Step::leave_stop_all); break;
    case Step::leave_stop_all: step_ = created_ > 0 ? Step::leave_free : Step::leave_disable; break;
    case Step::leave_free: each(Step::leave_free, Step::leave_disable); break;
    case Step::leave_disable:
    case Step::run:
    case Step::none:
      step_ = Step::none;
      state_ = State::over;
      break;
  }
}

void PidSession::finish(const Transfer& transfer, Outcome outcome, std::span<const std::uint8_t> answer,
                        std::int64_t now) {
  switch (transfer.purpose) {
    case Transfer::Purpose::step:
      step_under_way_ = false;
      // The session was stopped while this was on its way: the next step does not depend on its outcome.
      if (std::exchange(step_is_void_, false) && outcome != Outcome::gone) {
        if (outcome != Outcome::done && transfer.kind == Transfer::Kind::interrupt_out) out_failed_ = true;
        return;
      }
      break;
    case Transfer::Purpose::poll: poll_under_way_ = false; break;
    case Transfer::Purpose::look: look_under_way_ = false; break;
    default: --in_flight_; break;
  }
  if (state_ == State::over) return;
  if (outcome == Outcome::gone) return lose("it was unplugged", outcome);
  if (outcome != Outcome::done && transfer.kind == Transfer::Kind::interrupt_out) out_failed_ = true;
  if (transfer.purpose == Transfer::Purpose::step) return finish_step(outcome, answer, now);
  if (state_ != State::running) return;
  // Refusing to be asked is an answer, and some devices that send reports by themselves do.
  if (transfer.purpose == Transfer::Purpose::poll && outcome == Outcome::stalled) return;
  if (transfer.purpose == Transfer::Purpose::look && outcome != Outcome::done) return;  // nothing depends on it
  switch (outcome) {
    case Outcome::stalled: return lose("it refuses a report that its descriptor declares", outcome);
    case Outcome::timed_out: return lose("it does not answer in time", outcome);
    case Outcome::failed: return lose("a transfer failed", outcome);
    default: break;
  }
  switch (transfer.purpose) {
    case Transfer::Purpose::poll: receive(answer, now); break;
    case Transfer::Purpose::refresh: ++counts_.refreshes; break;
    case Transfer::Purpose::look: take_look(answer); break;
    default: break;
  }
}

void PidSession::finish_step(Outcome outcome, std::span<const std::uint8_t> answer, std::int64_t now) {
  if (state_ == State::leaving) {
    // It cannot be told more than it takes; one that answers nothing is not waited for any longer.
    if (outcome != Outcome::done && ++failures_leaving_ >= 3) step_ = Step::none;
    return advance(now);
  }
  const bool is_optional = step_ == Step::read_pool || step_ == Step::gain;
  if (step_ == Step::load) return finish_load(outcome, answer);
  if (outcome == Outcome::timed_out) return lose("it does not answer in time", outcome);
  if (outcome != Outcome::done && !is_optional) {
    return lose(step_ == Step::read_descriptor ? "it does not send its report descriptor"
                                               : "it refuses a report that its descriptor declares",
                outcome);
  }
  if (step_ == Step::read_descriptor) {
    learn(answer);
    if (state_ != State::setting_up) return;
  }
  if (step_ == Step::read_pool && outcome == Outcome::done && layout_->has_direction()) {
    if (decode_pool(*layout_, answer) == 1) arrangement_ = Arrangement::combined;
  }
  advance(now);
}

/// The answer to whether an effect was created.
void PidSession::finish_load(Outcome outcome, std::span<const std::uint8_t> answer) {
  using Status = BlockLoadAnswer::Status;
  if (outcome == Outcome::timed_out) return lose("it does not answer in time", outcome);
  if (outcome != Outcome::done) return lose("it does not report whether it has created an effect", outcome);
  const auto load = decode_block_load(*layout_, answer);
  if (!load) return lose("its answer about a new effect is malformed", Outcome::failed);
  switch (load->status) {
    case Status::pending:
      if (++load_attempts_ >= most_load_attempts)
        lose("it does not report whether it has created an effect", Outcome::failed);
      return;  // ask again
    case Status::failed: return lose("it cannot create a constant-force effect", Outcome::failed);
    case Status::full:
      if (created_ == 0) return lose("it has no room for an effect: another program may hold them", Outcome::failed, Code::unusable_device);
      if (!layout_->has_direction()) return lose("it has room for one effect only, and its effects have no direction", outcome, Code::unlike_device);
      arrangement_ = Arrangement::combined;
      step_ = Step::set;
      effect_ = 0;
      return;
    case Status::loaded: break;
  }
  const Number& index = layout_->set_constant_force.block_index;
  if (load->block_index < index.minimum || load->block_index > index.maximum ||
      (created_ > 0 && load->block_index == blocks_[0])) {
    return lose("its answer about a new effect is malformed", Outcome::failed);
  }
  blocks_[created_++] = load->block_index;
  load_attempts_ = 0;
  step_ = created_ < effects() ? Step::create : Step::set;
}

/// The report descriptor has come.
void PidSession::learn(std::span<const std::uint8_t> bytes) {
  if (bytes.size() < interface_.report_descriptor_bytes) {
    return refuse({Code::unlike_device, "its report descriptor is cut short"});
  }
  auto descriptor = parse_report_descriptor(bytes);
  if (!descriptor) return refuse(std::move(descriptor).error());
  auto found = find_pid_layout(*descriptor);
  if (!found) return refuse(std::move(found).error());
  layout_ = std::move(*found);
  if (openffboard::has_reports(*descriptor)) telemetry_.emplace();
  for (const Report& report : descriptor->reports) {
    if (report.kind == ReportKind::input && report.bytes() <= most_packet_bytes) {
      input_bytes_[report.id] = static_cast<std::uint8_t>(report.bytes());
    }
  }
  arrangement_ = layout_->has_direction() ? Arrangement::by_direction : Arrangement::by_axis;
  duration_ = endless;
  if (options_.effect_duration > 0) {
    const auto& field = layout_->set_effect.duration;
    duration_ =
        std::min(options_.effect_duration, static_cast<double>(field.maximum - 1) * layout_->set_effect.duration_step);
    if (duration_ <= 0) duration_ = layout_->set_effect.duration_step;
  }
}

void PidSession::refuse(Error error) {
  refusal_ = std::move(error.sentence);
  lose(refusal_, Outcome::failed, error.code);
}

void PidSession::lose(std::string_view reason, Outcome outcome) noexcept {
  lose(reason, outcome, outcome == Outcome::gone ? Code::lost_device : Code::failed_transfer);
}

void PidSession::lose(std::string_view reason, Outcome outcome, Code why) noexcept {
  if (state_ == State::over) return;
  if (!lost_ && state_ != State::leaving) {
    lost_ = true;
    reason_ = reason;
    why_ = why;
  }
  if (outcome == Outcome::gone) {
    lost_ = true;
    if (reason_.empty()) {
      reason_ = reason;
      why_ = why;
    }
    step_ = Step::none;
    state_ = State::over;
  } else {
    stop();
  }
}

void PidSession::stop() noexcept {
  if (state_ == State::over || state_ == State::leaving) return;
  wanted_ = glm::dvec2(0);
  pending_ = false;
  effect_ = 0;
  if (!layout_) {
    step_ = Step::none;
    state_ = State::over;
    return;
  }
  state_ = State::leaving;
  step_is_void_ = step_under_way_;
  step_ = created_ > 0 ? Step::leave_zero : Step::leave_stop_all;
}

void PidSession::command(glm::dvec2 force, std::int64_t now) noexcept {
  if (state_ != State::running) return;
  if (pending_) ++counts_.overwritten;
  wanted_ = {finite_or_none(force.x), finite_or_none(force.y)};
  pending_ = true;
  silent_ = false;
  commanded_ = now;
}

void PidSession::receive(std::span<const std::uint8_t> report, std::int64_t now) noexcept {
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
    return take_state(*state, now);
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
  if (now - commanded_ > microseconds(options_.command_silence) && !silent_) {
    silent_ = true;
    ++counts_.silences;
    wanted_ = glm::dvec2(0);
    pending_ = true;
  }
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
    if (auto transfer = telemetry_transfer(now)) {  // nothing else has to go now
      ++in_flight_;
      return transfer;
    }
  }
  if (now - heard_ > microseconds(options_.input_silence) && !poll_under_way_) {
    poll_under_way_ = true;
    heard_ = now;  // so that the next poll is another silence later
    ++counts_.polls;
    return get_report(input_report, layout_->input, Transfer::Purpose::poll);
  }
  return look_transfer(now);
}

/// Asks for Block Load, which names the effect that was created last, by any program.
std::optional<Transfer> PidSession::look_transfer(std::int64_t now) noexcept {
  if (!options_.is_shared || layout_->state || options_.rival_check_period <= 0) return std::nullopt;
  if (look_under_way_ || now < look_at_) return std::nullopt;
  look_under_way_ = true;
  look_at_ = now + microseconds(options_.rival_check_period);
  ++counts_.looks;
  return get_report(feature_report, layout_->block_load, Transfer::Purpose::look);
}

/// A block of ours that was given out again was freed before, which only a reset does: a device gives out no block that
/// is in use. A block that is not ours is another program's, which has the same right to it as we have to ours.
void PidSession::take_look(std::span<const std::uint8_t> answer) noexcept {
  const auto load = decode_block_load(*layout_, answer);
  if (!load || load->status != BlockLoadAnswer::Status::loaded) return;
  if (load->block_index != last_load_ && is_ours(load->block_index)) return dispossess();
  last_load_ = load->block_index;
}

bool PidSession::is_ours(std::uint8_t block) const noexcept {
  return std::find(blocks_.begin(), blocks_.begin() + static_cast<std::ptrdiff_t>(created_), block) !=
         blocks_.begin() + static_cast<std::ptrdiff_t>(created_);
}

/// Only what was seen to be true before counts when it turns false: firmware that never sets these bits is common.
void PidSession::take_state(const DeviceState& state, std::int64_t now) noexcept {
  if (!options_.is_shared || state_ != State::running) return;
  if (state.actuators_enabled) {
    if (!*state.actuators_enabled && actuators_seen_) return dispossess();
    actuators_seen_ = *state.actuators_enabled;
  }
  if (!state.effect_plays || !state.block_index) return;
  for (std::size_t i = 0; i < created_; ++i) {
    if (blocks_[i] != *state.block_index) continue;
    if (*state.effect_plays) {
      plays_seen_[i] = true;
      continue;
    }
    if (!plays_seen_[i] || silent_) continue;
    // The report of an end that came before our last start may still be on its way.
    constexpr std::int64_t grace = 20'000;  // microseconds
    if (now - started_[i] < grace) continue;
    const bool has_run_out = duration_ != endless && now - started_[i] > microseconds(0.9 * duration_);
    if (!has_run_out) return dispossess();
    refresh_at_[i] = now;
  }
}

/// The session no longer knows the device's state, and its blocks may belong to another program by now. So it sends
/// nothing more; effects of ours that still play end with their duration.
void PidSession::dispossess() noexcept {
  lost_ = true;
  reason_ = "another program has reset it or stopped its effects";
  why_ = Code::lost_device;
  step_ = Step::none;
  state_ = State::over;
}

/// The part of the newest command that the device does not have yet. The axes take turns.
std::optional<Transfer> PidSession::force_transfer() noexcept {
  const auto purpose = Transfer::Purpose::force;
  if (arrangement_ != Arrangement::combined) {
    for (std::size_t i = 0; i < 2; ++i) {
      const std::size_t effect = (turn_ + i) % 2;
      const double magnitude = effect == 0 ? wanted_.x : wanted_.y;
      const std::int64_t counts = magnitude_counts(*layout_, magnitude);
      if (counts == sent_[effect]) continue;
      sent_[effect] = counts;
      turn_ = 1 - effect;
      pending_ = false;
      ++counts_.forces_sent[effect];
      return output(encode_constant_force(*layout_, blocks_[effect], magnitude), purpose);
    }
    pending_ = false;
    return std::nullopt;
  }

  // One effect: turned by at most 90 degrees, the magnitude having the sign that this needs. A force along one line
  // turns nothing; while it turns, the last magnitude holds for one packet.
  double magnitude = std::min(1.0, std::sqrt(wanted_.x * wanted_.x + wanted_.y * wanted_.y));
  if (magnitude_counts(*layout_, magnitude) != 0) {
    double direction = std::atan2(wanted_.x, -wanted_.y) * degrees_per_radian;
    const double change = direction - direction_ - 360 * std::round((direction - direction_) / 360);
    if (std::abs(change) > 90) {
      direction += 180;
      magnitude = -magnitude;
    }
    const Packet turned = turned_effect(0, direction), before = turned_effect(0, direction_);
    if (!turned_ && turned.bytes != before.bytes) {
      direction_ = direction - 360 * std::floor(direction / 360);
      turned_ = true;
      pending_ = false;
      ++counts_.directions_sent;
      return output(turned, purpose);
    }
    if (turned_) {  // along the direction that was sent, also if the command has moved on
      const double radians = direction_ / degrees_per_radian;
      magnitude = wanted_.x * std::sin(radians) - wanted_.y * std::cos(radians);
    }
  }
  turned_ = false;
  pending_ = false;
  const std::int64_t counts = magnitude_counts(*layout_, magnitude);
  if (counts == sent_[0]) return std::nullopt;
  sent_[0] = counts;
  ++counts_.forces_sent[0];
  return output(encode_constant_force(*layout_, blocks_[0], magnitude), purpose);
}

/// The next question of four, x and y of torque and position in turns.
std::optional<Transfer> PidSession::telemetry_transfer(std::int64_t now) noexcept {
  if (!telemetry_ || options_.telemetry_period <= 0 || now < telemetry_at_) return std::nullopt;
  telemetry_at_ = now + microseconds(options_.telemetry_period);
  openffboard::Message question;
  question.instance = static_cast<std::uint8_t>(telemetry_->asked % 2);
  question.command = telemetry_->asked / 2 % 2 == 0 ? openffboard::torque_command : openffboard::position_command;
  ++telemetry_->asked;
  return output(openffboard::encode(question), Transfer::Purpose::telemetry);
}

/// Whether a report is the vendor's. Keeps the torques and positions in it.
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

Packet PidSession::turned_effect(std::size_t effect, double direction) const noexcept {
  return encode_set_effect(*layout_, {blocks_[effect], duration_, direction, true, false, false});
}

Packet PidSession::effect_packet(std::size_t effect) const noexcept {
  if (arrangement_ == Arrangement::by_axis) {
    return encode_set_effect(*layout_, {blocks_[effect], duration_, 0, false, effect == 0, effect == 1});
  }
  return turned_effect(effect, effect == 0 ? toward_x : toward_y);
}

Transfer PidSession::output(const Packet& packet, Transfer::Purpose purpose) const noexcept {
  Transfer transfer;
  transfer.purpose = purpose;
  transfer.data = packet;
  transfer.length = packet.size;
  // Every HID device takes reports by the control endpoint too: the way to stop one whose other endpoint has failed.
  if (!interface_.has_interrupt_out || out_failed_) {
    transfer.kind = Transfer::Kind::control_out;
    transfer.request_type = class_out;
    transfer.request = set_report_request;
    transfer.value = static_cast<std::uint16_t>(output_report << 8 |
                                                (layout_->set_effect.id != 0 ? packet.bytes[0] : std::uint8_t{0}));
    transfer.index = interface_.number;
  }
  return transfer;
}

Transfer PidSession::get_report(std::uint8_t kind, const PacketShape& shape, Transfer::Purpose purpose) const noexcept {
  Transfer transfer;
  transfer.kind = Transfer::Kind::control_in;
  transfer.purpose = purpose;
  transfer.request_type = class_in;
  transfer.request = get_report_request;
  transfer.value = static_cast<std::uint16_t>(kind << 8 | shape.id);
  transfer.index = interface_.number;
  transfer.length = shape.bytes;
  return transfer;
}

}  // namespace wale::hid
