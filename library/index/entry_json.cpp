#include "library/index/entry_json.hpp"

#include <array>
#include <nlohmann/json.hpp>
#include <stdexcept>

#include "compiler/describe/describe.hpp"

namespace wale {
namespace {

using EntryJson = nlohmann::ordered_json;

EntryJson or_null(const std::optional<double>& value) { return value ? EntryJson(*value) : EntryJson(nullptr); }
EntryJson or_null(const std::optional<Evidence>& value) {
  return value ? EntryJson(evidence_word(*value)) : EntryJson(nullptr);
}

Evidence evidence_in(const EntryJson& json) {
  for (const Evidence each : {Evidence::measured, Evidence::published, Evidence::estimated, Evidence::recalled,
                              Evidence::transferred, Evidence::extrapolated, Evidence::simulated})
    if (json.get<std::string>() == evidence_word(each)) return each;
  throw std::runtime_error("no evidence is called so");
}
template <class Value, class Read>
std::optional<Value> unless_null(const EntryJson& json, const Read& read) {
  return json.is_null() ? std::nullopt : std::optional<Value>(read(json));
}
std::optional<double> number_in(const EntryJson& json) {
  return unless_null<double>(json, [](const EntryJson& each) { return each.get<double>(); });
}

EntryJson percept_json(const EntryPercept& percept) {
  EntryJson json = {{"asked", or_null(percept.asked)},
                    {"asked_evidence", or_null(percept.claimed)},
                    {"reads", or_null(percept.reads)},
                    {"evidence", evidence_word(percept.evidence())},
                    {"low", percept.reads ? EntryJson(percept.means.low) : EntryJson(nullptr)},
                    {"high", percept.reads ? EntryJson(percept.means.high) : EntryJson(nullptr)},
                    {"means_differ_more", percept.means_differ_more},
                    {"individual_low", percept.people ? EntryJson(percept.people->low) : EntryJson(nullptr)},
                    {"individual_high", percept.people ? EntryJson(percept.people->high) : EntryJson(nullptr)},
                    {"lost", percept.lost},
                    {"saturated", percept.saturated},
                    {"carrier", percept.carrier},
                    {"size", percept.size},
                    {"unit", percept.unit}};
  json["evidence_of"] = {{"slope", evidence_word(percept.slope)},
                         {"anchor", evidence_word(percept.anchor)},
                         {"handle", evidence_word(percept.handle)},
                         {"domain", or_null(percept.domain)}};
  json["outside"] = percept.outside;
  json["map"] = percept.map, json["measured_on"] = percept.device, json["source"] = percept.source;
  return json;
}

EntryPercept percept_of_json(const std::string& name, const EntryJson& json) {
  EntryPercept percept;
  percept.name = name;
  percept.asked = number_in(json.at("asked"));
  percept.claimed = unless_null<Evidence>(json.at("asked_evidence"), evidence_in);
  percept.reads = number_in(json.at("reads"));
  percept.means = {number_in(json.at("low")).value_or(0), number_in(json.at("high")).value_or(0)};
  percept.means_differ_more = json.at("means_differ_more").get<bool>();
  if (const auto low = number_in(json.at("individual_low")), high = number_in(json.at("individual_high")); low && high)
    percept.people = LevelBounds{*low, *high};
  percept.lost = json.at("lost").get<bool>(), percept.saturated = json.at("saturated").get<bool>();
  percept.carrier = json.at("carrier"), percept.size = json.at("size").get<double>(), percept.unit = json.at("unit");
  const EntryJson& grades = json.at("evidence_of");
  percept.slope = evidence_in(grades.at("slope")), percept.anchor = evidence_in(grades.at("anchor"));
  percept.handle = evidence_in(grades.at("handle"));
  percept.domain = unless_null<Evidence>(grades.at("domain"), evidence_in);
  percept.outside = json.at("outside").get<std::vector<std::string>>();
  percept.map = json.at("map"), percept.device = json.at("measured_on"), percept.source = json.at("source");
  return percept;
}

EntryJson parameter_json(const Parameter& parameter) {
  return {{"name", parameter.name},         {"unit", parameter.unit},
          {"si_unit", parameter.si_unit},   {"unit_in_si", parameter.unit_in_si},
          {"value", parameter.value},       {"low", parameter.low},
          {"high", parameter.high},         {"soft_low", parameter.soft_low},
          {"soft_high", parameter.soft_high}, {"description", parameter.description}};
}

Parameter parameter_of_json(const EntryJson& json) {
  return {.name = json.at("name"),
          .unit = json.at("unit"),
          .unit_in_si = json.at("unit_in_si").get<double>(),
          .value = json.at("value").get<float>(),
          .low = json.at("low").get<float>(),
          .high = json.at("high").get<float>(),
          .soft_low = json.at("soft_low").get<float>(),
          .soft_high = json.at("soft_high").get<float>(),
          .description = json.at("description"),
          .si_unit = json.at("si_unit")};
}

Entry read_entry(const EntryJson& json) {
  Entry entry{.name = json.at("name"),
              .module = json.at("module"),
              .file = json.at("file"),
              .folder = json.at("folder"),
              .kind = json.at("kind"),
              .title = json.at("title"),
              .documentation = json.at("documentation"),
              .feels = json.at("feels").get<std::vector<std::string>>(),
              .asks = json.at("asks").get<std::vector<std::string>>(),
              .replaces = json.at("replaces").get<std::vector<std::string>>(),
              .sources = json.at("sources").get<std::vector<std::string>>(),
              .licence = json.at("licence"),
              .device = json.at("device"),
              .trouble = json.at("trouble"),
              .content = json.at("content")};
  for (const EntryJson& each : json.at("names")) entry.names.push_back({each.at("language"), each.at("text")});
  for (const auto& [name, percept] : json.at("percepts").items())
    entry.felt.percepts.push_back(percept_of_json(name, percept));
  if (const EntryJson& cues = json.at("cues"); !cues.is_null()) {
    Cues& felt = entry.felt.cues.emplace(Cues{.material = entry.name, .device = entry.device, .values = {}});
    for (const CueFacts& facts : cue_table())
      if (const auto cue = cues.find(facts.name); cue != cues.end()) felt[facts.kind] = cue->at("value").get<double>();
  }
  for (const EntryJson& each : json.at("parameters")) entry.parameters.push_back(parameter_of_json(each));
  return entry;
}

}  // namespace

nlohmann::ordered_json entry_json(const Entry& entry) {
  EntryJson json = {{"name", entry.name},         {"title", entry.title},
                    {"kind", entry.kind},         {"folder", entry.folder},
                    {"module", entry.module},     {"file", entry.file},
                    {"documentation", entry.documentation}};
  EntryJson& names = json["names"] = EntryJson::array();
  for (const EntryName& each : entry.names) names.push_back({{"language", each.language}, {"text", each.text}});
  json["feels"] = entry.feels, json["asks"] = entry.asks, json["replaces"] = entry.replaces;
  json["sources"] = entry.sources, json["licence"] = entry.licence, json["device"] = entry.device;
  EntryJson& percepts = json["percepts"] = EntryJson::object();
  for (const EntryPercept& each : entry.felt.percepts) percepts[each.name] = percept_json(each);
  json["cues"] = nullptr;
  if (entry.felt.cues) {
    EntryJson& cues = json["cues"] = EntryJson::object();
    for (const CueFacts& facts : cue_table())
      if (const auto& value = (*entry.felt.cues)[facts.kind])
        cues[facts.name] = {{"value", *value}, {"unit", facts.unit}};
  }
  EntryJson& parameters = json["parameters"] = EntryJson::array();
  for (const Parameter& each : entry.parameters) parameters.push_back(parameter_json(each));
  json["program_bytes"] = entry.program.size();
  json["trouble"] = entry.trouble, json["content"] = entry.content;
  return json;
}

Result<Entry> entry_of_json(const nlohmann::ordered_json& json) {
  try {
    return read_entry(json);
  } catch (const std::exception& wrong) {  // of the JSON library, and of `evidence_in`
    return Error{.code = Code::damaged_file,
                 .sentence = std::string("an entry of the index cannot be read: ") + wrong.what(),
                 .mend = "make the index again: `wale library index`"};
  }
}

}  // namespace wale
