#pragma once

#include <atomic>
#include <memory>

#include "runtime/c/call.hpp"
#include "schema/home_process.hpp"
#include "wale/device.h"
#include "wale/devices.hpp"

namespace wale::c {

/// An opened device, which its handle and its stage share.
struct SharedDevice {
  std::unique_ptr<Device> device;
  std::atomic<bool> has_stage = false;
  const HomeProcess home = {};
};

/// What `options` asks for. Errors: `malformed_value`, and those of texts.
Result<OpenOptions> read_options(const WaleDeviceOptions* options);

/// Gives a list to the caller.
void hand_out_devices(std::vector<DeviceInfo> devices, WaleDevices** to);

/// Gives a handle to the caller.
void hand_out_device(std::unique_ptr<Device> device, WaleDevice** to);

}  // namespace wale::c

struct WaleDevice {
  std::shared_ptr<wale::c::SharedDevice> shared;
};
