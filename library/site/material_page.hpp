#pragma once

#include <functional>
#include <map>
#include <string>
#include <vector>

#include "compiler/describe/describe.hpp"
#include "library/index/entry.hpp"
#include "library/site/declared_pages.hpp"
#include "library/site/figures.hpp"
#include "library/site/frame.hpp"
#include "library/site/site_material.hpp"

namespace wale {

/// What a page of a material is made from.
struct MaterialSources {
  const Entry* entry = nullptr;
  const Description* description = nullptr;
  const SiteFigures* figures = nullptr;
  const DeclaredNames* names = nullptr;  ///< the pages that a percept, a map or a device has
  const PatchProgram* program = nullptr;
  std::string text;                       ///< of its declaration, or of its file if that holds nothing else
  std::string source;                     ///< path of the `.wale` file; empty if not all of it may be passed on
  std::string program_path, header_path;  ///< of the downloads; the second is empty without C++
};

/// The page of a material, in which the place of the neighbours is empty.
SitePage material_page(const SiteMaterial& material, const MaterialSources& sources);

/// Its data: a schema.org `Dataset` whose `variableMeasured` are the percepts and the cues, and with `whole`, under
/// `wale`, what `wale describe --json` prints.
nlohmann::ordered_json material_dataset(const SiteMaterial& material, const MaterialSources& sources, bool whole);

/// A neighbour of a material by feel.
struct SiteNeighbour {
  const SiteMaterial* material = nullptr;
  float least = 0, most = 0;         ///< just noticeable differences; `most` is infinite if a cue is not known
  std::vector<std::string> unknown;  ///< the cues without a published threshold in which they differ
};

/// The neighbours as they stand on the page of a material.
Markup neighbours_markup(const std::vector<SiteNeighbour>& neighbours, const std::string& path);

/// The page with these neighbours in their place. `page` is one of `framed(material_page(…))`.
std::string with_neighbours(std::string page, const Markup& neighbours);

/// A level between 0 and its greatest, as a bar: where the means lie, what is asked and what is read.
Markup level_bar(const std::optional<double>& asked, const std::optional<double>& reads, double low, double high);

/// A card of a list.
Markup material_card(const SiteMaterial& material, const std::string& from);

/// "20 mm", "2.5 mm", "1.2 m".
std::string in_millimetres(double metres);

}  // namespace wale
