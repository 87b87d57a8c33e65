#include "schema/expectation.hpp"

#include <algorithm>
#include <initializer_list>
#include <utility>

namespace wale {
namespace {

/// The text up to the first of these.
std::string up_to(std::string_view text, std::initializer_list<std::string_view> ends) {
  std::size_t length = text.size();
  for (const std::string_view end : ends) length = std::min(length, text.find(end));
  return std::string(text.substr(0, length));
}

}  // namespace

Expectation expectation_in(std::string_view sentence) {
  constexpr std::string_view begin = "expected ", middle = ", found ";
  const std::size_t at = sentence.find(begin);
  // It begins the sentence, or what follows a place: "words.csv, line 3: expected …".
  if (at == std::string_view::npos || (at > 0 && !sentence.substr(0, at).ends_with(": "))) return {};
  sentence.remove_prefix(at + begin.size());
  const std::size_t found = sentence.find(middle);
  if (found == std::string_view::npos) return {up_to(sentence, {", but ", "; "}), {}};
  return {std::string(sentence.substr(0, found)),
          up_to(sentence.substr(found + middle.size()), {", which ", ", and ", ", but ", " (", "; "})};
}

Error with_expectation(Error error) {
  if (!error.expected.empty() || !error.found.empty()) return error;
  Expectation said = expectation_in(error.sentence);
  error.expected = std::move(said.expected);
  error.found = std::move(said.found);
  return error;
}

std::string in_one_line(std::string_view text) {
  std::string line;
  for (const char each : text)
    if (each != ' ' || !line.ends_with(' ')) line += each;
  while (line.ends_with(' ')) line.pop_back();
  return line;
}

}  // namespace wale
