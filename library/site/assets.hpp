#pragma once

#include <span>

#include "compiler/text/embedded_files.hpp"

namespace wale {

/// The styles and scripts of the site: "library/site/assets/site.css".
std::span<const EmbeddedFile> embedded_site();

}  // namespace wale
