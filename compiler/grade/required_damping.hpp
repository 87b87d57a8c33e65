#pragma once

#include <algorithm>
#include <array>
#include <complex>
#include <vector>

#include "schema/device_profile.hpp"

namespace wale {

/// Derivatives of a force along x and y (rows) by a two-axis quantity of the hand (columns).
using Slopes = std::array<std::array<double, 2>, 2>;

/// The change of a force, or of a state, when the hand's place or motion changes a little.
struct HandSlopes {
  Slopes place{};             ///< N/m
  Slopes velocity{};          ///< filtered; N s/m
  Slopes raw_velocity{};      ///< N s/m
  Slopes acceleration{};      ///< filtered; N s^2/m
  Slopes raw_acceleration{};  ///< N s^2/m

  friend bool operator==(const HandSlopes&, const HandSlopes&) = default;
};

/// A program near one place and motion: force = direct * hand + output * state, next state = carry * state + input *
/// hand, in small differences. Row-major; n states, none for a program that remembers nothing.
struct LinearProgram {
  HandSlopes direct;
  std::size_t states = 0;
  std::vector<double> output;  ///< 2 x n
  std::vector<double> carry;   ///< n x n
  /// n / 2 rounded up pairs of rows: what the hand does to states 2 i and 2 i + 1 is `input[i]`, as to a force.
  std::vector<HandSlopes> input;

  friend bool operator==(const LinearProgram&, const LinearProgram&) = default;
};

/// When a device samples, and how long its command takes to the handle.
struct LoopTiming {
  explicit LoopTiming(const DeviceProfile& device);

  double period = 0;              ///< s
  std::array<double, 2> delay{};  ///< s, of each axis
  std::array<double, 2> lag{};    ///< s, of each axis: the time constant of its actuator's low-pass
  /// s: what slow changes are late, on the later axis.
  double latest() const { return std::max(delay[0] + lag[0], delay[1] + lag[1]); }
  std::vector<int> windows;    ///< of the velocity filter, in ticks, from 1 to its longest
  std::vector<int> parabolas;  ///< of the acceleration filter, in ticks, from its shortest to its longest
};

/// The largest singular value.
double spectral_norm(const Slopes& slopes);

/// The device's own damping from which on the sampled loop is passive near this place, N s/m: the supremum, over
/// frequencies to the Nyquist frequency (from 1/20 Hz on, on a grid) and over the windows that the profile's filters
/// may choose, of
///
///     T/2 / (1 - cos wT) * greatest eigenvalue of the Hermitian part of (1 - e^-jwT) L(w) H(e^jwT),  force = -H place
///
/// (Colgate and Schenkel 1997, general form), where L has e^-jwd / (1 + jwl) for each axis, d its delay and l its
/// actuator's lag. The direct dependence on place counts with its spectral norm in every direction: a texture that
/// pulls here pushes half a period further. Infinite when a linear program has no frequency response. At least 0.
double required_damping(const LinearProgram& program, const LoopTiming& timing);

}  // namespace wale
