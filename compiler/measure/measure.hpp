#pragma once

#include "compiler/declarations/declarations.hpp"
#include "wale/program.hpp"

namespace wale {

/// The forces of a program, found by running it at many hands over its patch; N.
struct Measured {
  float max_newton = 0;  ///< the largest |force| found, at rest or moving up to the device's speed limit
  float p99_newton = 0;  ///< 99th percentile of |force| over the patch less its rim, at rest
  float rms_newton = 0;  ///< root mean square of the same
  bool flat = false;     ///< a texture without slope: a peak of zero, so that it cannot push
};

/// Runs the program at this bank's parameters. Deterministic; about a millisecond.
Measured measure(const Bank& bank);

/// How a program shakes a pad, as far as the actuator can at each frequency, under a hand that goes to and fro across
/// its patch as the hand `normal` does.
struct MeasuredShaking {
  float max = 0, p99 = 0, rms = 0;  ///< of the amplitude, m/s^2
  float lowest = 0, highest = 0;    ///< Hz, where it shakes with half of its P99 or more
};

/// The same of a program that vibrates, under the hand of a `person`; null: 1 Hz, 40 mm to either side.
MeasuredShaking measure_shaking(const Bank& bank, const HandDeclaration* person);

}  // namespace wale
