#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "compiler/diagnostics/render.hpp"
#include "compiler/text/readable.hpp"
#include "library/review/review.hpp"
#include "schema/visible_text.hpp"

namespace wale {
namespace {

std::string counted(std::size_t n, const char* what) { return fmt::format("{} {}{}", n, what, n == 1 ? "" : "s"); }

/// "roughness 0.35 estimated, stickiness 0.20"
std::string levels_of(const ReviewedMaterial& material) {
  std::string text;
  for (const ReviewedLevel& each : material.levels)
    text += readable("{}{} {:.2f}{}", text.empty() ? "" : ", ", each.percept, each.level,
                     each.evidence.empty() ? "" : " " + each.evidence);
  return text.empty() ? "no levels" : text;
}

std::string nearest_of(const ReviewedMaterial& material) {
  if (material.nearest.empty()) return "none of its kind to compare with";
  return readable("nearest {}, {:.1f} differences apart", material.nearest, material.apart);
}

}  // namespace

std::string review_text(const Review& review) {
  std::size_t name = 0, kind = 0, levels = 0;
  for (const ReviewedFile& file : review.files)
    for (const ReviewedMaterial& each : file.materials) {
      name = std::max(name, each.name.size()), kind = std::max(kind, each.kind.size());
      levels = std::max(levels, levels_of(each).size());
    }
  std::string text;
  for (const ReviewedFile& file : review.files)
    for (const ReviewedMaterial& each : file.materials)
      text += fmt::format("{:{}}  {:{}}  {:{}}  {}\n", each.name, name, each.kind, kind, levels_of(each), levels,
                          nearest_of(each));
  return text + fmt::format("{} in {}: {}, {}; {}\n", counted(review.materials, "material"),
                            counted(review.files.size(), "file"), counted(review.errors, "error"),
                            counted(review.warnings, "warning"),
                            review.accepted() ? "a library can take them in" : "not accepted");
}

std::string review_json(const Review& review) {
  using Json = nlohmann::ordered_json;
  Json json;
  json["accepted"] = review.accepted();
  json["errors"] = review.errors, json["warnings"] = review.warnings;
  Json& materials = json["materials"] = Json::array();
  Json& diagnostics = json["diagnostics"] = Json::array();
  for (const ReviewedFile& file : review.files) {
    for (const ReviewedMaterial& each : file.materials) {
      Json levels = Json::object();
      for (const ReviewedLevel& level : each.levels)
        levels[level.percept] = {{"asked", level.level},
                                 {"asked_evidence", level.evidence.empty() ? Json(nullptr) : Json(level.evidence)}};
      materials.push_back({{"name", each.name},
                           {"title", each.title},
                           {"kind", each.kind},
                           {"file", file.file},
                           {"licence", each.licence},
                           {"percepts", std::move(levels)},
                           {"nearest", each.nearest.empty() ? Json(nullptr) : Json(each.nearest)},
                           {"differences", std::isfinite(each.apart) ? Json(each.apart) : Json(nullptr)}});
    }
    for (Json& each : Json::parse(render_json(file.diagnostics, file.sources))) diagnostics.push_back(std::move(each));
  }
  return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

}  // namespace wale
