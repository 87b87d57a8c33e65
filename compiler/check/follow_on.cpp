#include "compiler/check/follow_on.hpp"

#include <algorithm>
#include <map>
#include <set>
#include <string>
#include <string_view>

#include "compiler/text/characters.hpp"
#include "compiler/text/embedded_files.hpp"

namespace wale {
namespace {

/// W01xx are the codes of the lexer and the parser.
bool is_unread(const Diagnostic& diagnostic) { return static_cast<unsigned>(diagnostic.code) < 200; }

/// The places of errors, to ask whether a span contains one.
class Places {
 public:
  void add(Span span) { begins_[span.source].insert(span.begin); }
  bool any_in(Span span) const {
    const auto source = begins_.find(span.source);
    if (source == begins_.end()) return false;
    const auto first = source->second.lower_bound(span.begin);
    return first != source->second.end() && *first <= span.end;
  }

 private:
  std::map<SourceId, std::set<std::uint32_t>> begins_;
};

/// The first byte of the line in which a span begins.
std::pair<SourceId, std::size_t> line_of(Span span, const SourceSet& sources) {
  const std::string_view text = sources[span.source].text;
  const std::size_t newline = span.begin == 0 ? std::string_view::npos : text.rfind('\n', span.begin - 1);
  return {span.source, newline == std::string_view::npos ? 0 : newline + 1};
}

/// A declaration: its name and its span.
struct Stretch {
  Word name;
  Span span;
  bool is_record = false;
  bool declares = true;  ///< false for maps and levels, which are about a percept that is declared elsewhere
};

/// The declarations whose errors leave a name unknown. Failed constants and functions are known to `check` already.
std::vector<Stretch> stretches(const SyntaxTree& tree) {
  std::vector<Stretch> result;
  for (const Declaration& declaration : tree.declarations) {
    if (const auto* record = std::get_if<RecordDecl>(&declaration)) {
      result.push_back(
          {record->name, record->span, true, record->keyword.text != "map" && record->keyword.text != "levels"});
    } else if (const auto* unit = std::get_if<UnitDecl>(&declaration)) {
      const std::uint32_t end = unit->definition  ? tree.span(*unit->definition).end
                                : unit->dimension ? unit->dimension->span.end
                                                  : unit->name.span.end;
      result.push_back({unit->name, {tree.source, unit->name.span.begin, end}});
    } else if (const auto* dimension = std::get_if<DimensionDecl>(&declaration)) {
      const std::uint32_t end =
          dimension->definition ? tree.span(*dimension->definition).end : dimension->name.span.end;
      result.push_back({dimension->name, {tree.source, dimension->name.span.begin, end}});
    }
  }
  return result;
}

/// Adds the words of the line about the unreadable place: one of them may be the name that the line declares.
void add_words(Span span, const SourceSet& sources, std::set<std::string>& words) {
  const std::string_view line = sources.line(span);
  const auto begin = static_cast<std::size_t>(line.data() - sources[span.source].text.data());
  const std::size_t middle = std::min(line.size(), std::max<std::size_t>(span.end, begin) - begin);
  constexpr std::size_t longest_part = 256;  // in bytes; of longer lines only the nearest parts are searched
  const std::size_t end = std::min(line.size(), middle + longest_part);
  for (std::size_t at = middle > longest_part ? middle - longest_part : 0; at < end;) {
    std::size_t after = at;
    if (begins_name(line[at]))
      while (after < end && continues_name(line[after])) ++after;
    if (after > at) words.emplace(line.substr(at, after - at));
    at = std::max(after, at + 1);
  }
}

bool is_embedded(SourceId source, const SourceSet& sources) {
  return source >= first_embedded_source ||
         std::ranges::find(embedded_files(), sources[source].name, &EmbeddedFile::name) != embedded_files().end();
}

/// Adds another place of the same error to the first, with its fixes.
void add_repetition(Diagnostic& first, const Diagnostic& again) {
  if (again.span.begin < first.span.begin) {
    Diagnostic earlier = again;
    std::swap(first, earlier);
    first.secondary.insert(first.secondary.end(), earlier.secondary.begin(), earlier.secondary.end());
    return add_repetition(first, earlier);
  }
  constexpr std::size_t most_shown = 4;
  if (first.secondary.size() < most_shown) first.secondary.push_back({again.span, "and here"});
  for (Fix& fix : first.fixes)
    for (const Fix& other : again.fixes)
      if (other.title == fix.title) fix.edits.insert(fix.edits.end(), other.edits.begin(), other.edits.end());
}

/// What a wrong dimension comes from: the declaration that would be right in another unit, and what it was meant as.
std::optional<std::pair<std::pair<SourceId, std::uint32_t>, std::string>> origin_of(const Diagnostic& diagnostic) {
  if (diagnostic.code != Code::wrong_dimension) return std::nullopt;
  const Span* declared = nullptr;
  const std::string* meant = nullptr;
  for (const Fact& fact : diagnostic.facts) {
    if (fact.name == "declared") declared = std::get_if<Span>(&fact.value);
    if (fact.name == "meant") meant = std::get_if<std::string>(&fact.value);
  }
  if (!declared || !meant) return std::nullopt;
  return std::pair(std::pair(declared->source, declared->begin), *meant);
}

/// The name that the message is about: the text between its first backticks.
std::string subject(const Diagnostic& diagnostic) {
  const std::size_t begin = diagnostic.message.find('`');
  const std::size_t end = diagnostic.message.find('`', begin + 1);
  return end == std::string::npos ? "" : diagnostic.message.substr(begin + 1, end - begin - 1);
}

}  // namespace

Diagnostics without_follow_ons(const Diagnostics& diagnostics, const std::vector<const SyntaxTree*>& trees,
                               const SourceSet& sources, SourceId checked) {
  if (!diagnostics.has_errors()) return diagnostics;
  Places errors, unread;
  std::set<std::string> unread_words;
  // By line, the first place that cannot be read: it is why the rest of the line is not what was meant.
  std::map<std::pair<SourceId, std::size_t>, std::uint32_t> first_unread;
  std::set<SourceId> lacking;  // files that lack an import, which may declare any name
  for (const Diagnostic& each : diagnostics.all()) {
    if (severity_of(each.code) != Severity::error) continue;
    errors.add(each.span);
    if (each.code == Code::unknown_import) lacking.insert(each.span.source);
    if (!is_unread(each)) continue;
    unread.add(each.span);
    const auto [first, is_new] = first_unread.emplace(line_of(each.span, sources), each.span.begin);
    if (!is_new) first->second = std::min(first->second, each.span.begin);
    add_words(each.span, sources, unread_words);
  }
  std::multimap<std::string, Span> failed;
  std::vector<Span> torn_records;
  for (const SyntaxTree* tree : trees)
    for (const Stretch& each : stretches(*tree)) {
      if (each.declares && errors.any_in(each.span)) failed.emplace(each.name.text, each.span);
      if (each.is_record && unread.any_in(each.span)) torn_records.push_back(each.span);
    }

  const bool own_errors = std::ranges::any_of(diagnostics.all(), [&](const Diagnostic& each) {
    return each.span.source == checked && severity_of(each.code) == Severity::error;
  });

  const auto is_echo = [&](const Diagnostic& each) {
    if (own_errors && each.span.source != checked && is_embedded(each.span.source, sources)) return true;
    if (each.code == Code::missing_setting)
      return std::ranges::any_of(torn_records, [&](const Span& record) {
        return each.span.source == record.source && record.begin <= each.span.begin && each.span.begin <= record.end;
      });
    const auto unread_line = first_unread.find(line_of(each.span, sources));
    if (unread_line != first_unread.end() && severity_of(each.code) == Severity::error &&
        (!is_unread(each) || each.span.begin > unread_line->second))
      return true;
    if (each.code != Code::unknown_name && each.code != Code::unknown_unit) return false;
    const std::string name = subject(each);
    if (unread_words.contains(name)) return true;
    const bool is_misspelt = std::ranges::any_of(each.facts, [](const Fact& fact) { return fact.name == "meant"; });
    if (lacking.contains(each.span.source) && !is_misspelt) return true;
    const auto [first, last] = failed.equal_range(name);
    return std::any_of(first, last, [&](const auto& declared) {
      // A name that is used above its declaration is unknown even if the declaration is correct.
      return declared.second.source != each.span.source || declared.second.end < each.span.begin;
    });
  };
  std::vector<Diagnostic> kept;
  std::map<std::pair<SourceId, std::string>, std::size_t> first_of;
  std::map<std::pair<std::pair<SourceId, std::uint32_t>, std::string>, std::size_t> first_from;
  for (const Diagnostic& each : diagnostics.all()) {
    if (is_echo(each)) continue;
    if (const auto origin = origin_of(each)) {
      const auto [first, is_new] = first_from.emplace(*origin, kept.size());
      if (!is_new) {
        add_repetition(kept[first->second], each);
        continue;
      }
    }
    const bool unknown = each.code == Code::unknown_name || each.code == Code::unknown_unit;
    const auto [first, is_new] = first_of.emplace(std::pair(each.span.source, each.message), kept.size());
    if (unknown && !is_new && kept[first->second].code == each.code)
      add_repetition(kept[first->second], each);
    else
      kept.push_back(each);
  }
  Diagnostics result;
  for (Diagnostic& each : kept) result.report(std::move(each));
  return result.has_errors() == diagnostics.has_errors() ? result : diagnostics;
}

}  // namespace wale
