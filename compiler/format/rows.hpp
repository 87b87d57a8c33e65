#pragma once

#include <string>
#include <vector>

#include "compiler/format/pieces.hpp"

namespace wale::formatting {

/// The content of one line or of a broken one: a statement with the comments inside it, the heading of a block, a `}`,
/// or comments alone.
struct Row {
  std::vector<Piece> pieces;
  std::string trailing;   ///< comments after its end
  std::size_t depth = 0;  ///< number of braces around it
  bool blank_before = false;
};

/// Cuts a file without errors into rows. A block that the author wrote on one line stays there if it holds one
/// statement and no comment, and fits.
std::vector<Row> rows_of(std::vector<Piece> pieces);

}  // namespace wale::formatting
