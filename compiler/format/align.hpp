#pragma once

#include <string>
#include <vector>

#include "compiler/format/lines.hpp"

namespace wale::formatting {

/// The lines as a text, with what belongs below each other below each other: the values of a block's settings; the `=`
/// and the descriptions of consecutive declarations of one kind; the comments behind consecutive lines.
std::string aligned(std::vector<Line> lines);

}  // namespace wale::formatting
