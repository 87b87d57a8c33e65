#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "calibration/device/bench.hpp"
#include "calibration/device/fit_handle.hpp"
#include "calibration/device/fit_response.hpp"
#include "wale/declared_device.hpp"
#include "wale/result.hpp"

namespace wale {

/// What was measured on one device. What is empty was not measured.
struct DeviceCalibration {
  std::array<std::optional<WayFit>, 4> ways;       ///< by `Way`
  std::array<std::optional<HandleFit>, 2> handle;  ///< along x, and along y
  std::array<std::string, 2> handle_problem;       ///< why it could not be fitted
  std::optional<RestNoise> noise;
  std::array<int, 2> smallest_steps{};  ///< counts; 0: not seen
};

/// Fits each way that has readings. Errors: those of `fit_way`, and W0802 if there is no reading at all.
Result<DeviceCalibration> fit_readings(const std::vector<GaugeReading>& readings, double peak);

/// A gain that is far from the declared one: over 1.5 times, or under 1 / 1.5 of it.
struct GainQuestion {
  Way way;
  double declared, measured;

  /// Both figures, and what gram-force typed as newton would be.
  std::string text() const;
};

/// The questions that a person must answer before this calibration may be used.
std::vector<GainQuestion> gain_questions(const DeclaredDevice& declared, const DeviceCalibration& calibration);

/// The same device with the measured figures and their 95 % intervals in place of the declared ones; figures that were
/// not measured stay. Mass, damping, friction and delay are those of both axes, with an interval that holds both.
DeclaredDevice calibrated(DeclaredDevice declared, const DeviceCalibration& calibration);

/// The figures with their intervals, for a person: one block for each way, then the handle.
std::string calibration_text(const DeviceCalibration& calibration, const DeviceProfile& profile);

}  // namespace wale
