#pragma once

namespace wale {

// What an extraction leaves of something that is not there, and below which it counts as nothing. Far below what a hand
// can tell.
inline constexpr double least_stiffness = 2;     // N/m
inline constexpr double least_damping = 0.05;    // N s/m
inline constexpr double least_force = 0.01;      // N
inline constexpr double least_mass = 1e-3;       // kg
inline constexpr double least_amplitude = 1e-4;  // N, of any texture: a tenth of the finest step that any device has
inline constexpr double least_of_texture = 0.1;  // of the texture's force: what ends of the patch make of it as bumps
inline constexpr double least_of_field = 0.03;   // of the whole force: what bends of a strong field ring like a texture

/// What the size of a carrier may be off by when it is read from a force, as a fraction.
inline constexpr double reading = 0.02;

}  // namespace wale
