#pragma once

namespace wale {

// What an extraction leaves of a carrier that is not there. Smaller values count as nothing; they are far below what a
// hand can feel.
inline constexpr double least_stiffness = 2;     // N/m
inline constexpr double least_damping = 0.05;    // N s/m
inline constexpr double least_force = 0.01;      // N
inline constexpr double least_mass = 1e-3;       // kg
inline constexpr double least_amplitude = 1e-4;  // N, of any texture: a tenth of the finest step that any device has
// of the texture's force: the patch's ends turn so much of it into bumps
inline constexpr double least_of_texture = 0.1;
// of the whole force: a bend of a strong field rings like a texture so much
inline constexpr double least_of_field = 0.03;

/// The relative error of a carrier's size that is read from a force.
inline constexpr double reading = 0.02;

}  // namespace wale
