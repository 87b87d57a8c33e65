#include "calibration/command/devices_here.hpp"

#include <cstdlib>

#include "compiler/command/command.hpp"
#include "compiler/declarations/declared_devices.hpp"
#include "compiler/modules/library_folders.hpp"

namespace wale::command {

std::vector<DeclaredDevice> devices_here(const std::vector<std::string>& folders,
                                         const std::vector<ResolvedFile>& files) {
  const FileRequest request{.roots = library_folders(folders, std::getenv("WALE_LIBRARY")), .devices = files};
  return declared_devices(known_here(request).declarations());
}

}  // namespace wale::command
