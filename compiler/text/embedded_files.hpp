#pragma once

#include <span>
#include <string_view>

namespace wale {

/// A file that is part of the binary.
struct EmbeddedFile {
  std::string_view name;  ///< as in the source tree, "schema/units.wale"
  std::string_view text;  ///< or bytes of any kind
  bool common;            ///< known to every file without an import: declarations of the language, calibrations, levels
};

/// All embedded Wale files: first the common ones, in the order of their declaration (each may use those before it),
/// then the modules of the library, which any file may import.
std::span<const EmbeddedFile> embedded_files();

/// The pictures and measured tables that modules of the library read, "library/stone/slate.png"; none is `common`.
std::span<const EmbeddedFile> embedded_assets();

/// The explanations of all diagnostic codes, "compiler/diagnostics/explanations/W0101.md" and so on, sorted by name.
std::span<const EmbeddedFile> embedded_explanations();

/// The machine's arithmetic from runtime/machine/, for programs that are written out as C++.
std::span<const EmbeddedFile> embedded_arithmetic();

}  // namespace wale
