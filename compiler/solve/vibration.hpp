#pragma once

#include <optional>
#include <string>
#include <vector>

#include "compiler/declarations/declarations.hpp"
#include "compiler/expression/checked.hpp"

namespace wale {

/// The amplitude and rate by which a pad's rule renders a percept: terms of the material.
struct Shaking {
  TermId amplitude = 0, rate = 0;
};

/// The names that a realisation on a pad may use beside the hand: `shaking`, the open amplitude in m/s^2; `speed`, that
/// of the hand, or the declared one if the device has no position, in m/s; `period`, that of the texture, in m.
Scope shaking_scope(Terms& terms, TermId shaking, TermId period, const DeviceDeclaration& device,
                    const Declarations& declarations, Span span);

/// Two percepts on one actuator: the amplitude of the sum of their energies, at the rate of the stronger.
Shaking together(Terms& terms, const Shaking& a, const Shaking& b);

/// The period of the material's texture that is within the percept's periods at the parameters' defaults; empty if
/// there is none that is the same everywhere.
std::optional<TermId> texture_period(const CheckedMaterial& material, const Percept& percept);

/// The material for a device that cannot push. Its force is removed. The percepts that the force carried are asked for
/// instead if the device has a rule for them, at the levels given by the maps on the percepts' own devices. `fates`
/// receives what becomes of each part of the physics.
CheckedMaterial without_force(const CheckedMaterial& material, const DeviceDeclaration& device,
                              const Declarations& declarations, std::vector<FateRecord>& fates);

}  // namespace wale
