#pragma once

#include <string>

namespace wale {

/// Declarations in the standard style, without the version before them. They must have no error.
std::string standard_declarations(const std::string& text);

}  // namespace wale
