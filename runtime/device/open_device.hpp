#pragma once

#include <memory>

#include "runtime/device/choose_device.hpp"
#include "runtime/device/hot_plugged_device.hpp"
#include "wale/stage.hpp"

namespace wale {

/// Opens a plugged device with the profile and the wiring of its trusted declaration; `chosen.plugged` and
/// `chosen.trusted` must be set. Its threads run just below the real-time loop's priority, if that is permitted, unless
/// the options say otherwise. It exerts no force until it is commanded. After it was unplugged it is found again at its
/// port, or at a port that had no device like it when this one was opened. Errors: those of `Driver::open`.
Result<std::unique_ptr<HotPluggedDevice>> open_device(const Connections& connections, const ChosenDevice& chosen,
                                                      DeviceOptions options = {.priority = usual_priority - 1});

}  // namespace wale
