#include "library/site/page_data.hpp"

#include <nlohmann/json.hpp>

#include "compiler/describe/describe.hpp"
#include "compiler/text/json_text.hpp"

namespace wale {
namespace {

using PageJson = nlohmann::ordered_json;

PageJson begun(const SitePage& page, const char* type) {
  return {{"@context", "https://schema.org"},
          {"@type", type},
          {"@id", "/" + page.path.substr(0, page.path.rfind('.'))},
          {"url", page.path.substr(page.path.rfind('/') + 1)},
          {"name", page.title},
          {"description", page.description}};
}

PageJson measured(const char* name, double value, const char* unit) {
  return {{"@type", "PropertyValue"}, {"name", name}, {"value", value}, {"unitText", unit}};
}

void add_citation(PageJson& data, const std::string& source) {
  if (!source.empty()) data["citation"] = source;
}

}  // namespace

std::string list_data(const SitePage& page, const ListedPages& listed) {
  PageJson data = begun(page, "ItemList");
  data["numberOfItems"] = listed.size(), data["itemListElement"] = PageJson::array();
  for (std::size_t i = 0; i < listed.size(); ++i)
    data["itemListElement"].push_back({{"@type", "ListItem"},
                                       {"position", i + 1},
                                       {"name", listed[i].first},
                                       {"url", way_to(listed[i].second, page.path)}});
  return json_lines(data);
}

std::string percept_data(const SitePage& page, const Percept& percept, const Declarations& declarations,
                         const DeclaredNames& names, const std::vector<const SiteMaterial*>& materials) {
  PageJson data = begun(page, "DefinedTerm");
  PageJson wale = {{"antonym", percept.antonym}, {"words", percept.words}, {"carrier", percept.carrier}};
  wale["level_1"] = percept.has_reference ? PageJson(percept.one) : PageJson(nullptr);
  wale["maps"] = PageJson::array(), wale["materials"] = PageJson::array();
  declarations.each_map([&](const Map& map) {
    if (map.percept == percept.name) wale["maps"].push_back(way_to(names.of(map), page.path));
  });
  for (const SiteMaterial* material : materials)
    for (const SitePercept& each : material->percepts)
      if (each.name == percept.name && each.reads)
        wale["materials"].push_back({{"name", material->name},
                                     {"url", way_to("material/" + material->page + ".html", page.path)},
                                     {"reads", *each.reads}});
  data["wale"] = std::move(wale);
  return json_lines(data);
}

std::string map_data(const SitePage& page, const Map& map, const DeclaredNames& names) {
  PageJson data = begun(page, "Dataset");
  add_citation(data, map.source);
  data["variableMeasured"] = PageJson::array({{{"@type", "PropertyValue"}, {"name", map.percept}}});
  data["wale"] = {{"percept", way_to(names.percept(map.percept), page.path)},
                  {"from", map.from},
                  {"device", map.device},
                  {"slope", evidence_word(map.slope)},
                  {"anchor", map.tied ? PageJson(evidence_word(map.anchor)) : PageJson(nullptr)},
                  {"handle", evidence_word(map.handle)},
                  {"valid", map.validity},
                  {"observers", map.uncertainty.observers},
                  {"scatter", map.uncertainty.scatter},
                  {"quotations", map.quotes}};
  return json_lines(data);
}

std::string threshold_data(const SitePage& page, const Threshold& threshold, const DeclaredNames& names) {
  PageJson data = begun(page, "Dataset");
  add_citation(data, threshold.source);
  data["variableMeasured"] = PageJson::array({{{"@type", "PropertyValue"}, {"name", threshold.cue}}});
  data["wale"] = {{"cue", threshold.cue},
                  {"device", way_to(names.device(threshold.device), page.path)},
                  {"evidence", evidence_word(threshold.evidence)},
                  {"handle", evidence_word(threshold.handle)},
                  {"recognised", threshold.recognised},
                  {"published", threshold.published},
                  {"weber", threshold.weber},
                  {"observers", threshold.observers},
                  {"quotations", threshold.quotes}};
  return json_lines(data);
}

std::string device_data(const SitePage& page, const DeviceDeclaration& device) {
  const DeviceProfile& profile = device.profile;
  PageJson data = begun(page, "Dataset");
  add_citation(data, device.source);
  data["variableMeasured"] = PageJson::array({measured("rate", profile.rate, "Hz")});
  if (!profile.shaker)
    for (const auto& each : {measured("force", profile.force_newton, "N"),
                             measured("workspace", profile.workspace_diameter, "m"), measured("mass", profile.mass, "kg"),
                             measured("damping", profile.damping, "N s/m"), measured("friction", profile.friction, "N")})
      data["variableMeasured"].push_back(each);
  data["wale"] = {{"class", device.of_class}, {"assumed", device.assumed}, {"unknown", device.unknown}};
  return json_lines(data);
}

}  // namespace wale
