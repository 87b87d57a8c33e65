#pragma once

#include <string>
#include <vector>

#include "compiler/format/lines.hpp"

namespace wale::formatting {

/// The lines as a text with aligned columns: the values of a block's settings; the `=` and the descriptions of
/// consecutive declarations of one kind; the comments after consecutive lines.
std::string aligned(std::vector<Line> lines);

}  // namespace wale::formatting
