#pragma once

#include <cstdint>
#include <deque>
#include <glm/vec3.hpp>
#include <string>
#include <vector>

#include "tests/usb/usb_model.hpp"

namespace wale::test {

/// How a model of a Falcon misbehaves.
struct FalconFaults {
  bool has_no_loader = false;     ///< does not answer the loader's greeting
  bool says_more_first = false;   ///< what greets comes after a 00, in pieces
  long wrong_echo_at = -1;        ///< byte of the firmware that comes back changed; -1: none
  bool firmware_is_dead = false;  ///< what has been loaded does not answer
  long mute_after = -1;           ///< answers before none come any more
  long nonsense_after = -1;       ///< answers before all are nonsense
  long swallow = 0;               ///< every so many commands one is not answered; 0: all are
  long cut = 0;                   ///< every so many answers one is cut short
  long unhomed_after = -1;        ///< answers before the encoders forget their zeros
  long wild_after = -1;           ///< answers before the encoders say what no place of the handle fits
  long stall_after = -1;          ///< packets taken before all others stall
  bool refuses_controls = false;
  bool deaf = false;  ///< takes no packets
};

/// A Novint Falcon: the chip that makes a serial line of USB, the loader and the firmware behind it, and three motors
/// that move the handle, which a hand holds by a spring. The handle's mass, losses and the hand are guesses.
class FalconModel final : public UsbModel {
 public:
  static constexpr double full_newton = 8;  ///< in the plane at the workspace's middle, where it is least

  explicit FalconModel(FalconFaults faults = {}, bool runs_firmware = false);

  std::string name() const override { return "Novint Falcon"; }
  Bytes device_descriptor() const override;
  Bytes configuration_descriptor() const override;
  std::optional<Bytes> control(const SetUp& setup, const Bytes& out) override;
  bool listens(std::uint8_t) const override { return !faults.deaf; }
  bool take(std::uint8_t endpoint, const Bytes& packet) override;
  std::optional<Bytes> give(std::uint8_t endpoint) override;
  void step() override;

  /// N at the handle.
  glm::dvec3 force() const;

  FalconFaults faults;
  std::vector<std::string> log;  ///< "C 9 1", "OUT 0A 43 0D", "OUT <AAAAAAAAAAAABA>"; of firmware "OUT 62 bytes"
  bool logs = true;
  bool moves = true;  ///< the handle does; where that is dear, as on an emulated processor, it may stand still
  bool runs_firmware = false;
  Bytes firmware;        ///< as it was loaded
  int homes_after = 20;  ///< commands that keep homing before the encoders have found their zeros; -1: never
  glm::dvec3 place{0, 0, 0.12}, velocity{0};
  glm::dvec3 hand{0, 0, 0.12};  ///< where the hand's spring pulls
  double hand_stiffness = 100;  ///< N/m
  int buttons = 0;
  glm::ivec3 torques{0};
  int lights = 0;
  long commands = 0, answers = 0, wrong_packets = 0, torques_before_home = 0;
  bool is_homed = false;
  double most_force = 0;  ///< N, the largest size of `force`

 private:
  enum class Loader { off, listening, fast, loading };

  void take_byte(std::uint8_t byte);
  void take_command(const std::string& packet);
  std::string answer();

  Loader loader_ = Loader::off;
  int divisor_ = 0;
  bool dtr_was_low_ = false;
  Bytes line_;
  std::deque<std::uint8_t> out_;
  int frames_since_given_ = 0, latency_ = 16;
  long packets_ = 0;
  double steps_per_newton_metre_ = 0;
  glm::dvec3 force_{0};
  glm::ivec3 torques_of_force_{0};
};

}  // namespace wale::test
