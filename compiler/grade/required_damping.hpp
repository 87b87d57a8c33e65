#pragma once

#include <algorithm>
#include <array>
#include <complex>
#include <vector>

#include "wale/device_profile.hpp"

namespace wale {

/// Derivatives of a force along x and y (rows) by a two-axis quantity of the hand (columns).
using Slopes = std::array<std::array<double, 2>, 2>;

/// The derivatives of a force, or of two states, by the hand's place and motion. Units are those for a force.
struct HandSlopes {
  Slopes place{};             ///< N/m
  Slopes velocity{};          ///< filtered; N s/m
  Slopes raw_velocity{};      ///< N s/m
  Slopes acceleration{};      ///< filtered; N s^2/m
  Slopes raw_acceleration{};  ///< N s^2/m

  friend bool operator==(const HandSlopes&, const HandSlopes&) = default;
};

/// A program linearised at one place and motion: force = direct * hand + output * state, next state = carry * state +
/// input * hand. Matrices are row-major; n states, 0 for a program without memory.
struct LinearProgram {
  HandSlopes direct;
  std::size_t states = 0;
  std::vector<double> output;  ///< 2 x n
  std::vector<double> carry;   ///< n x n
  /// ceil(n / 2) entries: `input[i]` has the derivatives of states 2 i and 2 i + 1, in the rows for x and y.
  std::vector<HandSlopes> input;

  friend bool operator==(const LinearProgram&, const LinearProgram&) = default;
};

/// The sampling of a device, and the time that its command takes to the handle.
struct LoopTiming {
  explicit LoopTiming(const DeviceProfile& device);

  double period = 0;              ///< s
  std::array<double, 2> delay{};  ///< s, of each axis
  std::array<double, 2> lag{};    ///< s, of each axis: the time constant of its actuator's low-pass
  /// The delay of slow changes on the slower axis, s.
  double latest() const { return std::max(delay[0] + lag[0], delay[1] + lag[1]); }
  std::vector<int> windows;    ///< windows of the velocity filter, in ticks, from 1 to its longest
  std::vector<int> parabolas;  ///< windows of the acceleration filter, in ticks, from its shortest to its longest
};

/// The largest singular value.
double spectral_norm(const Slopes& slopes);

/// The damping of the device from which on the sampled loop is passive near this place, N s/m: the supremum of the
/// following, over a grid of frequencies from 1/20 Hz to the Nyquist frequency and over the windows that the profile's
/// filters may choose:
///
///     T/2 / (1 - cos wT) * greatest eigenvalue of the Hermitian part of (1 - e^-jwT) L(w) H(e^jwT),  force = -H place
///
/// (Colgate and Schenkel 1997, general form). L has e^-jwd / (1 + jwl) for each axis, with its delay d and its
/// actuator's lag l. What the force on a hand that stays depends on its place, with all that the states come to, counts with
/// its spectral norm, whatever its sign: a texture that pulls here pushes half a period further on. What passes, as a
/// bristle of friction that follows the hand, counts as it is. Infinite if the linear program has no frequency response. At least 0.
double required_damping(const LinearProgram& program, const LoopTiming& timing);

}  // namespace wale
