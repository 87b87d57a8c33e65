#include "wale/result.hpp"

#include <algorithm>

#include "schema/visible_text.hpp"
#include "schema/without_place.hpp"

namespace wale {

std::string in_words_without_place(const Error& error) {
  std::string words = visible_lines(error.sentence);
  std::ranges::replace(words, '\n', ' ');
  // Some mends have lines to copy, such as rules for a file.
  return error.mend.empty() ? words : words + "; " + visible_lines(error.mend);
}

std::string in_words(const Error& error) {
  std::string place = error.place.name;
  const bool is_said = !error.place.column && error.sentence.starts_with(place);  // "tick 3 `divide` has …"
  if (place.empty() || is_said) return in_words_without_place(error);
  for (const auto& number : {error.place.number, error.place.column})
    if (number) place += ":" + std::to_string(*number);
  return visible_text(place) + ": " + in_words_without_place(error);
}

std::string explained(const Error& error) {
  std::string text = in_words(error) + "\n";
  for (const Place& place : error.led_to) {
    text += "  " + visible_text(place.name);
    if (place.number) text += " " + std::to_string(*place.number);
    text += "  " + visible_text(place.text);
    if (!place.source.empty()) text += "  (" + visible_text(place.source) + ")";
    text += "\n";
  }
  return text;
}

}  // namespace wale
