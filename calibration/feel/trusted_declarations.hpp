#pragma once

#include <optional>
#include <string>
#include <vector>

#include "compiler/device_file.hpp"
#include "compiler/text/resolver.hpp"
#include "runtime/device/trusted_device.hpp"
#include "wale/result.hpp"

namespace wale {

/// The declarations that may scale a real device, and the files of the owner that they stand in.
struct TrustedDeclarations {
  std::vector<TrustedDevice> devices;   ///< in the order in which they count; the shipped ones come last
  std::vector<ResolvedFile> files;      ///< for the compiler, so that materials can be built for these devices
  std::vector<DeviceFile> checked;      ///< the same files, as they were checked
  std::optional<Error> owners_problem;  ///< why nothing in the owner's file is trusted, where that has an error
};

/// Reads what `files` export, which a person has named for this, then what `owners_file` exports, where there is such a
/// file: each file's own devices, and none that it imports. Errors, which for the owner's file are only noted: a file
/// that cannot be read (W0501), the first error in its text with the number of the others, or a named file that exports
/// no device (W0601).
Result<TrustedDeclarations> trusted_declarations(const std::vector<std::string>& files, const std::string& owners_file);

}  // namespace wale
