#include "library/survey/coverage.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <nlohmann/json.hpp>

#include "compiler/text/readable.hpp"

namespace wale {
namespace {

constexpr double least_gap = 0.1;
constexpr std::size_t most_paired = 6;  // percepts
constexpr int cells = 20;               // of a pair's square, each way

double within(double level) { return std::clamp(level, 0.0, 1.0); }

std::vector<EmptyRange> gaps_of(const std::vector<CoveredLevel>& levels) {
  std::vector<LevelBounds> covered;
  for (const CoveredLevel& each : levels) covered.push_back(each.means);
  std::ranges::sort(covered, {}, &LevelBounds::low);
  std::vector<EmptyRange> gaps;
  double reached = 0;
  const auto add = [&](double until) {
    if (until - reached >= least_gap) gaps.push_back({reached, until});
  };
  for (const LevelBounds& each : covered) add(each.low), reached = std::max(reached, each.high);
  add(1);
  std::ranges::stable_sort(gaps, std::greater<>(), [](const EmptyRange& each) { return each.high - each.low; });
  return gaps;
}

/// The largest rectangle of a pair's square whose cells no material reaches.
void find_empty(CoveredPair& pair, const std::vector<std::pair<LevelBounds, LevelBounds>>& points) {
  std::array<std::array<int, cells + 1>, cells + 1> sums{};  // of reached cells below and left of a corner
  const auto first = [](double level) { return std::clamp(static_cast<int>(level * cells), 0, cells - 1); };
  std::array<std::array<bool, cells>, cells> reached{};
  for (const auto& [a, b] : points)
    for (int x = first(a.low); x <= first(a.high); ++x)
      for (int y = first(b.low); y <= first(b.high); ++y) reached[x][y] = true;
  for (int x = 0; x < cells; ++x)
    for (int y = 0; y < cells; ++y)
      sums[x + 1][y + 1] = sums[x][y + 1] + sums[x + 1][y] - sums[x][y] + (reached[x][y] ? 1 : 0);
  int best = 0;
  for (int left = 0; left < cells; ++left)
    for (int right = left + 1; right <= cells; ++right)
      for (int low = 0; low < cells; ++low)
        for (int high = cells; high > low; --high) {
          const int area = (right - left) * (high - low);
          if (area <= best) break;  // and smaller below
          if (sums[right][high] - sums[left][high] - sums[right][low] + sums[left][low] > 0) continue;
          best = area;
          pair.empty_a = {double(left) / cells, double(right) / cells};
          pair.empty_b = {double(low) / cells, double(high) / cells};
        }
}

std::string range_text(const EmptyRange& range) { return readable("{:.2f} to {:.2f}", range.low, range.high); }

nlohmann::ordered_json range_json(const EmptyRange& range) { return {{"low", range.low}, {"high", range.high}}; }

}  // namespace

Coverage coverage_of(const std::vector<Entry>& entries, const std::vector<std::string>& known) {
  Coverage coverage;
  std::map<std::string, CoveredPercept> percepts;
  std::map<std::string, std::map<const Entry*, LevelBounds>> bounds;
  for (const Entry& entry : entries) {
    if (entry.program.empty()) continue;
    ++coverage.materials;
    bool any = false;
    for (const EntryPercept& each : entry.felt.percepts) {
      if (!each.reads) continue;
      any = true;
      const double reads = within(*each.reads);
      const LevelBounds means = {std::min(within(each.means.low), reads), std::max(within(each.means.high), reads)};
      if (!bounds[each.name].emplace(&entry, means).second) continue;
      percepts[each.name].levels.push_back({entry.name, reads, means});
    }
    coverage.without += !any;
  }
  for (auto& [name, percept] : percepts) {
    percept.percept = name;
    std::ranges::stable_sort(percept.levels, {}, &CoveredLevel::reads);
    percept.empty = gaps_of(percept.levels);
    coverage.percepts.push_back(std::move(percept));
  }
  std::ranges::stable_sort(coverage.percepts, std::greater<>(),
                           [](const CoveredPercept& each) { return each.levels.size(); });
  const std::size_t paired = std::min(coverage.percepts.size(), most_paired);
  for (std::size_t a = 0; a < paired; ++a)
    for (std::size_t b = a + 1; b < paired; ++b) {
      CoveredPair& pair = coverage.pairs.emplace_back(CoveredPair{.a = a, .b = b, .empty_a = {}, .empty_b = {}});
      const auto &of_a = bounds[coverage.percepts[a].percept], &of_b = bounds[coverage.percepts[b].percept];
      std::vector<std::pair<LevelBounds, LevelBounds>> points;
      for (const auto& [entry, means] : of_a)
        if (const auto other = of_b.find(entry); other != of_b.end()) points.emplace_back(means, other->second);
      pair.materials = points.size();
      find_empty(pair, points);
    }
  for (const std::string& each : known)
    if (!bounds.contains(each)) coverage.unfelt.push_back(each);
  return coverage;
}

std::string coverage_text(const Coverage& coverage) {
  std::string text = readable("{} material{}, of which {} read no percept\n", coverage.materials,
                              coverage.materials == 1 ? "" : "s", coverage.without);
  for (const CoveredPercept& each : coverage.percepts) {
    text += readable("  {:<14} {:>4} material{}, {:.2f} to {:.2f}", each.percept, each.levels.size(),
                     each.levels.size() == 1 ? "" : "s", each.levels.front().reads, each.levels.back().reads);
    std::string gaps;
    for (const EmptyRange& gap : each.empty) gaps += (gaps.empty() ? "; none from " : ", from ") + range_text(gap);
    text += gaps + "\n";
  }
  if (!coverage.unfelt.empty()) {
    text += "no material has";
    for (std::size_t i = 0; i < coverage.unfelt.size(); ++i) text += (i == 0 ? " " : ", ") + coverage.unfelt[i];
    text += "\n";
  }
  if (!coverage.pairs.empty()) text += "largest empty regions of two percepts at once\n";
  for (const CoveredPair& pair : coverage.pairs) {
    const std::string &a = coverage.percepts[pair.a].percept, &b = coverage.percepts[pair.b].percept;
    if (pair.materials == 0)
      text += fmt::format("  no material has {} and {} at once\n", a, b);
    else
      text += readable("  {} {} with {} {}  ({} ha{} both)\n", a, range_text(pair.empty_a), b, range_text(pair.empty_b),
                       pair.materials, pair.materials == 1 ? "s" : "ve");
  }
  return text;
}

std::string coverage_json(const Coverage& coverage) {
  using Json = nlohmann::ordered_json;
  Json percepts = Json::object(), pairs = Json::array();
  for (const CoveredPercept& each : coverage.percepts) {
    Json levels = Json::array(), empty = Json::array();
    for (const CoveredLevel& level : each.levels)
      levels.push_back({{"material", level.material},
                        {"reads", level.reads},
                        {"means", {{"low", level.means.low}, {"high", level.means.high}}}});
    for (const EmptyRange& gap : each.empty) empty.push_back(range_json(gap));
    percepts[each.percept] = {{"materials", std::move(levels)}, {"empty", std::move(empty)}};
  }
  for (const CoveredPair& pair : coverage.pairs)
    pairs.push_back({{"a", coverage.percepts[pair.a].percept},
                     {"b", coverage.percepts[pair.b].percept},
                     {"materials", pair.materials},
                     {"empty", {{"a", range_json(pair.empty_a)}, {"b", range_json(pair.empty_b)}}}});
  const Json json = {{"materials", coverage.materials}, {"without_percepts", coverage.without},
                     {"percepts", std::move(percepts)}, {"unfelt", coverage.unfelt},
                     {"pairs", std::move(pairs)}};
  return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

}  // namespace wale
