#pragma once

#include <string>
#include <string_view>

#include "schema/patch_program.hpp"

namespace wale {

/// The shortest digits that mean the same number: "0.1", "-2", "1e-30", "inf", "nan".
std::string figure(float value);
std::string figure(double value);

/// "x", "velocity_x", "patch_half_width"; "input 25" for one that is reserved.
std::string input_name(unsigned number);

/// "setup", "peak 0", "tick", "prediction 1".
std::string section_name(CodeSection section, std::size_t index);

/// "corduroy.wale:13"; nothing where the line is not known.
std::string shown(const std::optional<SourceLine>& line);

/// `text` filled with spaces to `column`, and then `more` behind at least two spaces. Without `more`, `text` as it is.
std::string beside(std::string text, std::size_t column, const std::string& more);

/// "3 instructions", "1 instruction".
std::string counted(std::size_t count, std::string_view thing);

}  // namespace wale
