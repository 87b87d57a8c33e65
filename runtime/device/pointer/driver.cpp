#include "runtime/device/driver.hpp"

#include "runtime/device/pointer/pointer_device.hpp"
#include "runtime/device/pointer/terminal.hpp"

namespace wale {

extern const Driver pointer_driver;

namespace {

constexpr const char* pointer_name = "pointer";  // the driver's, its port's, and that of its declaration

/// The mouse in this terminal. It is always listed; without a terminal it has an obstacle.
std::vector<PluggedIn> find_pointer(const Connections&, const PluggedIn*) {
  PluggedIn mouse{.driver = &pointer_driver,
                  .port = pointer_name,
                  .name = "the mouse in this terminal",
                  .can = "two axes; forces are drawn, not felt",
                  .profile = pointer_name};
  if (const auto terminal = pointer::find_terminal(); !terminal) mouse.obstacle = terminal.error();
  return {mouse};
}

OpenedDevice open_pointer(const Connections&, const PluggedIn&, const TrustedDevice& trusted, const DeviceOptions&) {
  auto opened = PointerDevice::open(trusted.profile());
  if (!opened) return std::move(opened.error());
  return *std::move(opened);
}

}  // namespace

constinit const Driver pointer_driver{
    .name = pointer_name, .is_chosen_by_auto = false, .is_felt = false, .find = find_pointer, .open = open_pointer};

}  // namespace wale
