#include "schema/name_text.hpp"

#include <algorithm>

#include "schema/utf8.hpp"

namespace wale {

Result<> is_name_text(const std::string& argument, std::string_view text) {
  const auto refuse = [&](Code code, const char* sentence, const char* mend) {
    return Error{
        .code = code, .sentence = sentence, .mend = mend, .place = {.name = argument, .text = std::string(text)}};
  };
  for (std::size_t at = 0; at < text.size();) {
    const Character character = decode(text, at);
    if (!character.valid)
      return refuse(Code::invalid_encoding, "expected UTF-8, found other bytes", "convert the text to UTF-8");
    at += character.bytes;
  }
  if (text.find('\0') != std::string_view::npos)
    return refuse(Code::invalid_encoding, "expected a text, found a zero byte in it", "hand over the text up to there");
  constexpr const char* mend = "write a name, as in \"corduroy\" or \"roughness\"";
  if (text.find_first_not_of(" \t\n\v\f\r") == std::string_view::npos)
    return refuse(Code::malformed_value, "expected a name, found an empty text", mend);
  if (std::ranges::any_of(text, [](unsigned char c) { return c < ' ' || c == 0x7f; }))
    return refuse(Code::malformed_value, "expected a name, found a text with a line break or another control character",
                  mend);
  return {};
}

}  // namespace wale
