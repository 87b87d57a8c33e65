#pragma once

#include <atomic>
#include <functional>
#include <string_view>

#include "runtime/device/identification.hpp"
#include "wale/device.hpp"
#include "wale/device_wiring.hpp"
#include "wale/result.hpp"

namespace wale {

/// Pushes a device gently and watches how its handle moves (`Identification`), in real time on the calling thread, for
/// ten to thirty seconds. Calls `say` with each new request to the person. Afterwards the device is without force.
/// Errors: `stopped` once `stop` is true, and `lost_device`.
Result<Identified> identify_device(Device& device, const IdentifyOptions& options,
                                   const std::function<void(std::string_view)>& say, const std::atomic<bool>& stop);

/// `wiring` with the axes and motors of `found`, which must have settled them. Each motor keeps its gain and response.
DeviceWiring rewired(DeviceWiring wiring, const Identified& found);

}  // namespace wale
