#include "tests/usb/falcon_model.hpp"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

#include "tests/usb/falcon_reference.hpp"
#include "tests/usb/pid_descriptor.hpp"

namespace wale::test {
namespace {

constexpr double handle_kilogram = 0.3, losses = 1;  // N s/m; includes the losses of the hand's spring
constexpr double radians_per_count = 2 * falcon_pi / 1280 * 14.25 / 110;

/// Forces from torques by virtual work: a movement does the same work at the handle and at the arms.
glm::dvec3 force_of(const glm::dvec3& place, const glm::dvec3& torques) {
  glm::dvec3 force(0);
  for (int axis = 0; axis < 3; ++axis) {
    const glm::dvec3 slopes = arm_slopes(axis, place);
    for (int arm = 0; arm < 3; ++arm) force[axis] += slopes[arm] * torques[arm];
  }
  return force;
}

/// The largest force, in N, that the motors can exert in every direction of the plane at the workspace's middle, if
/// each motor has a torque of at most 1 N m. The function tries all directions.
double worst_force_by_one_newton_metre() {
  const glm::dvec3 middle(0, 0, 0.12);
  const glm::dvec3 by[3] = {force_of(middle, {1, 0, 0}), force_of(middle, {0, 1, 0}), force_of(middle, {0, 0, 1})};
  // torques = T * force, by Cramer's rule
  const auto determinant = [](const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c) {
    return a.x * (b.y * c.z - b.z * c.y) - b.x * (a.y * c.z - a.z * c.y) + c.x * (a.y * b.z - a.z * b.y);
  };
  const double whole = determinant(by[0], by[1], by[2]);
  double least = 1e9;
  for (int i = 0; i < 3600; ++i) {
    const glm::dvec3 force(std::cos(i * falcon_pi / 1800), std::sin(i * falcon_pi / 1800), 0);
    const double torques[3] = {determinant(force, by[1], by[2]) / whole, determinant(by[0], force, by[2]) / whole,
                               determinant(by[0], by[1], force) / whole};
    for (const double torque : torques) least = std::min(least, 1 / std::abs(torque));
  }
  return least;
}

int nibble(char letter) { return letter - 'A'; }

}  // namespace

FalconModel::FalconModel(FalconFaults with, bool runs) : faults(with), runs_firmware(runs) {
  static const double worst = worst_force_by_one_newton_metre();
  steps_per_newton_metre_ = 4096 * worst / full_newton;
}

UsbModel::Bytes FalconModel::device_descriptor() const {
  return from_hex("12 01 00 02 00 00 00 40 03 04 48 CB 00 06 01 02 03 01");
}

UsbModel::Bytes FalconModel::configuration_descriptor() const {
  return from_hex(
      "09 02 20 00 01 01 00 A0 2D "
      "09 04 00 00 02 FF FF FF 02 "
      "07 05 81 02 40 00 00 07 05 02 02 40 00 00");
}

std::optional<UsbModel::Bytes> FalconModel::control(const SetUp& setup, const Bytes&) {
  if (setup[0] != 0x40) return std::nullopt;
  const int value = setup[2] | setup[3] << 8;
  if (logs) log.push_back("C " + std::to_string(setup[1]) + " " + hex({setup[3], setup[2]}));
  if (faults.refuses_controls) return std::nullopt;
  switch (setup[1]) {
    case 0:
      if (value == 1) out_.clear();
      if (value == 2) line_.clear();
      break;
    case 1:
      if (value == 0x100) dtr_was_low_ = true;
      if (value == 0x101 && dtr_was_low_ && divisor_ == 0x4138) {  // resets the processor behind the line
        runs_firmware = false;
        firmware.clear();
        line_.clear();
        torques = glm::ivec3(0);
        loader_ = faults.has_no_loader ? Loader::off : Loader::listening;
      }
      break;
    case 3:
      divisor_ = value;
      if (value == 2 && loader_ == Loader::loading) {
        runs_firmware = !faults.firmware_is_dead;
        loader_ = Loader::off;
      }
      break;
    case 9: latency_ = value; break;
    default: break;
  }
  return Bytes{};
}

bool FalconModel::take(std::uint8_t endpoint, const Bytes& packet) {
  if (endpoint != 0x02) return false;
  if (faults.stall_after >= 0 && packets_ >= faults.stall_after) return false;
  ++packets_;
  const bool is_text = !packet.empty() && packet[0] == '<';
  if (logs) {
    log.push_back(loader_ == Loader::loading ? "OUT " + std::to_string(packet.size()) + " bytes"
                  : is_text                  ? "OUT " + std::string(packet.begin(), packet.end())
                                             : "OUT " + hex(packet));
  }
  for (const std::uint8_t byte : packet) take_byte(byte);
  return true;
}

void FalconModel::take_byte(std::uint8_t byte) {
  if (loader_ == Loader::loading) {
    const bool is_wrong = faults.wrong_echo_at == static_cast<long>(firmware.size());
    out_.push_back(static_cast<std::uint8_t>(byte ^ (is_wrong ? 1 : 0)));
    firmware.push_back(byte);
    return;
  }
  line_.push_back(byte);
  if (loader_ == Loader::listening && divisor_ == 0x4138 && line_ == from_hex("0A 43 0D")) {
    for (const std::uint8_t each : from_hex(faults.says_more_first ? "00 0A 44 2C 0D" : "0A 44 2C 0D")) {
      out_.push_back(each);
    }
    loader_ = Loader::fast;
    line_.clear();
  } else if (loader_ == Loader::fast && divisor_ == 0x15 && line_ == from_hex("41")) {
    out_.push_back(0x41);
    loader_ = Loader::loading;
    line_.clear();
  } else if (runs_firmware && divisor_ == 2) {
    if (line_[0] != '<') line_.clear();
    if (line_.size() < 16) return;
    take_command(std::string(line_.begin(), line_.end()));
    line_.clear();
  }
}

void FalconModel::take_command(const std::string& packet) {
  ++commands;
  bool is_right = packet.back() == '>' && packet[14] == 'A';
  for (std::size_t i = 1; i < 14; ++i) is_right = is_right && packet[i] >= 'A' && packet[i] <= 'P';
  if (!is_right) {
    ++wrong_packets;
    return;
  }
  for (int arm = 0; arm < 3; ++arm) {
    int bits = 0;
    for (int i = 3; i >= 0; --i) bits = 16 * bits + nibble(packet[static_cast<std::size_t>(1 + 4 * arm + i)]);
    torques[arm] = bits >= 32768 ? bits - 65536 : bits;
    if (std::abs(torques[arm]) > 4096) ++wrong_packets;
    if (torques[arm] != 0 && !is_homed) ++torques_before_home;
  }
  lights = nibble(packet[13]) & 14;
  const bool keeps_homing = (nibble(packet[13]) & 1) != 0;
  if (keeps_homing && homes_after >= 0 && commands >= homes_after) is_homed = true;
  if (faults.swallow > 0 && commands % faults.swallow == 0) return;
  if (faults.mute_after >= 0 && answers >= faults.mute_after) return;
  std::string text = answer();
  ++answers;
  if (faults.nonsense_after >= 0 && answers > faults.nonsense_after) text = "-<-<zz>--<AA>!>-";
  if (faults.cut > 0 && answers % faults.cut == 0) text.resize(7);
  out_.insert(out_.end(), text.begin(), text.end());
}

std::string FalconModel::answer() {
  std::string text = "<";
  const glm::dvec3 angles = arm_angles(place);
  for (int arm = 0; arm < 3; ++arm) {
    auto counts = static_cast<int>(std::lround((angles[arm] - 35 * falcon_pi / 180) / radians_per_count));
    if (faults.wild_after >= 0 && answers >= faults.wild_after) counts = arm == 0 ? 30000 : -30000;
    for (int i = 0; i < 4; ++i) text += static_cast<char>('A' + (static_cast<unsigned>(counts) >> (4 * i) & 15));
  }
  const bool says_homed = is_homed && !(faults.unhomed_after >= 0 && answers >= faults.unhomed_after);
  text += static_cast<char>('A' + buttons + (says_homed ? 0x70 : 0));
  return text + "A>";
}

/// The chip passes on data as soon as it has any. Otherwise it sends its status each time its latency has passed.
std::optional<UsbModel::Bytes> FalconModel::give(std::uint8_t endpoint) {
  if (endpoint != 0x81) return std::nullopt;
  ++frames_since_given_;
  if (out_.empty() && frames_since_given_ < latency_) return std::nullopt;
  frames_since_given_ = 0;
  Bytes packet{0x01, 0x60};
  const std::size_t most = faults.says_more_first ? 3 : 64;
  while (!out_.empty() && packet.size() < most) {
    packet.push_back(out_.front());
    out_.pop_front();
  }
  return packet;
}

glm::dvec3 FalconModel::force() const { return force_; }

void FalconModel::step() {
  if (!moves && torques == torques_of_force_) return;
  torques_of_force_ = torques;
  force_ = torques == glm::ivec3(0) ? glm::dvec3(0) : force_of(place, -glm::dvec3(torques) / steps_per_newton_metre_);
  most_force = std::max(most_force, glm::length(force_));
  if (!moves) return;
  constexpr int parts = 10;
  for (int i = 0; i < parts; ++i) {
    const glm::dvec3 all = force_ - losses * velocity + hand_stiffness * (hand - place);
    velocity += all / handle_kilogram * (1e-3 / parts);
    place += velocity * (1e-3 / parts);
    // The frame around the arms stops it.
    const glm::dvec3 least(-0.055, -0.055, 0.085), most(0.055, 0.055, 0.155);
    for (int axis = 0; axis < 3; ++axis) {
      if (place[axis] >= least[axis] && place[axis] <= most[axis]) continue;
      place[axis] = std::clamp(place[axis], least[axis], most[axis]);
      velocity[axis] = 0;
    }
  }
}

}  // namespace wale::test
