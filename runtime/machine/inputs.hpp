#pragma once

#include <span>

#include "schema/patch_program.hpp"
#include "wale/program.hpp"

namespace wale {

/// Writes one input of each hand to `values`, which has room for them: held within what the device can do, not-a-number
/// as 0. A position relative to a patch's centre reaches one workspace at most. `input` is one of those that change from
/// tick to tick.
/// Real-time: allocates nothing, takes no lock, makes no system call, does not throw.
void place_input(Input input, std::span<const Hand> hands, const DeviceProfile& device, float* values) noexcept;

/// The same for several inputs of one hand, each to its register.
inline void place_hand(std::span<const Input> inputs, const Hand& hand, const DeviceProfile& device,
                       float* registers) noexcept {
  for (const Input input : inputs) place_input(input, {&hand, 1}, device, registers + static_cast<RegisterNumber>(input));
}

}  // namespace wale
