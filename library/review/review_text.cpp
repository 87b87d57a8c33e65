#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <nlohmann/json.hpp>

#include "compiler/diagnostics/render.hpp"
#include "compiler/text/readable.hpp"
#include "library/review/review.hpp"
#include "library/review/words.hpp"
#include "schema/visible_text.hpp"

namespace wale {
namespace {

constexpr std::size_t most_findings = 60;
constexpr std::size_t most_lines = 40;  // materials; a reviewer reads no more in a minute

std::string counted(std::size_t n, const char* what) { return readable("{} {}{}", n, what, n == 1 ? "" : "s"); }

/// "roughness 0.35 estimated, stickiness 0.20 (reads 0.31)"
std::string levels_of(const ReviewedMaterial& material) {
  std::string text;
  for (const ReviewedLevel& each : material.facts.levels) {
    text += readable("{}{} {:.2f}{}", text.empty() ? "" : ", ", each.percept, each.level,
                     each.evidence.empty() ? "" : " " + each.evidence);
    if (each.reads && std::abs(*each.reads - each.level) >= 0.005) text += readable(" (reads {:.2f})", *each.reads);
  }
  return text.empty() ? "no levels" : text;
}

std::string apart_text(double apart) { return apart > 20 ? "more than 20" : readable("{:.1f}", apart); }

std::string nearest_of(const ReviewedMaterial& material) {
  if (!material.facts.compiled) return "compared with none";
  if (material.nearest.empty())
    return "none of its kind to compare with" +
           (material.nearest_kind.empty() ? "" : "; the nearest kind: " + visible_text(material.nearest_kind));
  return readable("nearest {}, {} differences", material.nearest, apart_text(material.apart));
}

std::string force_of(const ReviewedMaterial& material) {
  if (!material.facts.compiled) return "not checked further, since it does not compile";
  if (material.facts.standing.empty()) return "not graded";
  if (material.facts.given > 0)
    return readable("{:.2g} N, {}: gives the hand up to {:.2g} W", material.facts.newton, material.facts.standing,
                    material.facts.given);
  return readable("{:.2g} N, {}", material.facts.newton, material.facts.standing);
}

/// Whether something was found in a file.
bool has_findings(const ReviewedFile& file) { return !file.diagnostics.all().empty(); }

/// What a library misses, a line each with its mend below: a reviewer reads what is missing, and knows the file.
std::string findings_text(const Review& review) {
  std::string text;
  std::size_t shown = 0, left = 0;
  for (const ReviewedFile& file : review.files)
    for (const Diagnostic& each : file.diagnostics.all()) {
      if (!is_of_library(each.code)) continue;
      if (++shown > most_findings) {
        ++left;
        continue;
      }
      const LineColumn place = file.sources.place(each.span);
      text += fmt::format("{}:{}:{}: {}[{}]: {}\n", visible_text(file.file), place.line, place.column,
                          severity_name(severity_of(each.code)), code_name(each.code), visible_text(each.message));
      if (!each.help.empty()) text += fmt::format("  = help: {}\n", visible_text(each.help));
    }
  if (left > 0) text += readable("and {} more; --json has all\n", left);
  return text.empty() ? text : text + "\n";
}

/// A line for each kind: how many materials, and the two of them that are least apart.
std::string kinds_text(const Review& review) {
  struct OfKind {
    std::size_t materials = 0;
    const ReviewedMaterial* closest = nullptr;
  };
  std::map<std::string, OfKind> kinds;
  for (const ReviewedFile& file : review.files)
    for (const ReviewedMaterial& each : file.materials) {
      OfKind& kind = kinds[each.kind.empty() ? "(no kind)" : branch_of(each.kind)];
      ++kind.materials;
      if (!each.nearest.empty() && (!kind.closest || each.apart < kind.closest->apart)) kind.closest = &each;
    }
  std::string text;
  for (const auto& [name, kind] : kinds)
    text += readable("{:<14} {:>5}  {}\n", visible_text(name), kind.materials,
                     kind.closest ? readable("closest: {} and {}, {} differences", kind.closest->name,
                                             kind.closest->nearest, apart_text(kind.closest->apart))
                                  : "nothing to compare");
  return text;
}

}  // namespace

bool is_of_library(Code code) { return code >= Code::incomplete_material; }

std::string review_text(const Review& review) {
  const bool all = review.materials <= most_lines;
  std::vector<const ReviewedMaterial*> shown;
  for (const ReviewedFile& file : review.files)
    if (all || has_findings(file))
      for (const ReviewedMaterial& each : file.materials) shown.push_back(&each);
  std::string text = findings_text(review) + (all ? "" : kinds_text(review));
  const std::size_t lines = std::min(shown.size(), most_lines);
  std::size_t name = 0, kind = 0, levels = 0, force = 0;
  for (std::size_t i = 0; i < lines; ++i) {
    name = std::max(name, shown[i]->name.size()), kind = std::max(kind, shown[i]->kind.size());
    levels = std::max(levels, levels_of(*shown[i]).size()), force = std::max(force, force_of(*shown[i]).size());
  }
  if (!all && lines > 0) text += "\n";
  for (std::size_t i = 0; i < lines; ++i)
    text += fmt::format("{:{}}  {:{}}  {:{}}  {:{}}  {}\n", shown[i]->name, name, shown[i]->kind, kind,
                        levels_of(*shown[i]), levels, force_of(*shown[i]), force, nearest_of(*shown[i]));
  if (shown.size() > lines) text += readable("and {} more with findings; --json has all\n", shown.size() - lines);
  return text + fmt::format("{} in {}{}: {}, {}; {}\n", counted(review.materials, "material"),
                            counted(review.files.size(), "file"),
                            review.unchanged > 0 ? readable(", {} of them unchanged", review.unchanged) : "",
                            counted(review.errors, "error"), counted(review.warnings, "warning"),
                            review.accepted() ? "a library can take them in" : "not accepted");
}

std::string review_json(const Review& review) {
  using Json = nlohmann::ordered_json;
  Json materials = Json::array(), diagnostics = Json::array();
  for (const ReviewedFile& file : review.files) {
    for (const ReviewedMaterial& each : file.materials) {
      Json levels = Json::object();
      for (const ReviewedLevel& level : each.facts.levels)
        levels[level.percept] = {{"asked", level.level},
                                 {"asked_evidence", level.evidence.empty() ? Json(nullptr) : Json(level.evidence)},
                                 {"reads", level.reads ? Json(*level.reads) : Json(nullptr)}};
      materials.push_back({{"name", each.name},
                           {"title", each.title},
                           {"kind", each.kind},
                           {"file", file.file},
                           {"licence", each.licence},
                           {"percepts", std::move(levels)},
                           {"compiled", each.facts.compiled},
                           {"standing", each.facts.standing.empty() ? Json(nullptr) : Json(each.facts.standing)},
                           {"given_watt", each.facts.given},
                           {"required_damping", each.facts.damping},
                           {"largest_newton", each.facts.newton},
                           {"nearest", each.nearest.empty() ? Json(nullptr) : Json(each.nearest)},
                           {"nearest_kind", each.nearest_kind.empty() ? Json(nullptr) : Json(each.nearest_kind)},
                           {"differences", std::isfinite(each.apart) ? Json(each.apart) : Json(nullptr)}});
    }
    Json found = Json::parse(render_json(file.diagnostics, file.sources));
    for (Json& each : found) diagnostics.push_back(std::move(each));
  }
  const Json json = {{"accepted", review.accepted()}, {"errors", review.errors},
                     {"warnings", review.warnings},   {"files", review.files.size()},
                     {"unchanged", review.unchanged}, {"materials", std::move(materials)},
                     {"diagnostics", std::move(diagnostics)}};
  return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

}  // namespace wale
