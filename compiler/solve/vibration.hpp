#pragma once

#include <optional>
#include <string>
#include <vector>

#include "compiler/declarations/declarations.hpp"
#include "compiler/expression/checked.hpp"

namespace wale {

/// A percept as a pad's rule has its amplitude and rate: terms of the material.
struct Shaking {
  TermId amplitude = 0, rate = 0;
};

/// What a realisation on a pad may speak of beside the hand: `shaking`, the open amplitude; `speed`, that of the hand,
/// or the one that the device declares where it has no position; `period`, the texture's.
Scope shaking_scope(Terms& terms, TermId shaking, TermId period, const DeviceDeclaration& device,
                    const Declarations& declarations, Span span);

/// Several percepts on one actuator: as strong as their energies together, as often as the strongest.
Shaking together(Terms& terms, const Shaking& a, const Shaking& b);

/// The period of the material's texture, for a percept of these periods at the parameters' defaults; nothing where it
/// tells none that is the same everywhere.
std::optional<TermId> texture_period(const CheckedMaterial& material, const Percept& percept);

/// A material as a device can take it that cannot push. Its force is gone; what the force was known to feel like is
/// asked for, as far as the device has a rule for that, at the level that the map on the percept's own device tells.
/// `fates` gets what becomes of each thing in the physics.
CheckedMaterial without_force(const CheckedMaterial& material, const DeviceDeclaration& device,
                              const Declarations& declarations, std::vector<FateRecord>& fates);

}  // namespace wale
