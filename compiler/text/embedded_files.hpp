#pragma once

#include <span>
#include <string_view>

namespace wale {

/// A file that is part of the binary.
struct EmbeddedFile {
  std::string_view name;  ///< as in the source tree, "schema/units.wale"
  std::string_view text;  ///< or bytes
  bool common;  ///< known to every file without an import: the language's own declarations, calibrations, levels
};

/// All of them: first the common ones, in the order in which they are declared (each may use those before it), then the
/// modules of the library that any file may import, wherever it is.
std::span<const EmbeddedFile> embedded_files();

/// The pictures and measured tables that modules of the library read, "library/stone/slate.png"; none is `common`.
std::span<const EmbeddedFile> embedded_assets();

/// The explanations of all diagnostic codes, "compiler/diagnostics/explanations/W0101.md" and so on, sorted by name.
std::span<const EmbeddedFile> embedded_explanations();

/// The machine's arithmetic as it stands in runtime/machine/, for programs that are written out as C++.
std::span<const EmbeddedFile> embedded_arithmetic();

}  // namespace wale
