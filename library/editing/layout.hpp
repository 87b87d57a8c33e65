#pragma once

#include "compiler/expression/checked.hpp"
#include "wale/language_service.hpp"

namespace wale {

/// The workspaces of a checked text, with what their authors wrote. `tree` is that of the text.
std::vector<Layout> layouts_in(const SyntaxTree& tree, const CheckedModule& module, std::string_view text);

}  // namespace wale
