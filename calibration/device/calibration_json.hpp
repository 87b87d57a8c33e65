#pragma once

#include <nlohmann/json_fwd.hpp>

#include "calibration/device/device_calibration.hpp"

namespace wale {

/// The same as `calibration_text`, in SI units, as members `ways`, `handle` and `rest` of an object. Each figure has
/// `value`, and `low` and `high`, the ends of its 95 % interval; what was not measured is null.
nlohmann::ordered_json calibration_json(const DeviceCalibration& calibration, const DeviceProfile& profile);

}  // namespace wale
