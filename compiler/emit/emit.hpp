#pragma once

#include <optional>

#include "compiler/diagnostics/diagnostic.hpp"
#include "compiler/emit/lower.hpp"
#include "compiler/emit/source_lines.hpp"
#include "schema/patch_program.hpp"

namespace wale {

/// Sorts values into sections by their rate, gives them registers and writes the patch program.
///
/// The same material gives the same program, byte for byte. Nothing, with a diagnostic, when the program has more
/// registers than the format can name. Without `lines` the program does not say from which lines it comes.
std::optional<PatchProgram> emit(const LoweredMaterial& lowered, const SolvedMaterial& material,
                                 Diagnostics& diagnostics, const SourceLines* lines = nullptr);

}  // namespace wale
