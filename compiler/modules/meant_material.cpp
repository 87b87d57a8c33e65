#include "compiler/modules/meant_material.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <functional>
#include <limits>
#include <utility>

#include "schema/spelling.hpp"

namespace wale {
namespace {

/// The name of a material that is nearest to a text.
std::optional<NearMaterial> nearest_name(std::string_view text, const IndexedMaterial& material) {
  std::optional<NearMaterial> near;
  const auto hold_against = [&](const std::string& name) {
    const auto distance = distance_from(text, name);
    if (distance && (!near || *distance < near->distance)) near = NearMaterial{&material, name, *distance};
  };
  hold_against(material.name);
  hold_against(material.title);
  for (const std::string& name : material.called) hold_against(name);
  for (const auto& [language, names] : material.called_in)
    for (const std::string& name : names) hold_against(name);
  if (text.find('.') == std::string_view::npos) return near;
  hold_against(material.module);
  hold_against(material.module + "." + material.name);
  return near;
}

/// The module of a material, or its file if another one of the list has that module too.
const std::string& place_of(const IndexedMaterial& material, const std::vector<const IndexedMaterial*>& among) {
  const auto is_other = [&](const IndexedMaterial* each) {
    return each->module == material.module && each->file != material.file;
  };
  return std::ranges::any_of(among, is_other) ? material.file : material.module;
}

}  // namespace

void keep_preferred(std::vector<const IndexedMaterial*>& found, const std::vector<std::string_view>& imported) {
  const auto keep = [&](const auto& preferred) {
    if (std::ranges::any_of(found, preferred)) std::erase_if(found, std::not_fn(preferred));
  };
  keep([&](const IndexedMaterial* each) { return std::ranges::find(imported, each->module) != imported.end(); });
  keep([](const IndexedMaterial* each) { return !each->shipped(); });
  keep([](const IndexedMaterial* each) { return each->origin != Origin::hidden; });
}

Result<const IndexedMaterial*> meant_material(const LibraryIndex& index, std::string_view text) {
  std::vector<const IndexedMaterial*> found = index.meant_by(text);
  keep_preferred(found, {});
  if (found.size() == 1) return found.front();
  if (!found.empty()) {
    Error error{Code::ambiguous_material,
                fmt::format("`{}` may be {} materials: {}", text, found.size(), listed(found)),
                fmt::format("name its place too, as in `{}:{}`", place_of(*found.front(), found), found.front()->name),
                {.name = std::string(text)}};
    for (const IndexedMaterial* each : found) error.nearest.push_back(place_of(*each, found) + ":" + each->name);
    return error;
  }
  const auto near = nearest_materials(index, text);
  return Error{
      Code::unknown_name,
      fmt::format("no material is called `{}`", text),
      near.empty() ? "`wale find WORD` searches the library" : fmt::format("the nearest: {}", listed_near(near)),
      {.name = std::string(text)}};
}

std::vector<NearMaterial> nearest_materials(const LibraryIndex& index, std::string_view text, std::size_t most) {
  std::vector<NearMaterial> near;
  for (const IndexedMaterial& each : index.materials())
    if (auto found = nearest_name(text, each)) near.push_back(*std::move(found));
  std::ranges::stable_sort(near, {}, &NearMaterial::distance);
  if (near.size() > most) near.resize(most);
  return near;
}

std::string listed(const std::vector<const IndexedMaterial*>& materials) {
  constexpr std::size_t most_told = 5;
  std::string all;
  for (std::size_t i = 0; i < std::min(materials.size(), most_told); ++i)
    all += fmt::format("{}`{}` of `{}`", i == 0 ? "" : ", ", materials[i]->name, place_of(*materials[i], materials));
  if (materials.size() > most_told) all += fmt::format(" and {} more", materials.size() - most_told);
  return all;
}

std::string listed_near(const std::vector<NearMaterial>& materials) {
  std::string all;
  for (const NearMaterial& near : materials) {
    const auto& [material, name, distance] = near;
    all += fmt::format("{}`{}` of `{}`", all.empty() ? "" : ", ", material->name, material->module);
    if (name.empty()) continue;  // as the title of a material that has none
    if (name == material->title || std::ranges::find(material->called, name) != material->called.end())
      all += fmt::format(" (\"{}\")", name);
  }
  return all;
}

}  // namespace wale
