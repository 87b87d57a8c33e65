#include "compiler/declarations/declared_devices.hpp"

namespace wale {

std::vector<DeclaredDevice> declared_devices(const Declarations& declarations) {
  std::vector<DeclaredDevice> devices;
  for (const auto& [name, entry] : declarations.devices.own()) devices.push_back(entry.what);
  declarations.devices.each([&](const std::string& name, const DeviceDeclaration& device) {
    if (!declarations.devices.own().contains(name)) devices.push_back(device);
  });
  return devices;
}

}  // namespace wale
