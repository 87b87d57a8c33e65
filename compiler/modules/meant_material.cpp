#include "compiler/modules/meant_material.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <functional>
#include <limits>
#include <utility>

#include "schema/spelling.hpp"

namespace wale {
namespace {

/// The edit distance between a text and the nearest of a material's names, in letters.
std::size_t distance(std::string_view text, const IndexedMaterial& material) {
  std::size_t least = letters_changed(text, material.name);
  const auto hold_against = [&](std::string_view name) {
    if (!name.empty()) least = std::min(least, letters_changed(text, name));
  };
  hold_against(material.title);
  for (const std::string& name : material.called) hold_against(name);
  return least;
}

}  // namespace

void keep_preferred(std::vector<const IndexedMaterial*>& found, const std::vector<std::string_view>& imported) {
  const auto keep = [&](const auto& preferred) {
    if (std::ranges::any_of(found, preferred)) std::erase_if(found, std::not_fn(preferred));
  };
  keep([&](const IndexedMaterial* each) { return std::ranges::find(imported, each->module) != imported.end(); });
  keep([](const IndexedMaterial* each) { return !each->shipped; });
}

Result<const IndexedMaterial*> meant_material(const LibraryIndex& index, std::string_view text) {
  std::vector<const IndexedMaterial*> found = index.meant_by(text);
  keep_preferred(found, {});
  if (found.size() == 1) return found.front();
  if (!found.empty())
    return Error{Code::ambiguous_material,
                 fmt::format("`{}` may be {} materials: {}", text, found.size(), listed(found)),
                 fmt::format("name the file too, as in `{}:{}`", found.front()->file, found.front()->name),
                 {.name = std::string(text)}};
  const auto near = nearest_materials(index, text);
  return Error{Code::unknown_name,
               fmt::format("no material is called `{}`", text),
               near.empty() ? "`wale find WORD` searches the library" : fmt::format("the nearest: {}", listed(near)),
               {.name = std::string(text)}};
}

std::vector<const IndexedMaterial*> nearest_materials(const LibraryIndex& index, std::string_view text,
                                                      std::size_t most) {
  constexpr std::size_t longest_compared = 64;
  if (text.size() > longest_compared) return {};
  std::vector<std::pair<std::size_t, const IndexedMaterial*>> near;
  const std::size_t limit = std::max<std::size_t>(1, text.size() / 2);
  for (const IndexedMaterial& each : index.materials())
    if (const std::size_t changed = distance(text, each); changed <= limit) near.emplace_back(changed, &each);
  std::ranges::stable_sort(near, {}, [](const auto& each) { return each.first; });
  std::vector<const IndexedMaterial*> nearest;
  for (const auto& [changed, material] : near)
    if (nearest.size() < most) nearest.push_back(material);
  return nearest;
}

std::string listed(const std::vector<const IndexedMaterial*>& materials) {
  constexpr std::size_t most_told = 5;
  std::string all;
  for (std::size_t i = 0; i < std::min(materials.size(), most_told); ++i)
    all += fmt::format("{}`{}` of `{}`", i == 0 ? "" : ", ", materials[i]->name, materials[i]->module);
  if (materials.size() > most_told) all += fmt::format(" and {} more", materials.size() - most_told);
  return all;
}

}  // namespace wale
