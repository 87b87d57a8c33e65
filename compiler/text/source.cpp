#include "compiler/text/source.hpp"

#include <algorithm>

#include "compiler/text/embedded_files.hpp"

namespace wale {

SourceSet::Entry SourceSet::measured(std::string name, std::string text) {
  constexpr std::size_t bytes_of_a_line = 32;  // about; only for reserving memory
  std::vector<std::uint32_t> starts;
  starts.reserve(std::min(text.size(), largest_source) / bytes_of_a_line + 1);
  starts.push_back(0);
  // No span points into a file that is refused for its size, so its lines need not be indexed.
  const bool is_read = text.size() <= largest_source;
  for (std::size_t at = text.find('\n'); is_read && at != std::string::npos; at = text.find('\n', at + 1)) {
    starts.push_back(static_cast<std::uint32_t>(at + 1));
  }
  return {std::make_shared<const Source>(Source{std::move(name), std::move(text)}), std::move(starts)};
}

const std::vector<SourceSet::Entry>& SourceSet::embedded() {
  static const std::vector<Entry> entries = [] {
    std::vector<Entry> all;
    for (const auto& file : embedded_files()) all.push_back(measured(std::string(file.name), std::string(file.text)));
    return all;
  }();
  return entries;
}

SourceId SourceSet::add(std::string name, std::string text) {
  sources_.push_back(measured(std::move(name), std::move(text)));
  return static_cast<SourceId>(sources_.size() - 1);
}

std::string_view SourceSet::text(Span span) const {
  const std::string_view text = entry(span.source).source->text;
  const std::size_t begin = std::min<std::size_t>(span.begin, text.size());
  const std::size_t end = std::clamp<std::size_t>(span.end, begin, text.size());
  return text.substr(begin, end - begin);
}

std::size_t SourceSet::line_index(Span span) const {
  const auto& starts = entry(span.source).line_starts;
  return static_cast<std::size_t>(std::upper_bound(starts.begin(), starts.end(), span.begin) - starts.begin()) - 1;
}

LineColumn SourceSet::place(Span span) const {
  const std::string_view text = entry(span.source).source->text;
  const std::size_t line = line_index(span);
  const std::size_t end = std::min<std::size_t>(span.begin, text.size());
  LineColumn place{static_cast<unsigned>(line + 1), 1};
  // Columns count the bytes that begin a character. No span points past a byte that is not UTF-8.
  for (std::size_t at = entry(span.source).line_starts[line]; at < end; ++at)
    place.column += (static_cast<unsigned char>(text[at]) & 0xC0) != 0x80;
  return place;
}

std::string_view SourceSet::line(Span span) const {
  std::string_view text = entry(span.source).source->text;
  text.remove_prefix(entry(span.source).line_starts[line_index(span)]);
  text = text.substr(0, text.find('\n'));
  if (text.ends_with('\r')) text.remove_suffix(1);
  return text;
}

}  // namespace wale
