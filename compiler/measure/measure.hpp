#pragma once

#include "compiler/declarations/declarations.hpp"
#include "wale/program.hpp"

namespace wale {

/// The forces of a program, found by running it at many hands over its patch; N.
struct Measured {
  float max_newton = 0;  ///< the largest |force| found, at rest or moving up to the device's speed limit
  float less_rim = 0;    ///< the same without the patch's rim, where heights fade
  float p99_newton = 0;  ///< 99th percentile of |force| over the patch less its rim, at rest
  float rms_newton = 0;  ///< root mean square of the same
  /// Whether the force depends on more than the moment's place and velocity: on what a program remembers, on time or on
  /// accelerations. No search tries all of these, so a larger force than `max_newton` is possible.
  bool may_be_larger = false;
  /// s: both are also over so long after a hand has come to rest, since the force on it changes with time; 0: it does not.
  double over_seconds = 0;
  bool flat = false;  ///< a texture without slope: a peak of zero, so that it cannot push
};

/// Runs the program at this bank's parameters. Deterministic; about a millisecond.
Measured measure(const Bank& bank);

/// The shaking of a pad by a program, limited by the actuator at each frequency, under a hand that goes to and fro
/// across the patch.
struct MeasuredShaking {
  float max = 0, p99 = 0, rms = 0;  ///< amplitude, m/s^2
  float lowest = 0, highest = 0;    ///< frequencies at which the amplitude is at least half of `p99`, Hz
};

/// What a pad's actuator gives of a drive, an amplitude (m/s^2) and a frequency (Hz): the frequency in its range, and
/// at most its acceleration there.
Force given_by(const Shaker& shaker, Force drive);

/// Measures a program that vibrates, under the hand of `person`; if null, 1 Hz and 40 mm to both sides. Deterministic.
MeasuredShaking measure_shaking(const Bank& bank, const HandDeclaration* person);

}  // namespace wale
