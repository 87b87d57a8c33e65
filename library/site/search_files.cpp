#include <algorithm>
#include <cmath>
#include <map>
#include <nlohmann/json.hpp>

#include "compiler/text/json_text.hpp"
#include "library/index/words.hpp"
#include "library/site/gallery.hpp"
#include "library/site/material_page.hpp"
#include "schema/visible_text.hpp"

namespace wale {
namespace {

using Json = nlohmann::ordered_json;

constexpr std::size_t cards_in_a_file = 200;
constexpr std::size_t words_in_a_file = 48 << 10;  // bytes

SiteFile data_file(const std::string& name, const Json& data) {
  return {"data/" + name + ".js", "wale.take(\"" + name + "\"," + script_json(json_text(data)) + ");\n"};
}

Entry words_entry(const SiteMaterial& material) {
  Entry entry;
  entry.name = material.name, entry.title = material.title, entry.kind = material.kind;
  entry.documentation = material.documentation, entry.names = material.names, entry.feels = material.feels;
  entry.replaces = material.replaces;
  return entry;
}

}  // namespace

std::vector<SiteFile> search_files(const std::vector<const SiteMaterial*>& materials) {
  std::vector<SiteFile> files;
  std::map<std::string, std::vector<std::pair<std::size_t, std::uint32_t>>> table;
  std::vector<std::uint32_t> lengths;
  std::uint64_t length = 0;
  std::map<std::string, std::pair<std::vector<std::size_t>, std::vector<double>>> levels;
  std::map<std::string, std::size_t> kind_numbers;
  std::vector<std::string> kinds;
  std::vector<std::size_t> kind_of;
  Json cards = Json::array();
  for (std::size_t i = 0; i < materials.size(); ++i) {
    const SiteMaterial& material = *materials[i];
    const WordCounts counted = count_words(words_entry(material));
    for (const auto& [word, weight] : counted.weights) table[word].emplace_back(i, weight);
    lengths.push_back(counted.length), length += counted.length;
    Json card_levels = Json::array();
    for (const SitePercept& each : material.percepts) {
      if (!each.reads) continue;
      const double level = std::round(*each.reads * 1e4) / 1e4;
      levels[each.name].first.push_back(i), levels[each.name].second.push_back(level);
      card_levels.push_back({visible_text(each.name), level});
    }
    const auto [number, is_new] = kind_numbers.try_emplace(material.kind, kinds.size());
    if (is_new) kinds.push_back(material.kind);
    kind_of.push_back(number->second);
    cards.push_back({material.page, visible_text(material.shown()), visible_text(material.kind), material.small,
                     material.of_velocity ? "force over velocity" : in_millimetres(material.side) + " wide",
                     card_levels});
    if (cards.size() == cards_in_a_file || i + 1 == materials.size()) {
      files.push_back(data_file("cards-p" + std::to_string(i / cards_in_a_file), cards));
      cards = Json::array();
    }
  }
  Json columns = {{"lengths", lengths}, {"kinds", kinds}, {"kind", kind_of}, {"levels", Json::object()}};
  for (const auto& [percept, column] : levels) columns["levels"][percept] = {column.first, column.second};
  files.push_back(data_file("levels", columns));

  // The words in their order, a piece of some size in a file; `begins` has the first word of each.
  Json begins = Json::array(), piece = Json::array();
  std::size_t bytes = 0;
  const auto end_piece = [&] {
    if (piece.empty()) return;
    begins.push_back(piece.front().front());
    files.push_back(data_file("words-p" + std::to_string(begins.size() - 1), piece));
    piece = Json::array(), bytes = 0;
  };
  for (const auto& [word, hits] : table) {
    Json numbers = Json::array(), weights = Json::array();
    std::size_t before = 0;
    for (const auto& [material, weight] : hits) {
      numbers.push_back(material - before), weights.push_back(weight);
      before = material;
    }
    bytes += word.size() + 8 * hits.size();
    piece.push_back({word, std::move(numbers), std::move(weights)});
    if (bytes > words_in_a_file) end_piece();
  }
  end_piece();
  files.push_back(data_file(
      "search", {{"materials", materials.size()}, {"length", length}, {"cards", cards_in_a_file}, {"begins", begins}}));
  return files;
}

}  // namespace wale
