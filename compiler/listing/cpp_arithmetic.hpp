#pragma once

#include <string>
#include <string_view>

namespace wale {

/// A file of runtime/machine, "arithmetic.hpp", as a part of another file: without what only a file of its own needs,
/// its declarations in the namespace and inline. Files of the project that it includes stand before it, the standard
/// library's includes at the head.
std::string cpp_arithmetic(std::string_view file, const std::string& name_space);

/// What stands for schema/patch_program.hpp where the machine's splines are made.
std::string cpp_height_table(const std::string& name_space);

/// What every program uses besides, and what those with peaks do.
std::string cpp_helpers(bool with_peaks);

}  // namespace wale
