#pragma once

#include <span>
#include <string_view>

namespace wale {

/// A Wale file that is part of the binary: the language's own declarations, the calibrations, the named levels.
struct EmbeddedFile {
  std::string_view name;  ///< as in the source tree, "schema/units.wale"
  std::string_view text;
};

/// All of them, in the order in which they are declared: each may use those before it.
std::span<const EmbeddedFile> embedded_files();

}  // namespace wale
