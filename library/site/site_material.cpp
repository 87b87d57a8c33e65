#include "library/site/site_material.hpp"

#include <cmath>
#include <nlohmann/json.hpp>

namespace wale {
namespace {

using Json = nlohmann::ordered_json;

Json optional_number(const std::optional<double>& value) {
  return value && std::isfinite(*value) ? Json(*value) : Json();
}

std::optional<double> number_or_none(const Json& json) {
  return json.is_null() ? std::nullopt : std::optional(json.get<double>());
}

}  // namespace

Json to_json(const SiteMaterial& material) {
  Json json = {{"page", material.page},       {"name", material.name},
               {"module", material.module},   {"file", material.file},
               {"folder", material.folder},   {"kind", material.kind},
               {"title", material.title},     {"documentation", material.documentation},
               {"licence", material.licence}, {"feels", material.feels},
               {"asks", material.asks},       {"replaces", material.replaces},
               {"sources", material.sources}, {"content", material.content},
               {"trouble", material.trouble}, {"unlicensed", material.unlicensed},
               {"width", material.width},     {"height", material.height},
               {"side", material.side},       {"of_velocity", material.of_velocity},
               {"newton", material.newton},   {"small", material.small},
               {"unknown", material.unknown}, {"files", material.files}};
  json["names"] = Json::array();
  for (const EntryName& each : material.names) json["names"].push_back({each.language, each.text});
  json["percepts"] = Json::array();
  for (const SitePercept& each : material.percepts)
    json["percepts"].push_back({{"name", each.name},
                                {"asked", optional_number(each.asked)},
                                {"reads", optional_number(each.reads)},
                                {"low", each.low},
                                {"high", each.high},
                                {"evidence", each.evidence}});
  if (!material.cues) return json;
  json["device"] = material.cues->device;
  json["coarseness"] = material.cues->coarseness;
  json["cues"] = Json::object();
  for (const CueFacts& facts : cue_table())
    if (const auto& value = (*material.cues)[facts.kind]) json["cues"][facts.name] = optional_number(value);
  return json;
}

SiteMaterial site_material_of(const Json& json) {
  SiteMaterial material;
  const auto take = [&](const char* key, auto& into) { json.at(key).get_to(into); };
  take("page", material.page), take("name", material.name), take("module", material.module);
  take("file", material.file), take("folder", material.folder), take("kind", material.kind);
  take("title", material.title), take("documentation", material.documentation), take("licence", material.licence);
  take("feels", material.feels), take("asks", material.asks), take("replaces", material.replaces);
  take("sources", material.sources), take("content", material.content), take("trouble", material.trouble);
  take("unlicensed", material.unlicensed), take("width", material.width), take("height", material.height);
  take("side", material.side), take("of_velocity", material.of_velocity), take("newton", material.newton);
  take("small", material.small), take("unknown", material.unknown), take("files", material.files);
  for (const Json& each : json.at("names"))
    material.names.push_back({each.at(0).get<std::string>(), each.at(1).get<std::string>()});
  for (const Json& each : json.at("percepts"))
    material.percepts.push_back({each.at("name").get<std::string>(), number_or_none(each.at("asked")),
                                 number_or_none(each.at("reads")), each.at("low").get<double>(),
                                 each.at("high").get<double>(), each.at("evidence").get<std::string>()});
  if (!json.contains("cues")) return material;
  Cues cues{.material = material.name, .device = json.at("device").get<std::string>(), .values = {}};
  json.at("coarseness").get_to(cues.coarseness);
  for (const CueFacts& facts : cue_table())
    if (const auto found = json.at("cues").find(facts.name); found != json.at("cues").end())
      cues[facts.kind] = number_or_none(*found);
  material.cues = std::move(cues);
  return material;
}

}  // namespace wale
