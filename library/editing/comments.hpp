#pragma once

#include <string>
#include <string_view>

namespace wale {

/// The comments in a part of a text, one below the other, each without the white space around it; texts in quotes are
/// skipped. Empty without a comment.
std::string comments_in(std::string_view part);

/// Where the first line of a part ends that begins behind a statement: a comment up to there belongs to that statement.
std::size_t end_of_line(std::string_view part);

}  // namespace wale
