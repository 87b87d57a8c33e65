#pragma once

#include <array>
#include <cstdint>
#include <deque>
#include <functional>
#include <glm/vec2.hpp>
#include <optional>
#include <string>
#include <vector>

#include "tests/usb/pid_descriptor.hpp"
#include "tests/usb/usb_model.hpp"
#include "wale/simulated.hpp"

namespace wale::test {

/// The faults of a model of a device.
struct Faults {
  long stall_outputs_after = -1;   ///< number of good interrupt OUT transfers before all others stall; -1: never
  long silent_outputs_after = -1;  ///< number of good interrupt OUT transfers before all others never end
  long bad_inputs_after = -1;      ///< number of good input reports before all others are nonsense; -1: never
  long short_inputs_after = -1;
  long no_inputs_after = -1;
  bool deaf_to_polls = false;  ///< GET_REPORT of input reports is not answered
  bool stalls_polls = false;
  int room = 40;                  ///< number of effects that fit
  int pending_loads = 0;          ///< number of answers of Block Load without a result
  bool same_block = false;        ///< gives out the same block twice
  bool block_zero = false;        ///< gives out block 0
  bool short_load = false;        ///< answers Block Load with two bytes
  bool silent = false;            ///< answers nothing
  bool knows_no_vendor = false;   ///< answers each question of the vendor's report with "unknown"
  long nonsense_every = 0;        ///< one input report in this many is nonsense; 0: none
  long short_every = 0;           ///< one input report in this many is cut short; 0: none
  int says_more_bytes = 0;        ///< declared bytes of report descriptor beyond the real ones
  bool has_no_out = false;        ///< no interrupt OUT endpoint: output reports go by the control endpoint
  bool wild_block = false;        ///< gives out a block beyond the range that its descriptor declares
  bool beyond_its_range = false;  ///< reports positions beyond the range that its descriptor declares
  int late = 0;                   ///< frames that each control transfer and each output report takes
};

constexpr std::uint8_t pid_in_endpoint = 0x83, pid_out_endpoint = 0x02;

/// A force-feedback joystick of USB's PID class: its packets and its stick. It reads and writes packets only by its
/// family's table. Each `step` is a millisecond, a frame of full-speed USB.
class PidModel final : public UsbModel {
 public:
  struct Effect {
    bool exists = false, plays = false, by_direction = false, on_x = false, on_y = false;
    int duration = 0;      // ms; 0xffff: for ever
    int loops = 1;         // 255: for ever
    double direction = 0;  // degrees
    double gain = 1, magnitude = 0;
    long long started = 0;  // ms
  };

  explicit PidModel(PidFamily family, Faults faults = {});

  std::string name() const override { return family.name; }
  Bytes device_descriptor() const override;
  Bytes configuration_descriptor() const override;
  std::optional<Bytes> control(const SetUp& setup, const Bytes& out) override;
  std::optional<int> control_frames(const SetUp& setup) const override;
  bool listens(std::uint8_t endpoint) const override;
  bool take(std::uint8_t endpoint, const Bytes& packet) override;
  std::optional<Bytes> give(std::uint8_t endpoint) override;
  void step() override;

  /// An output report on the interrupt endpoint; false: the endpoint stalls.
  bool output(const std::vector<std::uint8_t>& report);
  bool is_deaf_to_outputs() const { return faults.silent_outputs_after >= 0 && outputs >= faults.silent_outputs_after; }
  /// The input report of this frame, if it sends one.
  std::optional<std::vector<std::uint8_t>> input();
  /// Removes the hand from the stick, which then stays at its centre until a force moves it. Call it before the first
  /// `step`.
  void let_go();

  /// The force of the motors as a fraction of full force, along the axes of HID (y points to the user).
  glm::dvec2 force() const;
  /// The place of the stick from its centre, in metres: x to the right, y away from the user.
  glm::dvec2 position() const { return stick_.position(); }

  PidFamily family;
  Faults faults;
  std::vector<std::uint8_t> descriptor;
  std::vector<std::string> log;  ///< "OUT 0C 08", "SET 11 01 00 00", "GET 12"
  bool logs = true;
  bool moves = true;  ///< false: the stick stands still, which saves time on an emulated processor
  std::array<Effect, 256> effects{};
  bool is_enabled = false;
  bool tells_state = false;  ///< sends PID State reports when effects start or stop, and at orders
  /// Called with each report that the model takes, from either endpoint.
  std::function<void(const std::vector<std::uint8_t>&)> when_taken;
  double gain = 1;
  double most_force = 0;  ///< the largest size of `force` that any packet or frame left
  long outputs = 0, inputs = 0, wrong_reports = 0, polls = 0, vendor_questions = 0;

 private:
  void take(const std::vector<std::uint8_t>& report);
  void answer_vendor(const std::vector<std::uint8_t>& question);
  void set_effect(const std::vector<std::uint8_t>& report);
  void reset();
  void tell_state(std::uint8_t block);
  std::vector<std::uint8_t> input_report();
  std::vector<std::uint8_t> block_load();

  SimulatedJoystick stick_;
  std::vector<std::uint8_t> vendor_answer_;       // waits to be sent
  std::deque<std::vector<std::uint8_t>> states_;  // wait to be sent
  long long now_ = 0;                             // ms
  mutable long long listens_at_ = -1;             // ms, when the report that waits is taken; -1: none waits
  int created_ = 0;
  std::uint8_t last_created_ = 0;
};

}  // namespace wale::test
