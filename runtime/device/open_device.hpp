#pragma once

#include <memory>

#include "runtime/device/choose_device.hpp"
#include "runtime/device/hot_plugged_device.hpp"
#include "runtime/stage/scheduling.hpp"

namespace wale {

/// Opens a chosen device that is plugged in, by the profile and the wiring of its trusted declaration. Its
/// threads run just below the real-time loop's priority, where that is permitted, unless the options say otherwise. It
/// pushes nothing until it is commanded. After it was unplugged it is found again at its port, or at another port where
/// none like it was.
Result<std::unique_ptr<HotPluggedDevice>> open_device(const Connections& connections, const ChosenDevice& chosen,
                                                      DeviceOptions options = {.priority = loop_priority - 1});

}  // namespace wale
