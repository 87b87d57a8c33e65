#include "schema/name_text.hpp"

#include "schema/expectation.hpp"
#include "schema/utf8.hpp"

namespace wale {
namespace {

/// Control characters, and those that Unicode ends lines and paragraphs with.
bool is_control(char32_t c) { return c < ' ' || (c >= 0x7f && c < 0xa0) || c == 0x2028 || c == 0x2029; }

/// Unicode's white space, and characters that show nothing.
bool is_blank(char32_t c) {
  return (c >= '\t' && c <= '\r') || c == ' ' || c == 0x85 || c == 0xa0 || c == 0x1680 || (c >= 0x2000 && c <= 0x200d) ||
         c == 0x2028 || c == 0x2029 || c == 0x202f || c == 0x205f || c == 0x2060 || c == 0x3000 || c == 0xfeff;
}

}  // namespace

Result<> is_name_text(const std::string& argument, std::string_view text, const char* mend, const char* what) {
  const auto refuse = [&](Code code, const std::string& sentence, const char* what_to_do) {
    return with_expectation(
        {.code = code, .sentence = sentence, .mend = what_to_do, .place = {.name = argument, .text = std::string(text)}});
  };
  bool blank = true, controls = false;
  for (std::size_t at = 0; at < text.size();) {
    const Character character = decode(text, at);
    if (!character.valid)
      return refuse(Code::invalid_encoding, "expected UTF-8, found other bytes", "convert the text to UTF-8");
    blank = blank && is_blank(character.code);
    controls = controls || is_control(character.code);
    at += character.bytes;
  }
  if (text.find('\0') != std::string_view::npos)
    return refuse(Code::invalid_encoding, "expected a text, found a zero byte in it", "hand over the text up to there");
  if (blank)
    return refuse(Code::malformed_value, std::string("expected ") + what + ", found an empty text", mend);
  if (controls)
    return refuse(Code::malformed_value, std::string("expected ") + what + ", found a text with a line break or another control character", mend);
  return {};
}

Result<> is_path_text(const std::string& argument, std::string_view path) {
  if (path.find('\0') == std::string_view::npos) return {};
  return with_expectation({.code = Code::invalid_encoding,
                           .sentence = "expected a path, found a zero byte in it",
                           .mend = "hand over the text up to there",
                           .place = {.name = argument, .text = std::string(path)}});
}

}  // namespace wale
