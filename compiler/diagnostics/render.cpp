#include "compiler/diagnostics/render.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <optional>

#include "schema/utf8.hpp"
#include "schema/visible_text.hpp"

namespace wale {
namespace {

constexpr std::size_t tab_width = 4;
/// Longer lines are cut to this many characters around the place: terminals wrap lines, and then carets point nowhere.
constexpr std::size_t widest_line = 140;
/// The part of a cut line that stays visible before the place.
constexpr std::size_t context_before = 30;

/// One column of a displayed line and the bytes in it.
using Columns = std::vector<std::string>;

struct DisplayedLine {
  Columns columns;
  std::size_t begin = 0, end = 0;  ///< columns of the carets
};

/// A character in one column, as carets below it need: what a terminal would obey and broken UTF-8 become U+FFFD.
std::string displayable(std::string_view bytes, const Character& character) {
  return character.valid && !is_obeyed_by_terminals(character.code) ? std::string(bytes) : "\uFFFD";
}

/// The line as columns, with carets below the bytes `begin` .. `end`. Only the surroundings of the place are read: a
/// line may have megabytes.
DisplayedLine display(std::string_view line, std::size_t begin, std::size_t end) {
  DisplayedLine result;
  constexpr std::size_t most_bytes = 4 * 4 * widest_line;  // of UTF-8, on either side
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

/// The further lines of a note start below its first character.
std::string indented(std::string_view text, std::size_t indent) {
  std::string result = visible_lines(text);
  for (std::size_t at = result.find('\n'); at != std::string::npos; at = result.find('\n', at + 1))
    result.insert(at + 1, indent, ' ');
  return result;
}

/// A span and the character that underlines it.
struct Marked {
  Span span;
  std::string_view label;
  char sign = '-';
};

/// The underlined spans of one file by line, the primary span's line first.
using MarkedLines = std::map<unsigned, std::vector<Marked>>;

/// The excerpt of a diagnostic's files: lines with their numbers, and marks below them.
class Excerpt {
 public:
  Excerpt(const Diagnostic& diagnostic, const SourceSet& sources, const Palette& paint)
      : sources_(sources), paint_(paint) {
    mark({diagnostic.span, diagnostic.label, '^'});
    for (const SecondarySpan& each : diagnostic.secondary) mark({each.span, each.label});
    unsigned last_line = 1;
    for (const auto& [source, lines] : files_)
      if (!lines.empty()) last_line = std::max(last_line, lines.rbegin()->first);
    number_width_ = std::to_string(last_line).size();
  }

  /// Whether there is a line to show, so that a bar sets the notes apart from it.
  bool shows_lines() const {
    return std::ranges::any_of(files_, [&](const auto& file) { return !sources_[file.first].text.empty(); });
  }

  std::string margin() const { return std::string(number_width_ + 1, ' '); }

  /// The file of the primary span first, then the others in the order in which they are named.
  std::string text() const {
    std::string out;
    for (const auto& [source, lines] : files_) {
      const bool primary = out.empty();
      if (sources_[source].text.empty()) {  // it was not read: there is no line to show
        out += fmt::format("{}{}{}{} {}\n", margin(), paint_.gutter, primary ? "-->" : ":::", paint_.off,
                           visible_text(sources_[source].name));
        continue;
      }
      const LineColumn place = sources_.place(primary ? files_.front().second.at(primary_line_).front().span
                                                      : lines.begin()->second.front().span);
      out += fmt::format("{}{}{}{} {}:{}:{}\n", margin(), paint_.gutter, primary ? "-->" : ":::", paint_.off,
                         visible_text(sources_[source].name), place.line, place.column);
      out += fmt::format("{}{} |{}\n", margin(), paint_.gutter, paint_.off);
      unsigned previous = 0;
      for (const auto& [number, marks] : lines) {
        if (previous != 0 && number > previous + 1) out += fmt::format("{}...{}\n", paint_.gutter, paint_.off);
        out += line(number, marks);
        previous = number;
      }
    }
    return out;
  }

 private:
  void mark(const Marked& marked) {
    if (marked.span.source >= sources_.size()) return;
    const unsigned line = sources_.place(marked.span).line;
    if (files_.empty()) primary_line_ = line;
    auto file = std::ranges::find(files_, marked.span.source, &std::pair<SourceId, MarkedLines>::first);
    if (file == files_.end()) file = files_.insert(file, {marked.span.source, {}});
    file->second[line].push_back(marked);
  }

  DisplayedLine displayed(const Marked& marked) const {
    const std::string_view line = sources_.line(marked.span);
    const auto line_begin = static_cast<std::size_t>(line.data() - sources_[marked.span.source].text.data());
    DisplayedLine shown = display(line, marked.span.begin - std::min<std::size_t>(line_begin, marked.span.begin),
                                  marked.span.end - std::min<std::size_t>(line_begin, marked.span.end));
    trim(shown);
    return shown;
  }

  /// A long line is cut around its first mark; a mark beyond the cut gets its own excerpt.
  std::string line(unsigned number, const std::vector<Marked>& marks) const {
    std::string out, before;
    for (const Marked& marked : marks) {
      const DisplayedLine shown = displayed(marked);
      std::string text;
      for (const std::string& column : shown.columns) text += column;
      if (out.empty() || text != before)
        out += fmt::format(" {}{:>{}} |{}{}{}\n", paint_.gutter, number, number_width_, paint_.off,
                           text.empty() ? "" : " ", text);
      before = std::move(text);
      out += fmt::format("{}{} |{} {}{}{}{}{}{}\n", margin(), paint_.gutter, paint_.off, std::string(shown.begin, ' '),
                         marked.sign == '^' ? paint_.severity : paint_.gutter,
                         std::string(shown.end - shown.begin, marked.sign), marked.label.empty() ? "" : " ",
                         visible_text(marked.label), paint_.off);
    }
    return out;
  }

  const SourceSet& sources_;
  const Palette& paint_;
  std::vector<std::pair<SourceId, MarkedLines>> files_;
  unsigned primary_line_ = 1;
  std::size_t number_width_ = 1;
};

}  // namespace

std::string_view severity_name(Severity severity) { return severity == Severity::error ? "error" : "warning"; }

std::string render_text(const Diagnostic& diagnostic, const SourceSet& sources, bool colour) {
  const Severity severity = severity_of(diagnostic.code);
  const Palette& paint = !colour ? plain : severity == Severity::error ? error_colours : warning_colours;
  std::string out =
      fmt::format("{}{}[{}]{}{}: {}{}\n", paint.severity, severity_name(severity), code_name(diagnostic.code),
                  paint.off, paint.bold, visible_text(diagnostic.message), paint.off);
  // An error of a command line has no place in a file.
  const Excerpt excerpt(diagnostic, sources, paint);
  out += excerpt.text();
  const std::string margin = excerpt.margin();

  const std::size_t note_indent = margin.size() + 3;  // beyond " = "
  const std::string sign = fmt::format("{} {}={} ", margin, paint.gutter, paint.off);
  std::string notes;
  const auto note = [&](const std::string& before, std::string_view title, const std::string& text) {
    if (!text.empty()) notes += fmt::format("{}{}{}\n", before, title, indented(text, note_indent + title.size()));
  };
  note(sign, "expected  ", diagnostic.expected);
  note(notes.empty() ? sign : std::string(note_indent, ' '), "found     ", diagnostic.found);
  note(sign, "cause: ", diagnostic.cause);
  note(sign, "rule: ", diagnostic.rule);
  note(sign, "help: ", diagnostic.help);
  if (!notes.empty() && excerpt.shows_lines()) out += fmt::format("{}{} |{}\n", margin, paint.gutter, paint.off);
  return out + notes;
}

}  // namespace wale
