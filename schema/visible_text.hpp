#pragma once

#include <string>
#include <string_view>

#include "wale/patch_program.hpp"

/// Texts that somebody else wrote, for people to read: the names and titles of a file, a device's name on USB, the
/// value of an option, a path. Written as they are, they could move a terminal's cursor, hide or forge lines, or turn
/// the order of letters around.
namespace wale {

/// Whether a terminal obeys the character instead of showing it: control characters, separators of lines and
/// paragraphs, and marks that change the direction of writing.
bool is_obeyed_by_terminals(char32_t code);

/// The text as one line that a terminal shows and does not obey: what it would obey becomes `\u001b` and so on (JSON
/// and C++ write such a character the same way), bytes that are not UTF-8 become U+FFFD. Applied twice, it is the same
/// as once.
std::string visible_text(std::string_view text);

/// The same for a text of several lines: its line breaks stay (without `\r`), and a tab is a space.
std::string visible_lines(std::string_view text);

/// Makes all texts of a program that somebody else wrote visible; its documentation and its two layers of source text
/// keep their lines.
void make_visible(PatchProgram& program);

}  // namespace wale
