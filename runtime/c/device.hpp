#pragma once

#include <atomic>
#include <memory>

#include "runtime/c/call.hpp"
#include "wale/declared_device.hpp"
#include "wale/device.h"
#include "wale/devices.hpp"

namespace wale::c {

/// An opened device, which its handle and its stage share.
struct SharedDevice {
  std::unique_ptr<Device> device;
  std::atomic<bool> has_stage = false;
};

/// What `options` asks for. Errors: `malformed_value`, and those of texts.
Result<OpenOptions> read_options(const WaleDeviceOptions* options);

/// The figures of a profile; the text is the profile's.
WaleProfile figures_of(const DeviceProfile& profile);

/// Writes the figures of the declared device of that name, where its text stays. `to` has a size. Error:
/// `unknown_device`.
Result<> give_profile(const std::vector<DeclaredDevice>& declared, WaleText name, WaleProfile* to);

/// Gives a list to the caller.
void hand_out_devices(std::vector<DeviceInfo> devices, WaleDevices** to);

/// Gives a handle to the caller.
void hand_out_device(std::unique_ptr<Device> device, WaleDevice** to);

}  // namespace wale::c

struct WaleDevice {
  std::shared_ptr<wale::c::SharedDevice> shared;
};
