#include "library/index/find.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <tuple>
#include <vector>

#include "library/index/nearest.hpp"
#include "schema/spelling.hpp"
#include "schema/visible_text.hpp"

namespace wale {
namespace {

/// A row with what orders it.
struct ScoredRow {
  std::size_t row = 0;
  double score = 0;
};

/// Whether a row is of the sought kind, and none that is left out.
bool may_be_found(const FeltColumns& columns, std::size_t row, const MaterialQuery& sought) {
  const std::string_view kind = columns.kind(row), module = columns.module(row);
  const auto is_left_out = [&](const std::string& each) {
    return is_of_sought_kind(kind, each) || is_of_sought_kind(module, each);
  };
  return is_of_sought_kind(kind, sought.kind) &&
         std::ranges::find(sought.without, columns.material(row)) == sought.without.end() &&
         (!sought.kind.empty() || std::ranges::none_of(sought.without_kinds, is_left_out));
}

/// The rows that have the sought words, in the order of the rows.
Result<std::vector<ScoredRow>> rows_with_words(const MaterialIndex& index, const MaterialQuery& sought) {
  const FeltColumns& columns = index.columns();
  const auto may = [&](std::uint32_t material) {
    const auto row = columns.row_of(material);
    return row && may_be_found(columns, *row, sought);
  };
  std::vector<ScoredMaterial> all;
  bool first = true;
  for (const std::string& text : sought.texts) {
    auto found = search(index.words(), words_of(text), may);
    if (!found) return found.error();
    if (std::exchange(first, false)) {
      all = *std::move(found);
      continue;
    }
    // Both are in the order of the numbers.
    std::vector<ScoredMaterial> both;
    auto other = found->begin();
    for (const ScoredMaterial& each : all) {
      while (other != found->end() && other->material < each.material) ++other;
      if (other != found->end() && other->material == each.material)
        both.push_back({each.material, each.score + other->score});
    }
    all = std::move(both);
  }
  std::vector<ScoredRow> rows;
  rows.reserve(all.size());
  for (const ScoredMaterial& each : all) rows.push_back({*columns.row_of(each.material), each.score});
  return rows;
}

/// All rows of the sought kind.
std::vector<ScoredRow> rows_of_kind(const FeltColumns& columns, const MaterialQuery& sought) {
  std::vector<ScoredRow> rows;
  for (std::size_t row = 0; row < columns.size(); ++row)
    if (may_be_found(columns, row, sought)) rows.push_back({row, 0});
  return rows;
}

}  // namespace

bool is_of_sought_kind(std::string_view kind, std::string_view sought) {
  return kind.starts_with(sought) && (sought.empty() || kind.size() == sought.size() || kind[sought.size()] == '.');
}

Result<FoundEntries> find_entries(const MaterialIndex& index, const MaterialQuery& sought) {
  const FeltColumns& columns = index.columns();
  std::vector<ScoredRow> rows;
  if (!sought.texts.empty()) {
    auto found = rows_with_words(index, sought);
    if (!found) return found.error();
    rows = *std::move(found);
  } else if (!sought.feel) {
    rows = rows_of_kind(columns, sought);
  }
  FoundEntries all;
  if (sought.feel) {
    const bool by_words = !sought.texts.empty();
    std::vector<bool> has_words(by_words ? columns.size() : 0);
    for (const ScoredRow& each : rows) has_words[each.row] = true;
    const auto may = [&](std::size_t row) {
      if (by_words) return static_cast<bool>(has_words[row]);
      return may_be_found(columns, row, sought);
    };
    std::vector<ScoredRow> near;
    for (const NearRow& each : nearest(columns, *sought.feel, sought.most, may)) {
      const auto scored = std::ranges::lower_bound(rows, each.row, {}, &ScoredRow::row);
      near.push_back({each.row, scored == rows.end() || scored->row != each.row ? 0 : scored->score});
    }
    rows = std::move(near);
    all.all = rows.size();
  } else {
    all.all = rows.size();
    const auto before = [&](const ScoredRow& a, const ScoredRow& b) {
      if (a.score != b.score) return a.score > b.score;
      const auto key = [&](std::size_t row) {
        const std::string_view name = columns.name(row), module = columns.module(row);
        return sought.texts.empty() ? std::tuple(module, name, row) : std::tuple(name, module, row);
      };
      return key(a.row) < key(b.row);
    };
    const std::size_t given = std::min(sought.most, rows.size());
    std::ranges::partial_sort(rows, rows.begin() + static_cast<std::ptrdiff_t>(given), before);
    rows.resize(given);
  }
  std::vector<std::string> words;
  for (const std::string& text : sought.texts)
    for (std::string& word : words_of(text)) words.push_back(std::move(word));
  for (const ScoredRow& each : rows) {
    auto entry = index.entry(columns.material(each.row));
    if (!entry) return entry.error();
    FoundEntry& found = all.entries.emplace_back();
    found.why = why_found(*entry, words);
    found.entry = *std::move(entry);
    found.row = each.row, found.score = each.score;
    if (sought.feel) found.apart = sought.feel->tell(columns, each.row);
  }
  return all;
}

Result<std::uint32_t> meant_entry(const MaterialIndex& index, std::string_view text) {
  const auto found = index.meant_by(text);
  if (!found) return found.error();
  if (found->size() == 1) return found->front();
  const FeltColumns& columns = index.columns();
  const auto place = [&](std::uint32_t material) {
    const std::size_t row = columns.row_of(material).value_or(0);
    return fmt::format("{}.{}", columns.module(row), columns.name(row));
  };
  if (!found->empty()) {
    constexpr std::size_t most_told = 5;
    std::vector<std::string> places;
    std::ranges::transform(*found, std::back_inserter(places), place);
    std::ranges::sort(places);  // their numbers differ from one storage to another
    std::string all;
    for (std::size_t i = 0; i < std::min(places.size(), most_told); ++i)
      all += fmt::format("{}`{}`", i == 0 ? "" : ", ", places[i]);
    if (found->size() > most_told) all += fmt::format(" and {} more", found->size() - most_told);
    return Error{.code = Code::ambiguous_material,
                 .sentence = fmt::format("`{}` may be {} materials: {}", visible_text(text), found->size(), all),
                 .mend = fmt::format("name its module too, as in `{}`", places.front()),
                 .place = {.name = std::string(text)},
                 .nearest = places};
  }
  // The nearest name, of as many as there are. Among equally near ones it is the first by its bytes, since rows are in
  // another order in each storage.
  std::optional<std::pair<std::size_t, std::string>> near;
  for (std::size_t row = 0; row < columns.size(); ++row)
    if (const auto distance = distance_from(text, columns.name(row)); distance) {
      std::pair<std::size_t, std::string> here(*distance, columns.name(row));
      if (!near || here < *near) near = std::move(here);
    }
  return Error{.code = Code::unknown_name,
               .sentence = fmt::format("no material of the index is called `{}`", visible_text(text)),
               .mend = near ? fmt::format("the nearest: `{}`", near->second) : "`wale find WORD` searches the library",
               .place = {.name = std::string(text)},
               .nearest = near ? std::vector{near->second} : std::vector<std::string>{}};
}

}  // namespace wale
