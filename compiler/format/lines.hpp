#pragma once

#include <string>
#include <vector>

#include "compiler/format/rows.hpp"
#include "compiler/format/spacing.hpp"

namespace wale::formatting {

/// A place in a line where `align` may put spaces, so that the same parts of neighbouring lines are aligned.
struct Stop {
  std::size_t at = 0;     ///< bytes of the line before it; 0 if the line has no such place
  std::size_t width = 0;  ///< columns of the name before it
  std::string of;         ///< only lines of the same kind are aligned
};

/// A line that will be written.
struct Line {
  std::size_t indentation = 0;  ///< columns
  std::string text;             ///< without indentation and trailing comment
  std::string comment;          ///< after the text
  Stop value;                   ///< before the value of a setting, or the `=` or `:` of a declaration
  Stop description;             ///< before the description at the end of a param
  bool blank_before = false;
  bool begins_row = false;
  bool opens_block = false, closes_block = false;
  bool only_comments = false;
};

/// Lays out rows: indents them, puts spaces between their pieces, and breaks lines longer than `format_columns`. Line
/// breaks that the author put into a statement stay.
std::vector<Line> lines_of(const std::vector<Row>& rows, const Roles& roles);

}  // namespace wale::formatting
