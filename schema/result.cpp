#include "wale/result.hpp"

#include "schema/without_place.hpp"

namespace wale {

std::string in_words_without_place(const Error& error) {
  return error.mend.empty() ? error.sentence : error.sentence + "; " + error.mend;
}

std::string in_words(const Error& error) {
  std::string place = error.place.name;
  const bool is_said = !error.place.column && error.sentence.starts_with(place);  // "tick 3 `divide` has …"
  if (place.empty() || is_said) return in_words_without_place(error);
  for (const auto& number : {error.place.number, error.place.column})
    if (number) place += ":" + std::to_string(*number);
  return place + ": " + in_words_without_place(error);
}

std::string explained(const Error& error) {
  std::string text = in_words(error) + "\n";
  for (const Place& place : error.led_to) {
    text += "  " + place.name;
    if (place.number) text += " " + std::to_string(*place.number);
    text += "  " + place.text;
    if (!place.source.empty()) text += "  (" + place.source + ")";
    text += "\n";
  }
  return text;
}

}  // namespace wale
