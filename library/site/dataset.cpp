#include <cmath>
#include <nlohmann/json.hpp>
#include <set>

#include "compiler/describe/describe_figure.hpp"
#include "library/site/material_page.hpp"

namespace wale {
namespace {

using Json = nlohmann::ordered_json;

Json measured_percept(const DescribedPercept& percept) {
  Json value = {{"@type", "PropertyValue"}, {"name", percept.name}};
  if (!percept.unknown && std::isfinite(percept.level)) {
    value["value"] = figure(percept.level);
    value["minValue"] = figure(percept.intervals.means.low), value["maxValue"] = figure(percept.intervals.means.high);
  }
  value["unitText"] = "level: 0 none, 1 the reference stimulus";
  value["measurementTechnique"] = percept.map + ", " + percept.source + ", on " + percept.device;
  std::string how = "evidence: " + evidence_word(percept.evidence());
  if (percept.asked) how = fmt::format("asked: {}; {}", figure(*percept.asked), how);
  value["description"] = how;
  return value;
}

}  // namespace

Json material_dataset(const SiteMaterial& material, const MaterialSources& sources, bool whole) {
  const std::string path = "material/" + material.page + ".html";
  Json data = {{"@context", "https://schema.org"},
               {"@type", "Dataset"},
               {"@id", "/material/" + material.page},
               {"url", material.page + ".html"},
               {"name", material.shown()}};
  Json others = Json::array({material.name});
  std::set<std::pair<std::string, std::string>> said = {{"en", material.shown()}, {"en", material.name}};
  for (const EntryName& each : material.names)
    if (said.emplace(each.language, each.text).second) others.push_back(each.language == "en" ? Json(each.text)
                                           : Json{{"@language", each.language}, {"@value", each.text}});
  data["alternateName"] = std::move(others);
  data["description"] = material.documentation.empty()
                            ? material.shown() + ": how it feels on a force-feedback joystick, read from its program"
                            : material.documentation;
  data["license"] = "https://spdx.org/licenses/" + material.licence;
  if (material.licence.find(' ') != std::string::npos) data["license"] = material.licence;
  if (!material.kind.empty()) data["keywords"] = Json::array({material.kind});
  if (!material.sources.empty()) data["citation"] = material.sources;
  data["identifier"] = material.content;
  Json measured = Json::array();
  for (const DescribedPercept& each : sources.description->percepts) measured.push_back(measured_percept(each));
  const auto length = [](const char* name, double metres) {
    return Json{{"@type", "PropertyValue"}, {"name", name}, {"value", figure(metres * 1e3)}, {"unitCode", "MMT"}};
  };
  measured.push_back(length("width of the patch", material.width));
  measured.push_back(length("length of the patch", material.height));
  if (sources.figures->height) measured.push_back(length("height of the relief", *sources.figures->height));
  if (whole && material.cues)
    for (const CueFacts& facts : cue_table())
      if (const auto& value = (*material.cues)[facts.kind]; value && std::isfinite(*value))
        measured.push_back(
            {{"@type", "PropertyValue"}, {"name", facts.name}, {"value", figure(*value)}, {"unitText", facts.unit}});
  data["variableMeasured"] = std::move(measured);
  Json distribution = Json::array();
  const auto offer = [&](const std::string& to, const char* format) {
    if (!to.empty())
      distribution.push_back({{"@type", "DataDownload"}, {"contentUrl", way_to(to, path)}, {"encodingFormat", format}});
  };
  offer(sources.source, "text/x-wale");
  offer(sources.program_path, "application/x-wale-program");
  offer(sources.header_path, "text/x-c++hdr");
  data["distribution"] = std::move(distribution);
  if (whole) data["wale"] = Json::parse(descriptions_json({*sources.description}));
  return data;
}

}  // namespace wale
