#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

namespace wale {

using SourceId = std::uint32_t;

/// Files larger than this, in bytes, are refused (W0109). A material has a few hundred lines; measured tables are in
/// files of their own.
constexpr std::size_t largest_source = 4u << 20;

/// A part of the source text: bytes `begin` up to but not including `end` of one file.
struct Span {
  SourceId source = 0;
  std::uint32_t begin = 0, end = 0;

  friend bool operator==(const Span&, const Span&) = default;
};

/// Line and column as people count them: from 1, columns in characters (UTF-8 code points).
struct LineColumn {
  unsigned line = 1, column = 1;
};

/// One file's text, with the name that diagnostics show.
struct Source {
  std::string name;
  std::string text;
};

/// The ids of the files that are part of the binary begin here: they are the same in every compilation.
inline constexpr SourceId first_embedded_source = 1u << 31;
/// The id of `embedded_files()[index]`.
constexpr SourceId embedded_source(std::size_t index) { return first_embedded_source + static_cast<SourceId>(index); }

/// All texts that a compilation has read, and the embedded files, which every compilation knows. A `Span` is a part of
/// one of them.
class SourceSet {
 public:
  SourceId add(std::string name, std::string text);
  const Source& operator[](SourceId id) const { return *entry(id).source; }
  /// The same, for owners of views into the text.
  std::shared_ptr<const Source> kept(SourceId id) const { return entry(id).source; }
  std::size_t size() const { return sources_.size(); }

  std::string_view text(Span span) const;
  LineColumn place(Span span) const;       ///< of the span's first character
  std::string_view line(Span span) const;  ///< the whole first line of the span, without its newline

 private:
  struct Entry {
    std::shared_ptr<const Source> source;
    std::vector<std::uint32_t> line_starts;  ///< the byte at which each line begins
  };
  static Entry measured(std::string name, std::string text);
  static const std::vector<Entry>& embedded();
  const Entry& entry(SourceId id) const {
    return id >= first_embedded_source ? embedded()[id - first_embedded_source] : sources_[id];
  }
  std::size_t line_index(Span span) const;  ///< the line in which the span begins, from 0

  std::vector<Entry> sources_;
};

}  // namespace wale
