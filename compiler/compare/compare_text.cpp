#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <numbers>

#include "compiler/compare/compare.hpp"
#include "compiler/describe/describe.hpp"
#include "compiler/describe/describe_figure.hpp"
#include "compiler/text/json_text.hpp"
#include "compiler/text/readable.hpp"

namespace wale {
namespace {

constexpr std::size_t most_in_table = 16;  // materials; a larger table does not fit a screen
constexpr const char* shapes_are_not = "  (the position and the shape of features are not compared)\n";
constexpr std::size_t most_listed = 20;  // pairs

const CueFacts& facts_of(CueKind kind) { return cue_table()[static_cast<std::size_t>(kind)]; }

/// "2.5 mm", "1.93 N", "45 degrees", "none": three significant digits, and `more`.
std::string cue_text(CueKind kind, const std::optional<double>& value, int more = 0) {
  if (!value) return "none";
  if (std::string_view(facts_of(kind).unit) == "m") return with_digits(1e3 * *value, 3 + more) + " mm";
  if (std::string_view(facts_of(kind).unit) == "rad") {
    // 180 degrees is the same as 0: a texture has no front.
    const double unit = std::pow(10, -more);
    const double rounded = std::round(*value * 180 / std::numbers::pi / unit) * unit;
    return in_degrees(fmt::format("{:.{}f}", std::fmod(rounded, is_full_direction(kind) ? 360 : 180) + 0.0, more));
  }
  const CueFacts& facts = facts_of(kind);
  return fmt::format("{}{}{}", with_digits(*value, 3 + more), *facts.unit ? " " : "", facts.unit);
}

/// Both values of a cue; with more digits if they differ and three digits would not show it.
std::pair<std::string, std::string> cue_texts(const CueDifference& cue) {
  constexpr int most = 3;
  for (int more = 0;; ++more) {
    std::pair texts{cue_text(cue.kind, cue.a, more), cue_text(cue.kind, cue.b, more)};
    if (texts.first != texts.second || cue.noticeable == 0.0 || more == most) return texts;
  }
}

std::string noticeable_text(const std::optional<double>& noticeable) {
  if (!noticeable) return "unknown";
  if (*noticeable > 20) return "> 20";
  return fmt::format("{:.1f}", *noticeable);
}

std::string verdict_text(const Comparison& comparison) {
  const CueDifference* plainest = comparison.plainest();
  switch (comparison.verdict) {
    case Verdict::apart:
      return fmt::format(
          "people can tell them apart, most easily by their {}{}", facts_of(plainest->kind).name,
          plainest->a.value_or(0) * plainest->b.value_or(0) < 0 ? ", which has the opposite direction" : "");
    case Verdict::alike: return "hard to tell apart: no cue differs by a noticeable amount";
    case Verdict::unknown: break;
  }
  std::string cues;
  for (const CueDifference& cue : comparison.cues)
    if (!cue.noticeable) cues += (cues.empty() ? "" : ", ") + std::string(facts_of(cue.kind).name);
  return "unknown: they differ in " + cues + ", which has no known threshold, and no other cue differs noticeably";
}

/// The distance of two materials as a cell of a table.
std::string cell_text(const Distance& distance) {
  return distance.verdict == Verdict::unknown ? "?" : noticeable_text(distance.noticeable);
}

void write_cues(std::string& text, const ComparisonMatrix& matrix, std::size_t first, std::size_t second) {
  const std::string &a = matrix.materials()[first].material, &b = matrix.materials()[second].material;
  const Comparison comparison = matrix.compare(first, second);
  const std::size_t width = std::max({a.size(), b.size(), std::size_t{14}});
  text += fmt::format("  {:<20} {:<{}}  {:<{}}  noticeable differences\n", "", a, width, b, width);
  for (const CueDifference& cue : comparison.cues) {
    const auto [of_a, of_b] = cue_texts(cue);
    text += fmt::format("  {:<20} {:<{}}  {:<{}}  {}", facts_of(cue.kind).name, of_a, width, of_b, width,
                        noticeable_text(cue.noticeable));
    if (!cue.noticeable)
      text += fmt::format("  ({})", cue.why_unknown);
    else if (cue.floor)
      text += fmt::format("  ({})", floor_words(*cue.floor, cue.least, facts_of(cue.kind).unit));
    else if (cue.threshold)
      text += readable("  ({:.2g} at d' = 1, {}: {})", cue.threshold->weber,
                       threshold_words(*cue.threshold, cue.evidence, cue.outside), cue.threshold->source);
    text += '\n';
  }
  text += fmt::format("  {}\n", verdict_text(comparison));
}

void write_table(std::string& text, const ComparisonMatrix& matrix) {
  std::size_t width = 8;
  for (const Cues& cues : matrix.materials()) width = std::max(width, cues.material.size());
  const std::size_t count = matrix.materials().size();
  text += fmt::format("  {:<{}}", "", width + 4);
  for (std::size_t i = 0; i < count; ++i) text += fmt::format(" {:>5}", i + 1);
  text += '\n';
  for (std::size_t row = 0; row < count; ++row) {
    text += fmt::format("  {:>3} {:<{}}", row + 1, matrix.materials()[row].material, width);
    for (std::size_t column = 0; column <= row; ++column) text += column == row ? "     -" : "      ";
    for (std::size_t column = row + 1; column < count; ++column)
      text += fmt::format(" {:>5}", cell_text(matrix.distance(row, column)));
    text += '\n';
  }
  text += "  in just noticeable differences of the cue that differs most; ?: no threshold is known\n";
}

/// For many materials: the pairs that people can hardly tell apart. The table of all pairs is in the JSON.
void write_alike(std::string& text, const ComparisonMatrix& matrix) {
  const std::size_t alike = matrix.count(Verdict::alike), unknown = matrix.count(Verdict::unknown);
  text += readable("{} of {} pairs are hard to tell apart{}\n", alike, matrix.pair_count(), alike > 0 ? ":" : "");
  for (const ComparedPair& pair : matrix.nearest(most_listed))
    if (pair.distance.verdict == Verdict::alike)
      text += readable("  {:>4}  {} and {}\n", cell_text(pair.distance), matrix.materials()[pair.a].material,
                       matrix.materials()[pair.b].material);
  if (alike > most_listed) text += readable("  and {} more; --json has all distances\n", alike - most_listed);
  if (unknown > 0)
    text += readable("{} unknown: {} in a cue that has no known threshold\n",
                     unknown == 1 ? "1 pair is" : readable("{} pairs are", unknown),
                     unknown == 1 ? "it differs" : "they differ");
}

/// One pair cue by cue, as JSON.
nlohmann::ordered_json pair_json(const ComparisonMatrix& matrix, std::size_t a, std::size_t b) {
  using Json = nlohmann::ordered_json;
  const auto value = [](const std::optional<double>& each) { return each ? Json(*each) : Json(nullptr); };
  const Comparison comparison = matrix.compare(a, b);
  Json json = {{"a", matrix.materials()[a].material},
               {"b", matrix.materials()[b].material},
               {"verdict", comparison.verdict == Verdict::apart   ? "apart"
                           : comparison.verdict == Verdict::alike ? "alike"
                                                                  : "unknown"}};
  const CueDifference* plainest = comparison.plainest();
  json["noticeable"] = plainest ? value(plainest->noticeable) : Json(0);
  Json& cues = json["cues"] = Json::object();
  for (const CueDifference& cue : comparison.cues) {
    Json& each = cues[facts_of(cue.kind).name] = {
        {"a", value(cue.a)}, {"b", value(cue.b)}, {"noticeable", value(cue.noticeable)}};
    if (!cue.noticeable) each["unknown"] = cue.why_unknown;
    if (cue.threshold) write_threshold(each, *cue.threshold, cue.evidence, cue.outside);
    if (cue.floor) write_floor(each, *cue.floor, cue.least);
  }
  return json;
}

/// A row for each material but the last: its distance from each material after it, null if unknown. The text is written
/// directly: half a million numbers are too many for a tree of JSON.
std::string matrix_json(const ComparisonMatrix& matrix) {
  std::string text = "[";
  const std::size_t count = matrix.materials().size();
  for (std::size_t a = 0; a + 1 < count; ++a) {
    text += a == 0 ? "\n    [" : ",\n    [";
    for (std::size_t b = a + 1; b < count; ++b) {
      const Distance distance = matrix.distance(a, b);
      if (b > a + 1) text += ", ";
      if (distance.verdict == Verdict::unknown || !std::isfinite(distance.noticeable))
        text += "null";
      else
        fmt::format_to(std::back_inserter(text), "{:.4g}", distance.noticeable);
    }
    text += ']';
  }
  return text + (count > 1 ? "\n  ]" : "]");
}

}  // namespace

std::string threshold_words(const Threshold& threshold, Evidence evidence, const std::vector<std::string>& outside) {
  std::string words =
      outside.empty() ? evidence_word(evidence) : fmt::format("extrapolated from {}", fmt::join(outside, ", "));
  if (!threshold.valid) words += ", range not stated";
  if (threshold.task_assumed || threshold.criterion_assumed) words += ", criterion assumed";
  return words;
}

std::string threshold_conditions(const Threshold& threshold) {
  const auto words = [](const Condition& condition) {
    return fmt::format("{}{} {}", condition.assumed ? "assumed " : "", condition.quantity, condition.written);
  };
  std::string text = threshold.valid ? words(*threshold.valid) : "range not stated";
  for (const Condition& condition : threshold.conditions) text += ", " + words(condition);
  if (threshold.task_assumed || threshold.criterion_assumed) text += ", criterion assumed";
  return text;
}

void write_threshold(nlohmann::ordered_json& json, const Threshold& threshold, Evidence evidence,
                     const std::vector<std::string>& outside) {
  using Json = nlohmann::ordered_json;
  json["weber"] = threshold.weber;
  json["evidence"] = outside.empty() ? evidence_word(evidence) : "extrapolated";
  Json assumed = Json::array(), valid = Json::array();
  const auto add = [&](const Condition& condition) {
    valid.push_back(condition.quantity + " " + condition.written);
    if (condition.assumed) assumed.push_back(condition.quantity);
  };
  if (threshold.valid) add(*threshold.valid);
  for (const Condition& condition : threshold.conditions) add(condition);
  if (threshold.task_assumed) assumed.push_back("task");
  if (threshold.criterion_assumed) assumed.push_back("criterion");
  json["valid"] = threshold.valid ? valid : Json(nullptr);
  json["outside"] = outside;
  json["assumed"] = assumed;
  json["source"] = threshold.source;
}

std::string floor_words(const Threshold& floor, double least, const std::string& unit) {
  return readable("by the smallest difference at d' = 1, {:.2g}{}{}, {}: {}", least, unit.empty() ? "" : " ", unit,
                  floor.floor_assumed ? "assumed" : evidence_word(std::max(floor.evidence, floor.handle)), floor.source);
}

void write_floor(nlohmann::ordered_json& json, const Threshold& floor, double least) {
  json["floor"] = {{"least", least},
                   {"evidence", floor.floor_assumed ? "assumed" : evidence_word(std::max(floor.evidence, floor.handle))},
                   {"source", floor.source}};
}

std::string comparison_text(const ComparisonMatrix& matrix, bool with_table) {
  std::string text;
  const std::vector<Cues>& materials = matrix.materials();
  if (materials.size() < 2) return text;
  if (materials.size() == 2) {
    text += fmt::format("{} and {}, on {}\n", materials[0].material, materials[1].material, materials[0].device);
    write_cues(text, matrix, 0, 1);
    return text + shapes_are_not;
  }
  text += readable("{} materials, on {}\n", materials.size(), materials.front().device);
  if (with_table || materials.size() <= most_in_table) write_table(text, matrix);
  if (materials.size() > most_in_table) write_alike(text, matrix);
  for (const ComparedPair& nearest : matrix.nearest(1)) {
    text += fmt::format("\nnearest: {} and {}\n", materials[nearest.a].material, materials[nearest.b].material);
    write_cues(text, matrix, nearest.a, nearest.b);
  }
  return text + shapes_are_not;
}

std::string comparison_json(const ComparisonMatrix& matrix) {
  using Json = nlohmann::ordered_json;
  const std::vector<Cues>& all = matrix.materials();
  Json materials = Json::array(), pairs = Json::array();
  for (const Cues& cues : all) {
    Json& material = materials.emplace_back(Json{{"name", cues.material}});
    if (cues.coarseness > 1) material["coarseness"] = cues.coarseness;
    for (const CueFacts& facts : cue_table())
      if (cues[facts.kind]) material["cues"][facts.name] = {{"value", *cues[facts.kind]}, {"unit", facts.unit}};
  }
  const std::vector<ComparedPair> nearest = matrix.nearest(most_listed);
  if (all.size() <= most_in_table) {
    for (std::size_t a = 0; a < all.size(); ++a)
      for (std::size_t b = a + 1; b < all.size(); ++b) pairs.push_back(pair_json(matrix, a, b));
  } else {
    for (const ComparedPair& pair : nearest) pairs.push_back(pair_json(matrix, pair.a, pair.b));
  }
  const Json near = nearest.empty() ? Json(nullptr) : Json{all[nearest[0].a].material, all[nearest[0].b].material};
  return fmt::format(
      "{{\n  \"device\": {},\n  \"materials\": {},\n  \"pairs\": {},\n  \"nearest\": {},\n  \"matrix\": {}\n}}\n",
      json_text(Json(all.empty() ? "" : all.front().device)), json_text(materials), json_text(pairs), json_text(near),
      matrix_json(matrix));
}

}  // namespace wale
