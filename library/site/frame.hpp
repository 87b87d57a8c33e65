#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "library/site/html.hpp"

namespace wale {

/// A page of the site, without what all of them share.
struct SitePage {
  std::string path;                  ///< "material/corduroy.html"
  std::string title;                 ///< "Wide-wale corduroy"
  std::string description;           ///< a line for search engines
  std::string section;               ///< path of the entry of the menu that it belongs to, "index.html"
  Markup body;                       ///< what stands in `main`
  Markup head;                       ///< more for `head`, such as its data
  std::vector<std::string> scripts;  ///< paths in the site
  std::string data;                  ///< the same for programs, JSON by the terms of schema.org; empty if there is none
};

/// Where the data of a page stand: "percept/roughness.json".
std::string data_path(const SitePage& page);

/// The whole page: with a policy by which a browser loads nothing from elsewhere and runs no script in the text; with
/// the menu, a link past it, and the foot.
std::string framed(const SitePage& page);

/// The way from a page to another file of the site: "../percept/roughness.html".
std::string way_to(std::string_view path, std::string_view from);

/// Wale text with its words coloured.
Markup highlighted(std::string_view text);

/// The text of a `///` comment in paragraphs.
Markup paragraphs(std::string_view documentation);

}  // namespace wale
