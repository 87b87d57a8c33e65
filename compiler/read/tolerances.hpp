#pragma once

namespace wale {

// The largest values that a reading may read for a carrier that is absent. Smaller values count as zero; they are
// far too small to be felt.
inline constexpr double least_stiffness = 2;     // N/m
inline constexpr double least_damping = 0.05;    // N s/m
inline constexpr double least_force = 0.01;      // N
inline constexpr double least_mass = 1e-3;       // kg
inline constexpr double least_amplitude = 1e-4;  // N, of any texture: a tenth of the finest step that any device has
// of the relief: a part in another percept's band that counts
inline constexpr double least_of_relief = 0.1;

/// The relative error of a carrier's size that is read from a force.
inline constexpr double reading = 0.02;

}  // namespace wale
