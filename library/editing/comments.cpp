#include "library/editing/comments.hpp"

#include <algorithm>

namespace wale {
namespace {

/// Where the text in quotes ends that begins at `at`, behind its last quote: at the end of the line at the latest.
std::size_t behind_text(std::string_view part, std::size_t at) {
  for (++at; at < part.size() && part[at] != '\n'; ++at) {
    if (part[at] == '\\') ++at;
    else if (part[at] == '"') return at + 1;
  }
  return std::min(at, part.size());
}

}  // namespace

std::string comments_in(std::string_view part) {
  std::string comments;
  for (std::size_t at = 0; at < part.size();) {
    const std::string_view rest = part.substr(at);
    if (rest.starts_with('"')) {
      at = behind_text(part, at);
      continue;
    }
    const bool is_line = rest.starts_with("//"), is_block = rest.starts_with("/*");
    if (!is_line && !is_block) {
      ++at;
      continue;
    }
    std::size_t end = is_line ? rest.find('\n') : rest.find("*/", 2);
    end = end == std::string_view::npos ? rest.size() : end + (is_line ? 0 : 2);
    std::string_view comment = rest.substr(0, end);
    while (!comment.empty() && (comment.back() == ' ' || comment.back() == '\t' || comment.back() == '\r'))
      comment.remove_suffix(1);
    comments += std::string(comment) + "\n";
    at += end;
  }
  return comments;
}

std::size_t end_of_line(std::string_view part) { return std::min(part.find('\n'), part.size()); }

}  // namespace wale
