#include "tests/usb/pid_model.hpp"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <utility>

#include "tests/usb/profiles.hpp"

namespace wale::test {
namespace {

DeviceProfile stick_profile() {
  DeviceProfile profile = joystick_profile();
  profile.rate = 1000;
  profile.speed_limit = 1;
  profile.mass = 0.3;
  profile.damping = 1;
  profile.friction = 0.15;
  return profile;
}

int unsigned16(const std::vector<std::uint8_t>& bytes, std::size_t at) { return bytes[at] | bytes[at + 1] << 8; }

}  // namespace

PidModel::PidModel(PidFamily of, Faults with)
    : family(std::move(of)),
      faults(with),
      descriptor(test::report_descriptor(family)),
      stick_(stick_profile(), HandModel{0.55, 6.5, 135}, Lateral{0.04, 1}) {}

void PidModel::let_go() { stick_ = SimulatedJoystick(stick_profile(), HandModel{}, Rest{}); }

UsbModel::Bytes PidModel::device_descriptor() const {
  const auto low = [](std::uint16_t value) { return static_cast<std::uint8_t>(value & 0xff); };
  const auto high = [](std::uint16_t value) { return static_cast<std::uint8_t>(value >> 8); };
  const auto numbers = hex({low(family.vendor), high(family.vendor), low(family.product), high(family.product)});
  return from_hex("12 01 00 02 00 00 00 40 " + numbers + " 00 01 00 00 00 01");
}

UsbModel::Bytes PidModel::configuration_descriptor() const {
  const auto length = static_cast<std::uint16_t>(descriptor.size() + static_cast<std::size_t>(faults.says_more_bytes));
  const std::string reports = hex({static_cast<std::uint8_t>(length & 0xff), static_cast<std::uint8_t>(length >> 8)});
  const bool has_out = !faults.has_no_out;
  // One interface, HID, with its descriptor; interrupt IN each millisecond, interrupt OUT.
  return from_hex("09 02 " + std::string(has_out ? "29" : "22") + " 00 01 01 00 80 32 09 04 00 00 " +
                  (has_out ? "02" : "01") + " 03 00 00 00 09 21 11 01 00 01 22 " + reports + " 07 05 83 03 40 00 01" +
                  (has_out ? " 07 05 02 03 40 00 01" : ""));
}

std::optional<UsbModel::Bytes> PidModel::control(const SetUp& setup, const Bytes& out) {
  const std::uint8_t low = setup[2], high = setup[3];
  if (setup[0] == 0x81 && setup[1] == 6 && high == 0x22) {
    auto answer = descriptor;
    answer.resize(std::min<std::size_t>(answer.size(), setup[6] | setup[7] << 8));
    return answer;
  }
  if (setup[0] == 0xa1 && setup[1] == 1) {
    if (high == 1 && low == family.input) {
      ++polls;
      if (faults.stalls_polls) return std::nullopt;
      return input_report();
    }
    if (high != 3) return std::nullopt;
    if (logs) log.push_back("GET " + hex({low}));
    if (low == family.load) return block_load();
    if (family.has_pool && low == family.pool) {
      return std::vector<std::uint8_t>{low, 0, 0x10, static_cast<std::uint8_t>(family.simultaneous), 3};
    }
    return std::nullopt;
  }
  if (setup[0] == 0x21 && setup[1] == 9) {
    if (out.empty() || out[0] != low || out.size() != static_cast<std::size_t>(setup[6] | setup[7] << 8)) {
      ++wrong_reports;
      return std::nullopt;
    }
    if (logs) log.push_back("SET " + hex(out));
    if (high == 2) {
      take(out);
    } else if (high == 3 && low == family.create) {
      if (out.size() != 4 || out[1] != 1) ++wrong_reports;
      last_created_ = 0;
      if (created_ < faults.room) {
        ++created_;
        std::uint8_t lowest_free = 1;
        while (effects[lowest_free].exists) ++lowest_free;
        last_created_ = faults.block_zero ? 0 : faults.same_block ? 1 : lowest_free;
        effects[last_created_].exists = true;
      }
    } else {
      return std::nullopt;
    }
    return std::vector<std::uint8_t>{};
  }
  if (setup[0] == 0x21 && setup[1] == 10) return std::vector<std::uint8_t>{};  // SET_IDLE
  return std::nullopt;
}

std::vector<std::uint8_t> PidModel::block_load() {
  if (faults.pending_loads > 0) {
    --faults.pending_loads;
    return {family.load, 0, 0, 0, 0};
  }
  if (faults.wild_block) return {family.load, 77, 1, 0, 0x10};
  if (faults.short_load) return {family.load, last_created_};
  const bool is_loaded = last_created_ != 0 || faults.block_zero;
  return {family.load, last_created_, static_cast<std::uint8_t>(is_loaded ? 1 : 2), 0, 0x10};
}

std::optional<int> PidModel::control_frames(const SetUp& setup) const {
  const bool is_poll = (setup[0] & 0x80) != 0 && setup[1] == 1 && setup[3] == 1;
  if (faults.silent || (is_poll && faults.deaf_to_polls)) return std::nullopt;
  return faults.late;
}

bool PidModel::listens(std::uint8_t) const {
  if (is_deaf_to_outputs()) return false;
  if (faults.late == 0) return true;
  if (listens_at_ < 0) listens_at_ = now_ + faults.late;
  if (now_ < listens_at_) return false;
  listens_at_ = -1;
  return true;
}

bool PidModel::take(std::uint8_t endpoint, const Bytes& packet) {
  return endpoint == pid_out_endpoint && output(packet);
}

std::optional<UsbModel::Bytes> PidModel::give(std::uint8_t endpoint) {
  return endpoint == pid_in_endpoint ? input() : std::nullopt;
}

bool PidModel::output(const std::vector<std::uint8_t>& report) {
  if (faults.stall_outputs_after >= 0 && outputs >= faults.stall_outputs_after) return false;
  ++outputs;
  if (logs) log.push_back("OUT " + hex(report));
  take(report);
  return true;
}

void PidModel::take(const std::vector<std::uint8_t>& report) {
  if (report.size() < 2) {
    ++wrong_reports;
    return;
  }
  const std::uint8_t id = report[0];
  most_force = std::max(most_force, glm::length(force()));  // what the packet before this one left
  if (when_taken) when_taken(report);
  if (family.has_vendor_report && id == 0xa1) return answer_vendor(report);
  Effect& effect = effects[report[1]];
  const auto is_long = [&](std::size_t bytes) {
    if (report.size() != bytes) ++wrong_reports;
    return report.size() == bytes;
  };
  if (id == family.set_effect) {
    set_effect(report);
  } else if (id == family.constant && is_long(4)) {
    const auto counts = static_cast<std::int16_t>(unsigned16(report, 2));
    if (!effect.exists || std::abs(counts) > family.magnitude_maximum) ++wrong_reports;
    effect.magnitude = static_cast<double>(counts) / family.magnitude_maximum;
  } else if (id == family.envelope && is_long(10)) {
    if (!effect.exists) ++wrong_reports;  // nothing of it is felt here
  } else if (id == family.operation && is_long(4)) {
    if (!effect.exists || report[2] < 1 || report[2] > 3) ++wrong_reports;
    effect.plays = report[2] != 3;
    effect.loops = report[3];
    effect.started = now_;
    tell_state(report[1]);
  } else if (id == family.free && is_long(2)) {
    if (effect.exists) {
      --created_;
    } else {
      ++wrong_reports;
    }
    effect = {};
  } else if (id == family.gain && is_long(2)) {
    gain = report[1] / 255.0;
  } else if (id == family.control && is_long(2)) {
    for (std::size_t i = 0; i < family.control_orders.size(); ++i) {
      const bool is_said = family.control_is_mask ? (report[1] >> i & 1) != 0 : report[1] == i + 1;
      if (!is_said) continue;
      switch (family.control_orders[i]) {
        case 0x97: is_enabled = true; break;
        case 0x98: is_enabled = false; break;
        case 0x99:
          for (std::size_t each = 0; each < effects.size(); ++each) {
            if (!std::exchange(effects[each].plays, false)) continue;
            tell_state(static_cast<std::uint8_t>(each));
          }
          break;
        case 0x9a: reset(); break;
        default: ++wrong_reports; break;
      }
    }
    tell_state(0);
  } else if (id != family.constant && id != family.envelope && id != family.operation && id != family.free &&
             id != family.gain && id != family.control) {
    ++wrong_reports;
  }
}

/// tests/reference/usb_exchanges.md: A1 type8 class16 instance8 command32 data64 address64.
void PidModel::answer_vendor(const std::vector<std::uint8_t>& question) {
  ++vendor_questions;
  const bool is_about_axes = question.size() == 25 && question[1] == 1 && question[2] == 0x01 && question[3] == 0x0a &&
                             question[4] < 2 && question[6] == 0 && question[7] == 0 && question[8] == 0;
  if (!is_about_axes) {
    ++wrong_reports;
    return;
  }
  vendor_answer_ = question;
  const int axis = question[4];
  const Reading reading = stick_.sample();
  std::int64_t told = 0;
  if (faults.knows_no_vendor) {
    vendor_answer_[1] = 13;
  } else if (question[5] == 0x0d) {
    told = std::lround(32767 * (axis == 0 ? force().x : force().y));
  } else if (question[5] == 0x0e) {
    told = axis == 0 ? reading.counts.x : -reading.counts.y;
  } else {
    vendor_answer_[1] = 13;
  }
  for (std::size_t i = 0; i < 8; ++i) {
    vendor_answer_[9 + i] = static_cast<std::uint8_t>(static_cast<std::uint64_t>(told) >> (8 * i));
  }
}

void PidModel::set_effect(const std::vector<std::uint8_t>& report) {
  using Delay = PidFamily::Delay;
  const std::size_t gain_bytes = static_cast<std::size_t>(family.gain_bits) / 8;
  const std::size_t direction_bytes = family.has_direction ? static_cast<std::size_t>(family.direction_bits) / 8 : 0;
  const std::size_t gain_at = 9 + (family.delay == Delay::before_gain ? 2 : 0);
  const std::size_t axes_at = gain_at + gain_bytes + 1, direction_at = axes_at + 1;
  const std::size_t bytes =
      direction_at + 2 * direction_bytes + (family.type_offsets ? 4 : 0) + (family.delay == Delay::last ? 2 : 0);
  if (report.size() != bytes || !effects[report[1]].exists || report[2] != 1) {
    ++wrong_reports;
    return;
  }
  Effect& effect = effects[report[1]];
  effect.duration = unsigned16(report, 3);
  const int effect_gain = gain_bytes == 2 ? unsigned16(report, gain_at) : report[gain_at];
  effect.gain = static_cast<double>(effect_gain) / family.gain_maximum;
  effect.on_x = (report[axes_at] & 1) != 0;
  effect.on_y = (report[axes_at] & 2) != 0;
  effect.by_direction = (report[axes_at] & 4) != 0;
  if (family.has_direction) {
    const int direction = direction_bytes == 2 ? unsigned16(report, direction_at) : report[direction_at];
    effect.direction = 360.0 * direction / family.direction_maximum;
  }
}

/// PID 1.0, section 5.8, as `report_descriptor` lays it out.
void PidModel::tell_state(std::uint8_t block) {
  if (!tells_state) return;
  constexpr int enabled_bit = 2, power_bit = 16;
  states_.push_back({static_cast<std::uint8_t>(family.input + 1),
                     static_cast<std::uint8_t>(power_bit | (is_enabled ? enabled_bit : 0)),
                     static_cast<std::uint8_t>(block << 1 | (effects[block].plays ? 1 : 0))});
}

void PidModel::reset() {
  effects = {};
  created_ = 0;
  is_enabled = false;
}

std::vector<std::uint8_t> PidModel::input_report() {
  const Reading reading = stick_.sample();
  std::vector<std::uint8_t> report{family.input};
  report.resize(1 + static_cast<std::size_t>(family.buttons + 7) / 8);
  const auto put = [&](int value) {
    report.push_back(static_cast<std::uint8_t>(value & 0xff));
    report.push_back(static_cast<std::uint8_t>(value >> 8 & 0xff));
  };
  for (const std::uint8_t axis : family.axes) {
    const int counts = axis == 0x30 ? reading.counts.x : axis == 0x31 ? -reading.counts.y : 0;
    put(faults.beyond_its_range ? -32768 : counts);
  }
  return report;
}

std::optional<std::vector<std::uint8_t>> PidModel::input() {
  const auto is_past = [&](long after) { return after >= 0 && inputs >= after; };
  if (is_past(faults.no_inputs_after)) return std::nullopt;
  if (!vendor_answer_.empty()) return std::exchange(vendor_answer_, {});
  if (!states_.empty()) {
    auto state = std::move(states_.front());
    states_.pop_front();
    return state;
  }
  auto report = input_report();
  const auto is_one_of = [&](long every) { return every > 0 && inputs % every == every - 1; };
  if (is_one_of(faults.nonsense_every)) report.assign(report.size(), 0xee);
  if (is_one_of(faults.short_every)) report.resize(2);
  if (is_past(faults.bad_inputs_after)) report.assign(report.size(), 0xee);
  if (is_past(faults.short_inputs_after)) report.resize(3);
  ++inputs;
  return report;
}

glm::dvec2 PidModel::force() const {
  glm::dvec2 force(0);
  if (!is_enabled) return force;
  for (const Effect& effect : effects) {
    if (!effect.exists || !effect.plays) continue;
    const bool is_endless = effect.duration == 0xffff || effect.loops == 255;
    if (!is_endless && now_ - effect.started >= static_cast<long long>(effect.duration) * effect.loops) continue;
    const double size = effect.magnitude * effect.gain * gain,
                 radians = effect.direction * 3.14159265358979323846 / 180;
    if (effect.by_direction) {
      force += size * glm::dvec2(std::sin(radians), -std::cos(radians));
    } else {
      force += size * glm::dvec2(effect.on_x ? 1 : 0, effect.on_y ? 1 : 0);
    }
  }
  return force;
}

void PidModel::step() {
  ++now_;
  most_force = std::max(most_force, glm::length(force()));
  if (!moves) return;
  const glm::dvec2 now = force() * stick_.profile().force_newton;
  stick_.command({static_cast<float>(now.x), static_cast<float>(-now.y)});
  stick_.elapse(1);
}

}  // namespace wale::test
