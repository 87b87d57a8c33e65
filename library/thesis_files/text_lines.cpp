#include "library/thesis_files/text_lines.hpp"

#include "schema/utf8.hpp"

namespace wale {
namespace {

constexpr std::size_t longest_text = 4 << 20;

bool is_control(char32_t code) { return (code < 0x20 && code != '\t') || code == 0x7f; }

}  // namespace

Result<std::vector<std::string>> lines_of_thesis_text(std::string_view text, const std::string& name) {
  const auto refuse = [&](Code code, std::size_t line, std::string sentence, std::string mend) {
    return Error{.code = code, .sentence = std::move(sentence), .mend = std::move(mend), .place = {.name = name, .number = line}};
  };
  if (text.size() > longest_text)
    return Error{.code = Code::too_long, .sentence = "a list of the thesis has at most 4 MB", .place = {.name = name}};
  if (text.starts_with("\xEF\xBB\xBF")) text.remove_prefix(3);
  std::vector<std::string> lines(1);
  for (std::size_t at = 0; at < text.size();) {
    const Character character = decode(text, at);
    if (!character.valid)
      return refuse(Code::invalid_encoding, lines.size(), "expected text in UTF-8, found other bytes",
                    "convert a list of a Macintosh by `iconv -f MACINTOSH -t UTF-8`");
    if (character.code == '\r' || character.code == '\n') {
      if (text.substr(at).starts_with("\r\n")) ++at;
      lines.emplace_back();
    } else if (is_control(character.code)) {
      return refuse(Code::damaged_file, lines.size(), "expected a list of names, found a control character",
                    "this is no text: name a movie or a shuffle");
    } else {
      lines.back().append(text.substr(at, character.bytes));
    }
    at += character.bytes;
  }
  return lines;
}

std::string_view without_blanks(std::string_view text) {
  constexpr std::string_view blanks = " \t";
  const std::size_t begin = text.find_first_not_of(blanks);
  return begin == std::string_view::npos ? std::string_view() : text.substr(begin, text.find_last_not_of(blanks) - begin + 1);
}

bool is_thesis_name(std::string_view name) {
  for (std::size_t at = 0; at < name.size();) {
    const Character character = decode(name, at);
    if (!character.valid || is_control(character.code)) return false;
    at += character.bytes;
  }
  // Not as a text with a byte order mark begins, which readers leave out.
  return !without_blanks(name).empty() && without_blanks(name) == name && !name.starts_with("\xEF\xBB\xBF");
}

}  // namespace wale
