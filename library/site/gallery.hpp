#pragma once

#include <string>
#include <vector>

#include "library/site/figures.hpp"
#include "library/site/frame.hpp"
#include "library/site/site_material.hpp"

namespace wale {

/// The first page with its search, the lists of all materials and of each kind, a page long each, and the page of the
/// collections. `materials` are those with pages, in the order of the lists.
std::vector<SitePage> gallery_pages(const std::vector<const SiteMaterial*>& materials);

/// What the search in the browser reads: `data/search.js`, the words, the levels and the cards, each in pieces that are
/// loaded when they are needed.
std::vector<SiteFile> search_files(const std::vector<const SiteMaterial*>& materials);

}  // namespace wale
