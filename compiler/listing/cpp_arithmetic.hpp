#pragma once

#include <string>
#include <string_view>

namespace wale {

/// A file of runtime/machine, such as "arithmetic.hpp", as a part of another file: its declarations are inline in the
/// namespace, and what only a separate file needs is left out. Files of the project that it includes come before it,
/// the includes of the standard library at the head.
std::string cpp_arithmetic(std::string_view file, const std::string& name_space);

/// The part of schema/patch_program.hpp that the machine's splines need.
std::string cpp_height_table(const std::string& name_space);

/// Further functions that every program uses; with `with_peaks`, also those for peaks.
std::string cpp_helpers(bool with_peaks);

}  // namespace wale
