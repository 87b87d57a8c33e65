#include "compiler/source.hpp"

#include <algorithm>

#include "compiler/utf8.hpp"

namespace wale {

SourceId SourceSet::add(std::string name, std::string text) {
  std::vector<std::uint32_t> starts = {0};
  for (std::size_t at = text.find('\n'); at != std::string::npos; at = text.find('\n', at + 1)) {
    starts.push_back(static_cast<std::uint32_t>(at + 1));
  }
  line_starts_.push_back(std::move(starts));
  sources_.push_back({std::move(name), std::move(text)});
  return static_cast<SourceId>(sources_.size() - 1);
}

std::string_view SourceSet::text(Span span) const {
  const std::string_view text = sources_[span.source].text;
  const std::size_t begin = std::min<std::size_t>(span.begin, text.size());
  const std::size_t end = std::clamp<std::size_t>(span.end, begin, text.size());
  return text.substr(begin, end - begin);
}

std::size_t SourceSet::line_index(Span span) const {
  const auto& starts = line_starts_[span.source];
  return static_cast<std::size_t>(std::upper_bound(starts.begin(), starts.end(), span.begin) - starts.begin()) - 1;
}

Place SourceSet::place(Span span) const {
  const std::string_view text = sources_[span.source].text;
  const std::size_t line = line_index(span);
  const std::size_t end = std::min<std::size_t>(span.begin, text.size());
  Place place{static_cast<unsigned>(line + 1), 1};
  for (std::size_t at = line_starts_[span.source][line]; at < end; at += decode(text, at).bytes) ++place.column;
  return place;
}

std::string_view SourceSet::line(Span span) const {
  std::string_view text = sources_[span.source].text;
  text.remove_prefix(line_starts_[span.source][line_index(span)]);
  text = text.substr(0, text.find('\n'));
  if (text.ends_with('\r')) text.remove_suffix(1);
  return text;
}

}  // namespace wale
