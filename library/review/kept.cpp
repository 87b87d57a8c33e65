#include "library/review/kept.hpp"

#include <algorithm>
#include <nlohmann/json.hpp>
#include <set>

#include "compiler/text/resolver.hpp"
#include "library/index/content_hash.hpp"
#include "schema/regular_file.hpp"

namespace wale {
namespace {

using Json = nlohmann::json;

constexpr const char* marker = "wale review";
constexpr std::size_t largest_kept = std::size_t{256} << 20;  // bytes: two million materials' cues

Json json_of(const MaterialFacts& facts) {
  Json json = {{"name", facts.name},       {"compiled", facts.compiled}, {"standing", facts.standing},
               {"given", facts.given},     {"damping", facts.damping},   {"newton", facts.newton}};
  if (facts.cues) {
    Json& cues = json["cues"] = {{"device", facts.cues->device}, {"coarseness", facts.cues->coarseness},
                                 {"executed", facts.cues->executed}};
    for (const CueFacts& each : cue_table())
      if (const auto& value = (*facts.cues)[each.kind]) cues["values"][each.name] = *value;
  }
  Json& levels = json["levels"] = Json::array();
  for (const ReviewedLevel& each : facts.levels)
    levels.push_back({{"percept", each.percept},
                      {"level", each.level},
                      {"evidence", each.evidence},
                      {"reads", each.reads ? Json(*each.reads) : Json(nullptr)}});
  return json;
}

MaterialFacts facts_in(const Json& json) {
  MaterialFacts facts;
  facts.name = json.at("name"), facts.compiled = json.at("compiled");
  facts.standing = json.at("standing"), facts.given = json.at("given");
  facts.damping = json.at("damping"), facts.newton = json.at("newton");
  if (json.contains("cues")) {
    const Json& told = json.at("cues");
    Cues& cues = facts.cues.emplace();
    cues.material = facts.name, cues.device = told.at("device"), cues.coarseness = told.at("coarseness");
    cues.executed = told.at("executed");
    if (told.contains("values"))
      for (const CueFacts& each : cue_table())
        if (const auto found = told.at("values").find(each.name); found != told.at("values").end())
          cues[each.kind] = found->get<double>();
  }
  for (const Json& each : json.at("levels")) {
    ReviewedLevel& level = facts.levels.emplace_back(
        ReviewedLevel{each.at("percept"), each.at("level"), each.at("evidence"), std::nullopt});
    if (!each.at("reads").is_null()) level.reads = each.at("reads").get<double>();
  }
  return facts;
}

Json json_of(const std::map<std::string, KeptReview::File>& files) {
  Json all = Json::object();
  for (const auto& [path, file] : files) {
    Json materials = Json::array();
    for (const MaterialFacts& each : file.facts.materials) materials.push_back(json_of(each));
    all[path] = {{"hash", file.hash}, {"looked_for", file.facts.looked_for}, {"materials", std::move(materials)}};
  }
  return all;
}

std::map<std::string, KeptReview::File> files_in(const Json& json) {
  std::map<std::string, KeptReview::File> files;
  for (const auto& [path, told] : json.items()) {
    KeptReview::File& file = files[path];
    file.hash = told.at("hash");
    file.facts.looked_for = told.at("looked_for").get<std::vector<std::string>>();
    for (const Json& each : told.at("materials")) file.facts.materials.push_back(facts_in(each));
  }
  return files;
}

}  // namespace

std::string hash_of(const std::string& path, const FileFacts& facts) {
  ContentHash hash;
  hash.take(compiler_build()).take(path);
  std::set<std::string> paths(facts.looked_for.begin(), facts.looked_for.end());
  paths.insert(path);
  for (const std::string& each : paths) {
    const auto found = read_regular_file(each, largest_asset);
    hash.take(each).take(found ? "found" : "missing");
    if (found) hash.take(*found);
  }
  return hash.digits();
}

const FileFacts* KeptReview::unchanged(const std::map<std::string, File>& among, const std::string& path) {
  const auto found = among.find(path);
  if (found == among.end() || hash_of(path, found->second.facts) != found->second.hash) return nullptr;
  return &found->second.facts;
}

Result<KeptReview> read_kept(const std::string& path) {
  auto text = read_regular_file(path, largest_kept);
  if (!text) {
    text.error().place.name = path;
    return text.error();
  }
  const Error damaged{.code = Code::damaged_file,
                      .sentence = "this is not what an earlier `wale library check --since` has written",
                      .mend = "name another file, or delete this one",
                      .place = {.name = path}};
  try {
    const Json json = Json::parse(*text);
    if (!json.is_object() || !json.contains(marker)) return damaged;
    KeptReview kept;
    if (json.at(marker) != 1 || json.at("build") != compiler_build()) return kept;
    kept.reviewed = files_in(json.at("reviewed")), kept.neighbours = files_in(json.at("neighbours"));
    return kept;
  } catch (const Json::exception&) {
    return damaged;
  }
}

std::string kept_text(const KeptReview& kept) {
  const Json json = {{marker, 1},
                     {"build", compiler_build()},
                     {"reviewed", json_of(kept.reviewed)},
                     {"neighbours", json_of(kept.neighbours)}};
  return json.dump(1, ' ', false, Json::error_handler_t::replace) + "\n";
}

}  // namespace wale
