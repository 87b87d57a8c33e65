#pragma once

#include <string>
#include <vector>

#include "compiler/declarations/declarations.hpp"
#include "compiler/text/resolver.hpp"
#include "wale/declared_device.hpp"
#include "wale/result.hpp"

namespace wale {

/// The devices that an application declares for itself (`LibraryOptions::devices`), and the file in which every text
/// finds them (`Resolver::devices`).
struct OwnDevices {
  std::vector<DeclaredDevice> devices = {};  ///< sorted by name
  std::vector<ResolvedFile> files = {};
};

/// Checks such a text; an empty one declares none. `shipped` are the declarations that every file knows. Errors: the
/// first one in the text, with the others; `unknown_device` if it exports no device; `declared_twice` for a device that
/// Wale ships.
Result<OwnDevices> own_devices(const std::string& text, const Declarations& shipped,
                               const std::vector<std::string>& roots);

}  // namespace wale
