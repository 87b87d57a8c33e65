#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "wale/patch_program.hpp"
#include "wale/program.hpp"

namespace wale {

/// The limits of a device's motion, in either direction of an axis. A position relative to a patch's centre reaches at
/// most one workspace diameter.
struct Envelope {
  explicit Envelope(const DeviceProfile& device)
      : reach(static_cast<float>(device.widest_patch())),
        speed(static_cast<float>(device.speed_limit)),
        acceleration(static_cast<float>(device.speed_limit * device.rate)) {}

  float reach;         ///< m
  float speed;         ///< m/s
  float acceleration;  ///< m/s^2
};

/// Writes one input of each hand to `values`, which is as long as `hands`: clamped to the envelope, with 0 for
/// not-a-number and for subnormal numbers.
/// `input` must be one that changes from tick to tick.
/// Real-time: allocates nothing, takes no lock, makes no system call, does not throw.
void place_input(Input input, std::span<const Hand> hands, const Envelope& envelope, float* values) noexcept;

/// Writes some inputs of one hand, each to its register, as `place_input` does.
class HandReader {
 public:
  HandReader() = default;
  /// `inputs` must be inputs that change from tick to tick.
  HandReader(std::span<const Input> inputs, const Envelope& envelope);

  /// Real-time: allocates nothing, takes no lock, makes no system call, does not throw.
  void operator()(const Hand& hand, float* registers) const noexcept;

 private:
  /// One component of the hand's motion.
  struct Component {
    std::uint16_t offset;  ///< bytes from the hand's beginning
    RegisterNumber number;
    float bound;
  };
  std::vector<Component> components_;
  bool time_ = false, button_ = false;
};

}  // namespace wale
