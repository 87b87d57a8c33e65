#include "runtime/stage/devices_in_use.hpp"

#include <mutex>
#include <unordered_set>

#include "schema/home_process.hpp"

namespace wale {
namespace {

struct DevicesInUse {
  std::mutex mutex;
  std::unordered_set<const Device*> all;
};

DevicesInUse& devices_in_use() {
  // Never destroyed: a run may end while the process does.
  static auto* const devices = new PerProcess<DevicesInUse>;
  return **devices;
}

}  // namespace

bool take_device(const Device& device) {
  DevicesInUse& devices = devices_in_use();
  const std::lock_guard lock(devices.mutex);
  return devices.all.insert(&device).second;
}

void give_device_back(const Device& device) noexcept {
  DevicesInUse& devices = devices_in_use();
  const std::lock_guard lock(devices.mutex);
  devices.all.erase(&device);
}

}  // namespace wale
