#include "runtime/device/hid_pid/pid_session.hpp"

#include <algorithm>
#include <utility>

namespace wale::hid {
namespace {

// USB 2.0 section 9.4 and HID 1.11 section 7.2.
constexpr std::uint8_t get_descriptor = 6, get_report_request = 1, set_report_request = 9;
constexpr std::uint8_t standard_in = 0x81, class_in = 0xa1, class_out = 0x21;
constexpr std::uint16_t report_descriptor_type = 0x2200;

constexpr int most_load_attempts = 20;

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
  options_.most_in_flight = std::clamp(options_.most_in_flight, 1, MayHold::most_on_their_way);
}

std::optional<Transfer> PidSession::next(std::int64_t now) noexcept {
  if (state_ == State::running) return running_transfer(now);
  // A step waits until all transfers before it have ended.
  const bool is_busy = step_under_way_ || in_flight_ > 0 || poll_under_way_ || look_under_way_;
  if (state_ == State::over || is_busy) return std::nullopt;
  if (step_ == Step::leave_wait) {
    if (now < look_at_) return std::nullopt;
    step_ = Step::leave_look;
  }
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
      // One that knows no reset may still play what a process has left that was killed.
      return control(layout_->device_control.reset ? layout_->device_control.reset : layout_->device_control.stop_all);
    case Step::enable: return control(layout_->device_control.enable_actuators);
    case Step::gain:
      if (!layout_->device_gain) return std::nullopt;
      return output(encode_full_gain(*layout_), purpose);
    case Step::create: return feature_out(encode_create_constant_force(*layout_), layout_->create_new_effect.id);
    case Step::load:
    case Step::leave_look: return get_report(feature_report, layout_->block_load, purpose);
    case Step::set: return output(effect_packet(effect_), purpose);
    case Step::zero:
    case Step::leave_zero: return output(encode_constant_force(*layout_, blocks_[effect_], Magnitude()), purpose);
    case Step::start: return output(encode_start(*layout_, blocks_[effect_], duration_ == endless), purpose);
    case Step::leave_stop: return output(encode_stop(*layout_, blocks_[effect_]), purpose);
    case Step::leave_stop_all:
      if (options_.is_shared) return std::nullopt;
      return control(layout_->device_control.stop_all);
    case Step::leave_free:
      if (!layout_->block_free) return std::nullopt;
      return output(encode_block_free(*layout_, blocks_[effect_]), purpose);
    case Step::leave_reset:
      if (options_.is_shared) return std::nullopt;
      return control(layout_->device_control.reset);
    case Step::leave_disable:  // last, because a reset enables the actuators (PID 1.0, section 5.7), and some devices
                               // then centre themselves
      if (options_.is_shared) return std::nullopt;
      return control(layout_->device_control.disable_actuators);
    case Step::run:
    case Step::leave_wait:
    case Step::none: break;
  }
  return std::nullopt;
}

/// Goes to the next step.
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
        open_gate();
        commanded_ = heard_ = now;
        telemetry_at_ = now + microseconds(options_.telemetry_period);
        look_at_ = now + microseconds(options_.rival_check_period);
        last_load_ = blocks_[created_ - 1];
      }
      break;
    case Step::leave_zero: each(Step::leave_zero, Step::leave_stop); break;
    case Step::leave_stop: each(Step::leave_stop, Step::leave_stop_all); break;
    case Step::leave_stop_all: step_ = created_ > 0 ? Step::leave_free : Step::leave_reset; break;
    case Step::leave_free: each(Step::leave_free, Step::leave_reset); break;
    case Step::leave_reset: step_ = Step::leave_disable; break;
    case Step::leave_look: step_ = Step::leave_zero; break;
    case Step::leave_wait:
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
      // The session was stopped while this transfer was under way: the next step does not depend on its outcome.
      if (std::exchange(step_is_void_, false) && outcome != Outcome::gone) {
        if (outcome != Outcome::done && transfer.kind == Transfer::Kind::interrupt_out) out_failed_ = true;
        return;
      }
      break;
    case Transfer::Purpose::poll: poll_under_way_ = false; break;
    case Transfer::Purpose::look: look_under_way_ = false; break;
    case Transfer::Purpose::force:
      if (outcome == Outcome::done) gate_.arrived(transfer.effect);  // otherwise the session ends without force
      [[fallthrough]];
    default: --in_flight_; break;
  }
  if (state_ == State::over) return;
  if (outcome == Outcome::gone) return lose("it was unplugged", outcome);
  if (outcome != Outcome::done && transfer.kind == Transfer::Kind::interrupt_out) out_failed_ = true;
  if (transfer.purpose == Transfer::Purpose::step) return finish_step(outcome, answer, now);
  if (state_ != State::running) return;
  // Some devices that send reports unasked refuse to be asked for one.
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
    if (step_ == Step::leave_look && (outcome != Outcome::done || !still_owns(answer))) return dispossess();
    // Tries each step of leaving, but gives up on a device that has failed three times.
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

/// Takes the answer about a new effect.
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
      if (created_ == 0)
        return lose("it has no room for an effect: another program may hold them", Outcome::failed,
                    Code::unusable_device);
      if (!layout_->has_direction())
        return lose("it has room for one effect only, and its effects have no direction", outcome, Code::unlike_device);
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

/// Takes the report descriptor.
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

void PidSession::give_up(std::string_view reason) noexcept {
  if (state_ == State::over) return;
  lost_ = true;
  reason_ = reason;
  why_ = Code::lost_device;
  step_ = Step::none;
  state_ = State::over;
  gate_ = {};  // what the device plays now is not this session's
  pending_ = false;
}

PidSession::Leaving PidSession::leaving() const noexcept {
  Leaving leaving;
  const auto add = [&](const Packet& packet) { leaving.packets[leaving.size++] = packet; };
  const auto order = [&](const Order& which) {
    if (which && !options_.is_shared) add(encode_device_control(*layout_, which));
  };
  for (std::size_t i = 0; i < created_; ++i) add(encode_constant_force(*layout_, blocks_[i], Magnitude()));
  for (std::size_t i = 0; i < created_; ++i) add(encode_stop(*layout_, blocks_[i]));
  order(layout_->device_control.stop_all);
  order(layout_->device_control.disable_actuators);
  leaving.farewell = leaving.size;
  leaving.have_ids = layout_->set_effect.id != 0;
  for (std::size_t i = 0; i < created_ && layout_->block_free; ++i) add(encode_block_free(*layout_, blocks_[i]));
  return leaving;
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
  // Every HID device also takes reports by the control endpoint, so a device whose other endpoint failed can be
  // stopped.
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
