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
  bool says_more_first = false;   ///< the greeting comes after a 00, in pieces
  long wrong_echo_at = -1;        ///< byte of the firmware that comes back changed; -1: none
  bool firmware_is_dead = false;  ///< the loaded firmware does not answer
  long mute_after = -1;           ///< number of answers after which it falls silent; -1: never
  long nonsense_after = -1;       ///< number of answers after which all are nonsense; -1: never
  long swallow = 0;               ///< one command in this many is not answered; 0: all are
  long cut = 0;                   ///< one answer in this many is cut short; 0: none
  long unhomed_after = -1;        ///< number of answers after which the encoders lose their zeros; -1: never
  long wild_after = -1;           ///< number of answers after which the encoders fit no place of the handle; -1: never
  long stall_after = -1;          ///< number of packets after which all others stall; -1: never
  bool refuses_controls = false;
  bool deaf = false;  ///< takes no packets
};

/// A Novint Falcon: the chip that turns USB into a serial line, the loader and the firmware behind it, and three motors
/// that move the handle. A hand holds the handle by a spring. The handle's mass, the losses and the hand are guesses.
class FalconModel final : public UsbModel {
 public:
  static constexpr double full_newton = 8;  ///< at the workspace's middle, in the weakest direction of the plane

  explicit FalconModel(FalconFaults faults = {}, bool runs_firmware = false);

  std::string name() const override { return "Novint Falcon"; }
  Bytes device_descriptor() const override;
  Bytes configuration_descriptor() const override;
  std::optional<Bytes> control(const SetUp& setup, const Bytes& out) override;
  bool listens(std::uint8_t) const override { return !faults.deaf; }
  bool take(std::uint8_t endpoint, const Bytes& packet) override;
  std::optional<Bytes> give(std::uint8_t endpoint) override;
  void step() override;

  /// The force at the handle, in N.
  glm::dvec3 force() const;

  FalconFaults faults;
  std::vector<std::string> log;  ///< "C 9 1", "OUT 0A 43 0D", "OUT <AAAAAAAAAAAABA>"; of firmware "OUT 62 bytes"
  bool logs = true;
  bool moves = true;  ///< false: the handle stands still, which saves time on an emulated processor
  bool runs_firmware = false;
  Bytes firmware;        ///< as it was loaded
  int homes_after = 20;  ///< number of homing commands until the encoders find their zeros; -1: never
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
