#pragma once

#include <span>

#include "schema/patch_program.hpp"
#include "wale/program.hpp"

namespace wale {

/// What a device can do, in either direction of an axis. A position relative to a patch's centre reaches one workspace
/// at most.
struct Envelope {
  explicit Envelope(const DeviceProfile& device)
      : reach(static_cast<float>(device.workspace_diameter)),
        speed(static_cast<float>(device.speed_limit)),
        acceleration(static_cast<float>(device.speed_limit * device.rate)) {}

  float reach;         ///< m
  float speed;         ///< m/s
  float acceleration;  ///< m/s^2
};

/// Writes one input of each hand to `values`, which has room for them: held within the envelope, not-a-number as 0.
/// `input` is one of those that change from tick to tick.
/// Real-time: allocates nothing, takes no lock, makes no system call, does not throw.
void place_input(Input input, std::span<const Hand> hands, const Envelope& envelope, float* values) noexcept;

/// The same for several inputs of one hand, each to its register.
inline void place_hand(std::span<const Input> inputs, const Hand& hand, const Envelope& envelope,
                       float* registers) noexcept {
  for (const Input input : inputs)
    place_input(input, {&hand, 1}, envelope, registers + static_cast<RegisterNumber>(input));
}

}  // namespace wale
