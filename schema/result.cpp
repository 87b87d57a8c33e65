#include "wale/result.hpp"

namespace wale {

std::string in_words(const Error& error) {
  return error.mend.empty() ? error.sentence : error.sentence + "; " + error.mend;
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
