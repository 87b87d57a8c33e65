#pragma once

#include <string>
#include <vector>

#include "compiler/format/rows.hpp"
#include "compiler/format/spacing.hpp"

namespace wale::formatting {

/// A place in a line where `align` may put spaces, so that the same parts of neighbouring lines stand below each other.
struct Stop {
  std::size_t at = 0;     ///< bytes of the line before it; 0: the line has no such place
  std::size_t width = 0;  ///< columns of the name before it
  std::string of;         ///< lines align only with others of the same kind
};

/// A line that will be written.
struct Line {
  std::size_t indentation = 0;  ///< columns
  std::string text;             ///< without indentation and trailing comment
  std::string comment;          ///< behind the text
  Stop value;                   ///< before the value of a setting, or the `=` or `:` of a declaration
  Stop description;             ///< before the text that ends a param
  bool blank_before = false;
  bool begins_row = false;
  bool opens_block = false, closes_block = false;
  bool only_comments = false;
};

/// Lays rows out: indents them, spaces their pieces, and breaks what is longer than `format_columns`. Where the author
/// broke a statement it stays broken.
std::vector<Line> lines_of(const std::vector<Row>& rows, const Roles& roles);

}  // namespace wale::formatting
