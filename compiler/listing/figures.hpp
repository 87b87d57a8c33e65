#pragma once

#include <string>
#include <string_view>

#include "wale/patch_program.hpp"

namespace wale {

/// The shortest digits that give the same number: "0.1", "-2", "1e-30", "inf", "nan".
std::string figure(float value);
std::string figure(double value);

/// "x", "velocity_x", "patch_half_width"; "input 25" for a reserved one.
std::string input_name(unsigned number);

/// "setup", "peak 0", "tick", "prediction 1".
std::string section_name(CodeSection section, std::size_t index);

/// "corduroy.wale:13"; empty if the line is not known.
std::string shown(const std::optional<SourceLine>& line);

/// `text` padded with spaces to `column`, and then `more` after at least two spaces. Without `more`, `text` unchanged.
std::string beside(std::string text, std::size_t column, const std::string& more);

/// "3 instructions", "1 instruction".
std::string counted(std::size_t count, std::string_view thing);

}  // namespace wale
