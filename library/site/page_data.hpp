#pragma once

#include <string>
#include <utility>
#include <vector>

#include "compiler/declarations/declarations.hpp"
#include "library/site/declared_pages.hpp"
#include "library/site/frame.hpp"

// What stands on a page as JSON, by the terms of schema.org; the figures of Wale are in a member "wale", in SI units.
namespace wale {

/// Names and the paths of their pages: an `ItemList`.
using ListedPages = std::vector<std::pair<std::string, std::string>>;
std::string list_data(const SitePage& page, const ListedPages& listed);

/// A `DefinedTerm`, with its maps and the levels of the materials that have it.
std::string percept_data(const SitePage& page, const Percept& percept, const Declarations& declarations,
                         const DeclaredNames& names, const std::vector<const SiteMaterial*>& materials);
/// A `Dataset` each: where the figures come from, on what evidence.
std::string map_data(const SitePage& page, const Map& map, const DeclaredNames& names);
std::string threshold_data(const SitePage& page, const Threshold& threshold, const DeclaredNames& names);
std::string device_data(const SitePage& page, const DeviceDeclaration& device);

}  // namespace wale
