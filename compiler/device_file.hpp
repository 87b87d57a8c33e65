#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "compiler/text/resolver.hpp"
#include "wale/declared_device.hpp"
#include "wale/result.hpp"

namespace wale {

/// What a file of devices declares itself: one of `--devices`, or the owner's devices.wale.
struct DeviceFile {
  struct Device {
    DeclaredDevice declared;
    std::size_t line = 0;  ///< of its name, counted from 1
  };
  std::string name;                    ///< the path of the file
  std::vector<Device> exported;        ///< sorted by name, as is the next
  std::vector<Device> without_export;  ///< known in the file alone
};

/// Checks such a file, with imports from its own folder and from `roots`. Error: the first one in its text, whose mend
/// says how many more there are.
Result<DeviceFile> check_device_file(const ResolvedFile& file, const std::vector<std::string>& roots = {});

/// A warning (W0214) for each exported device that has the name of one in an earlier file. The first one counts.
std::vector<Error> hidden_devices(const std::vector<DeviceFile>& files);

/// The error (W0215) if `name` is a device that one of the files declares without `export`. `option` named it.
std::optional<Error> private_device(const std::string& name, const std::vector<DeviceFile>& files,
                                    const std::string& option);

}  // namespace wale
