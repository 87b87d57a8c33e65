#include "calibration/command/devices_here.hpp"

#include <cstdlib>

#include "compiler/check/check.hpp"
#include "compiler/command/command.hpp"
#include "compiler/declarations/declared_devices.hpp"
#include "compiler/modules/library_folders.hpp"

namespace wale::command {

std::vector<DeclaredDevice> devices_here(const std::vector<std::string>& folders,
                                         const std::vector<ResolvedFile>& files) {
  SourceSet sources;
  Diagnostics diagnostics;
  const auto resolver =
      file_resolver(library_folders(folders, std::getenv("WALE_LIBRARY")), nullptr, Sandbox::required, files);
  const CheckedModule module = check_source(sources, sources.add("here", "wale 1\n"), *resolver, diagnostics);
  print_diagnostics(stderr, diagnostics, sources);
  return declared_devices(module.declarations());
}

}  // namespace wale::command
