#include "library/devices_known.hpp"

#include <cstdlib>

#include "compiler/command/command.hpp"
#include "compiler/compile.hpp"
#include "compiler/modules/library_folders.hpp"

namespace wale {

std::vector<DeclaredDevice> devices_known(const Declarations& declarations) {
  std::vector<DeclaredDevice> devices;
  const auto add = [&](const DeviceDeclaration& device) { devices.push_back(device); };
  for (const auto& [name, entry] : declarations.devices.own()) add(entry.what);
  declarations.devices.each([&](const std::string& name, const DeviceDeclaration& device) {
    if (!declarations.devices.own().contains(name)) add(device);
  });
  return devices;
}

std::vector<DeclaredDevice> devices_known(const CheckedModule& module) { return devices_known(module.declarations()); }

std::vector<DeclaredDevice> devices_here() {
  SourceSet sources;
  Diagnostics diagnostics;
  const auto resolver = file_resolver(library_folders({}, std::getenv("WALE_LIBRARY")));
  const CheckedModule module = check_source(sources, sources.add("here", "wale 1\n"), *resolver, diagnostics);
  command::print_diagnostics(stderr, diagnostics, sources);
  return devices_known(module);
}

}  // namespace wale
