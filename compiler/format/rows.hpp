#pragma once

#include <string>
#include <vector>

#include "compiler/format/pieces.hpp"

namespace wale::formatting {

/// One statement with the comments inside it, the heading of a block, a `}`, or comments alone: what begins a line.
struct Row {
  std::vector<Piece> pieces;
  std::string trailing;   ///< comments behind its end
  std::size_t depth = 0;  ///< of the braces around it
  bool blank_before = false;
};

/// Cuts a file without errors into rows. Blocks that the author wrote in one line stay there when they hold one
/// statement and no comment and fit.
std::vector<Row> rows_of(std::vector<Piece> pieces);

}  // namespace wale::formatting
