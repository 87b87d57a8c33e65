#include "runtime/device/shipped_devices.hpp"

#include "schema/device_table.hpp"

namespace wale {

const Result<std::vector<DeclaredDevice>>& shipped_devices() {
  static const Result<std::vector<DeclaredDevice>> devices = read_device_table(shipped_device_table());
  return devices;
}

}  // namespace wale
