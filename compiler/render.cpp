#include "compiler/render.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <optional>

#include "compiler/utf8.hpp"

namespace wale {
namespace {

constexpr std::size_t tab_width = 4;
/// Longer lines are cut to this many characters around the place; terminals wrap and then no caret points anywhere.
constexpr std::size_t widest_line = 140;
/// How much of a cut line stays visible before the place.
constexpr std::size_t context_before = 30;

/// One column of a displayed line: the bytes that fill it.
using Columns = std::vector<std::string>;

struct DisplayedLine {
  Columns columns;
  std::size_t begin = 0, end = 0;  ///< columns of the carets
};

/// Control characters and broken UTF-8 become visible and harmless: a file must not steer the reader's terminal.
std::string displayable(std::string_view bytes, const Character& character) {
  const bool control = character.code < ' ' || (character.code >= 0x7F && character.code < 0xA0);
  const bool reorders =
      (character.code >= 0x202A && character.code <= 0x202E) || (character.code >= 0x2066 && character.code <= 0x2069);
  return character.valid && !control && !reorders ? std::string(bytes) : "\uFFFD";
}

/// The line as columns, and the carets below the bytes `begin` .. `end`. Of a line of megabytes only the surroundings
/// of the place are looked at.
DisplayedLine display(std::string_view line, std::size_t begin, std::size_t end) {
  DisplayedLine result;
  constexpr std::size_t most_bytes = 4 * 4 * widest_line;  // of UTF-8, to either side
  begin = std::min(begin, line.size());
  end = std::min(end, begin + most_bytes);
  std::size_t from = begin > most_bytes ? begin - most_bytes : 0;
  while (from > 0 && (static_cast<unsigned char>(line[from]) & 0xC0) == 0x80) --from;
  line = line.substr(from, begin - from + 2 * most_bytes);
  begin -= from;
  end = std::max(end, begin + from) - from;
  std::optional<std::size_t> first, last;
  for (std::size_t at = 0; at < line.size();) {
    if (!first && at >= begin) first = result.columns.size();
    if (!last && at >= end) last = result.columns.size();
    const Character character = decode(line, at);
    if (character.code == '\t') {
      do {
        result.columns.push_back(" ");
      } while (result.columns.size() % tab_width != 0);
    } else {
      result.columns.push_back(displayable(line.substr(at, character.bytes), character));
    }
    at += character.bytes;
  }
  result.begin = first.value_or(result.columns.size());
  result.end = std::max(last.value_or(result.columns.size()), result.begin + 1);
  return result;
}

/// Cuts a very long line to the surroundings of the carets.
void trim(DisplayedLine& line) {
  if (line.columns.size() <= widest_line) return;
  std::size_t from = line.begin > context_before ? line.begin - context_before : 0;
  from = std::min(from, line.columns.size() - std::min(line.columns.size(), widest_line));
  const std::size_t to = std::min(line.columns.size(), from + widest_line);
  Columns kept(line.columns.begin() + static_cast<std::ptrdiff_t>(from),
               line.columns.begin() + static_cast<std::ptrdiff_t>(to));
  if (from > 0) kept.front() = "…";
  if (to < line.columns.size()) kept.back() = "…";
  line.columns = std::move(kept);
  line.begin -= from;
  line.end = std::max(std::min(line.end - from, line.columns.size()), line.begin + 1);
}

struct Palette {
  std::string_view severity, bold, gutter, off;
};

constexpr Palette plain = {"", "", "", ""};
constexpr Palette error_colours = {"\x1b[1;31m", "\x1b[1m", "\x1b[1;34m", "\x1b[0m"};
constexpr Palette warning_colours = {"\x1b[1;33m", "\x1b[1m", "\x1b[1;34m", "\x1b[0m"};

const char* severity_name(Severity severity) { return severity == Severity::error ? "error" : "warning"; }

/// The lines of a note after the first stand below its first character.
std::string indented(std::string_view text, std::size_t indent) {
  std::string result;
  for (std::size_t at = 0; at < text.size();) {
    const Character character = decode(text, at);
    if (character.code == '\n') {
      result += '\n' + std::string(indent, ' ');
    } else {
      result += displayable(text.substr(at, character.bytes), character);
    }
    at += character.bytes;
  }
  return result;
}

}  // namespace

std::string render_text(const Diagnostic& diagnostic, const SourceSet& sources, bool colour) {
  const Severity severity = severity_of(diagnostic.code);
  const Palette& paint = !colour ? plain : severity == Severity::error ? error_colours : warning_colours;
  // What is wrong with a command line rather than a file has no place.
  const bool has_place = diagnostic.span.source < sources.size();
  const Place place = has_place ? sources.place(diagnostic.span) : Place{};
  const std::string line_number = std::to_string(place.line);
  const std::string margin(line_number.size() + 1, ' ');

  std::string out =
      fmt::format("{}{}[{}]{}{}: {}{}\n", paint.severity, severity_name(severity), code_name(diagnostic.code),
                  paint.off, paint.bold, indented(diagnostic.message, 0), paint.off);
  if (has_place) {
    const std::string_view line = sources.line(diagnostic.span);
    const auto line_begin = static_cast<std::size_t>(line.data() - sources[diagnostic.span.source].text.data());
    DisplayedLine shown =
        display(line, diagnostic.span.begin - std::min<std::size_t>(line_begin, diagnostic.span.begin),
                diagnostic.span.end - std::min<std::size_t>(line_begin, diagnostic.span.end));
    trim(shown);
    std::string text;
    for (const std::string& column : shown.columns) text += column;
    out += fmt::format("{}{}-->{} {}:{}:{}\n", margin, paint.gutter, paint.off, sources[diagnostic.span.source].name,
                       place.line, place.column);
    out += fmt::format("{}{} |{}\n", margin, paint.gutter, paint.off);
    out += fmt::format(" {}{} |{}{}{}\n", paint.gutter, line_number, paint.off, text.empty() ? "" : " ", text);
    out += fmt::format("{}{} |{} {}{}{}{}{}{}\n", margin, paint.gutter, paint.off, std::string(shown.begin, ' '),
                       paint.severity, std::string(shown.end - shown.begin, '^'), diagnostic.label.empty() ? "" : " ",
                       indented(diagnostic.label, 0), paint.off);
  }
  if (diagnostic.expected.empty() && diagnostic.found.empty() && diagnostic.help.empty()) return out;

  out += fmt::format("{}{} |{}\n", margin, paint.gutter, paint.off);
  const std::size_t note_indent = margin.size() + 3;  // beyond " = "
  std::string sign = fmt::format("{} {}={} ", margin, paint.gutter, paint.off);
  const auto note = [&](std::string_view title, const std::string& text) {
    if (text.empty()) return;
    out += fmt::format("{}{}{}\n", sign, title, indented(text, note_indent + title.size()));
    if (title != "help: ") sign = std::string(note_indent, ' ');
  };
  note("expected  ", diagnostic.expected);
  note("found     ", diagnostic.found);
  sign = fmt::format("{} {}={} ", margin, paint.gutter, paint.off);
  note("help: ", diagnostic.help);
  return out;
}

std::string render_json(const Diagnostics& diagnostics, const SourceSet& sources) {
  using Json = nlohmann::ordered_json;
  Json list = Json::array();
  for (const Diagnostic& each : diagnostics.all()) {
    Json object = {{"code", code_name(each.code)}, {"severity", severity_name(severity_of(each.code))}};
    if (each.span.source < sources.size()) {
      const Place begin = sources.place(each.span);
      const Place end = sources.place({each.span.source, each.span.end, each.span.end});
      object["file"] = sources[each.span.source].name;
      object["line"] = begin.line;
      object["column"] = begin.column;
      object["end_line"] = end.line;
      object["end_column"] = end.column;
    }
    object["message"] = each.message;
    if (!each.expected.empty()) object["expected"] = each.expected;
    if (!each.found.empty()) object["found"] = each.found;
    if (!each.help.empty()) object["help"] = each.help;
    list.push_back(std::move(object));
  }
  constexpr int indent = 2;
  return list.dump(indent, ' ', false, Json::error_handler_t::replace);
}

}  // namespace wale
