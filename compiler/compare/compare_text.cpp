#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <numbers>

#include "compiler/compare/compare.hpp"
#include "compiler/describe/describe.hpp"

namespace wale {
namespace {

constexpr std::size_t most_in_table = 16;  // materials whose table fits a screen
constexpr const char* shapes_are_not = "  (where features lie and what shape they have is not compared)\n";
constexpr std::size_t most_listed = 20;  // pairs

const CueFacts& facts_of(CueKind kind) { return cue_table()[static_cast<std::size_t>(kind)]; }

/// "2.5 mm", "1.93 N", "45 degrees", "none": with the digits that such figures deserve.
std::string cue_text(CueKind kind, const std::optional<double>& value) {
  if (!value) return "none";
  if (kind == CueKind::period || kind == CueKind::bump_period) return fmt::format("{:.3g} mm", 1e3 * *value);
  // 180 degrees are none: a texture has no front.
  if (kind == CueKind::orientation)
    return fmt::format("{} degrees", std::lround(*value * 180 / std::numbers::pi) % 180);
  const CueFacts& facts = facts_of(kind);
  return fmt::format("{:.3g}{}{}", *value, *facts.unit ? " " : "", facts.unit);
}

std::string noticeable_text(const std::optional<double>& noticeable) {
  if (!noticeable) return "unknown";
  if (*noticeable > 20) return "> 20";
  return fmt::format("{:.1f}", *noticeable);
}

std::string verdict_text(const Comparison& comparison) {
  const CueDifference* plainest = comparison.plainest();
  switch (comparison.verdict) {
    case Verdict::apart: return fmt::format("told apart, most plainly by their {}", facts_of(plainest->kind).name);
    case Verdict::alike: return "hardly told apart: every cue differs by less than is noticed";
    case Verdict::unknown: break;
  }
  std::string cues;
  for (const CueDifference& cue : comparison.cues)
    if (!cue.noticeable) cues += (cues.empty() ? "" : ", ") + std::string(facts_of(cue.kind).name);
  return "unknown: they differ in " + cues + ", for which no threshold is known, and in nothing else that is noticed";
}

/// How far apart two are, in a cell of a table.
std::string cell_text(const Comparison& comparison) {
  if (comparison.verdict == Verdict::unknown) return "?";
  const CueDifference* plainest = comparison.plainest();
  return plainest ? noticeable_text(plainest->noticeable) : "0.0";
}

void write_cues(std::string& text, const ComparisonMatrix& matrix, const ComparedPair& pair) {
  const std::string &a = matrix.materials[pair.a].material, &b = matrix.materials[pair.b].material;
  const std::size_t width = std::max({a.size(), b.size(), std::size_t{14}});
  text += fmt::format("  {:<20} {:<{}}  {:<{}}  noticeable differences\n", "", a, width, b, width);
  for (const CueDifference& cue : pair.comparison.cues) {
    text += fmt::format("  {:<20} {:<{}}  {:<{}}  {}", facts_of(cue.kind).name, cue_text(cue.kind, cue.a), width,
                        cue_text(cue.kind, cue.b), width, noticeable_text(cue.noticeable));
    if (cue.threshold)
      text += fmt::format("  ({:.2g} at d' = 1, {}: {})", cue.threshold->weber, evidence_word(cue.evidence),
                          cue.threshold->source);
    text += '\n';
  }
  text += fmt::format("  {}\n", verdict_text(pair.comparison));
}

void write_table(std::string& text, const ComparisonMatrix& matrix) {
  std::size_t width = 8;
  for (const Cues& cues : matrix.materials) width = std::max(width, cues.material.size());
  const std::size_t count = matrix.materials.size();
  text += fmt::format("  {:<{}}", "", width + 4);
  for (std::size_t i = 0; i < count; ++i) text += fmt::format(" {:>5}", i + 1);
  text += '\n';
  std::size_t next = 0;
  for (std::size_t row = 0; row < count; ++row) {
    text += fmt::format("  {:>3} {:<{}}", row + 1, matrix.materials[row].material, width);
    for (std::size_t column = 0; column <= row; ++column) text += fmt::format(" {:>5}", column == row ? "-" : "");
    for (std::size_t column = row + 1; column < count; ++column)
      text += fmt::format(" {:>5}", cell_text(matrix.pairs[next++].comparison));
    text += '\n';
  }
  text +=
      "  in just noticeable differences of the cue by which two are told apart most plainly; ?: no threshold known\n";
}

/// Of many: those that are not told apart, since a table of all pairs is for machines to read.
void write_alike(std::string& text, const ComparisonMatrix& matrix) {
  std::size_t alike = 0, unknown = 0;
  std::string pairs;
  for (const ComparedPair& pair : matrix.pairs) {
    unknown += pair.comparison.verdict == Verdict::unknown;
    if (pair.comparison.verdict != Verdict::alike) continue;
    if (++alike <= most_listed)
      pairs += fmt::format("  {} and {}\n", matrix.materials[pair.a].material, matrix.materials[pair.b].material);
  }
  text += fmt::format("{} of {} pairs are hardly told apart{}\n{}", alike, matrix.pairs.size(), alike > 0 ? ":" : "",
                      pairs);
  if (alike > most_listed) text += fmt::format("  and {} more; --json has all\n", alike - most_listed);
  if (unknown > 0) text += fmt::format("of {} it is unknown: they differ in what no threshold is known for\n", unknown);
}

}  // namespace

std::string comparison_text(const ComparisonMatrix& matrix) {
  std::string text;
  if (matrix.materials.size() < 2) return text;
  if (matrix.materials.size() == 2) {
    text += fmt::format("{} and {}, on {}\n", matrix.materials[0].material, matrix.materials[1].material,
                        matrix.materials[0].device);
    write_cues(text, matrix, matrix.pairs.front());
    return text + shapes_are_not;
  }
  text += fmt::format("{} materials, on {}\n", matrix.materials.size(), matrix.materials.front().device);
  if (matrix.materials.size() <= most_in_table)
    write_table(text, matrix);
  else
    write_alike(text, matrix);
  if (const ComparedPair* nearest = matrix.nearest()) {
    text += fmt::format("\nnearest: {} and {}\n", matrix.materials[nearest->a].material,
                        matrix.materials[nearest->b].material);
    write_cues(text, matrix, *nearest);
  }
  return text + shapes_are_not;
}

std::string comparison_json(const ComparisonMatrix& matrix) {
  using Json = nlohmann::ordered_json;
  const auto value = [](const std::optional<double>& each) { return each ? Json(*each) : Json(nullptr); };
  Json json = {{"device", matrix.materials.empty() ? "" : matrix.materials.front().device}};
  Json& materials = json["materials"] = Json::array();
  for (const Cues& cues : matrix.materials) {
    Json& material = materials.emplace_back(Json{{"name", cues.material}});
    for (const CueFacts& facts : cue_table())
      if (cues[facts.kind]) material["cues"][facts.name] = {{"value", *cues[facts.kind]}, {"unit", facts.unit}};
  }
  Json& pairs = json["pairs"] = Json::array();
  for (const ComparedPair& pair : matrix.pairs) {
    const Verdict verdict = pair.comparison.verdict;
    Json& told = pairs.emplace_back(Json{{"a", matrix.materials[pair.a].material},
                                         {"b", matrix.materials[pair.b].material},
                                         {"verdict", verdict == Verdict::apart   ? "apart"
                                                     : verdict == Verdict::alike ? "alike"
                                                                                 : "unknown"}});
    const CueDifference* plainest = pair.comparison.plainest();
    told["noticeable"] = plainest ? value(plainest->noticeable) : Json(0);
    Json& cues = told["cues"] = Json::object();
    for (const CueDifference& cue : pair.comparison.cues) {
      Json& each = cues[facts_of(cue.kind).name] = {
          {"a", value(cue.a)}, {"b", value(cue.b)}, {"noticeable", value(cue.noticeable)}};
      if (!cue.threshold) continue;
      each["weber"] = cue.threshold->weber;
      each["evidence"] = evidence_word(cue.evidence);
      each["source"] = cue.threshold->source;
    }
  }
  const ComparedPair* nearest = matrix.nearest();
  json["nearest"] =
      nearest ? Json{matrix.materials[nearest->a].material, matrix.materials[nearest->b].material} : Json(nullptr);
  return json.dump(2) + '\n';
}

}  // namespace wale
