#pragma once

namespace wale {

// The largest values that a reading may read for a carrier that is absent. Smaller values count as zero. None is felt:
// each pushes the hand `normal` (calibration/hands) with less than the floor of the threshold for amplitude, the
// smallest force that people notice (calibration/thresholds/tan1992.wale: 0.1 N). tests/read/tolerances.cpp compares
// them with these records.
inline constexpr double least_force = 0.01;      // N: a tenth of the floor
inline constexpr double least_stiffness = 2;     // N/m: 0.08 N at the end of the hand's reach, 40 mm
inline constexpr double least_damping = 0.05;    // N s/m: 0.013 N at its top speed, 0.25 m/s
inline constexpr double least_mass = 1e-3;       // kg: 0.002 N where it turns, at 1.6 m/s^2
inline constexpr double least_amplitude = 1e-4;  // N, of any texture: a tenth of the finest step that any device has
// Of the relief: a part in another percept's band that counts. A smaller one changes the amplitude of the whole by 0.5
// %, and people notice 7 % (calibration/thresholds/pang1991.wale).
inline constexpr double least_of_relief = 0.1;

/// The relative error of a carrier's size that is read from a force: less than a third of the 7 % that people notice
/// (calibration/thresholds/pang1991.wale).
inline constexpr double reading = 0.02;
/// The relative error of a period: over the many periods of a patch it adds up, so it is read far better than a size.
inline constexpr double reading_of_period = 0.005;

}  // namespace wale
