#pragma once

#include <optional>

#include "compiler/diagnostics/diagnostic.hpp"
#include "compiler/emit/lower.hpp"
#include "compiler/emit/source_lines.hpp"
#include "wale/patch_program.hpp"

namespace wale {

/// Sorts values into sections by their rate, assigns registers and writes the patch program.
///
/// The same material gives the same program, byte for byte. If the program needs more registers than the format can
/// number, the result is empty and a diagnostic is reported. Without `lines` the program does not record source lines.
std::optional<PatchProgram> emit(const LoweredMaterial& lowered, const SolvedMaterial& material,
                                 Diagnostics& diagnostics, const SourceLines* lines = nullptr);

}  // namespace wale
