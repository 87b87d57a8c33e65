#pragma once

#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "compiler/open_file.hpp"
#include "library/index/library_files.hpp"
#include "library/site/declared_pages.hpp"
#include "library/site/site_folder.hpp"
#include "library/site/site_material.hpp"

namespace wale {

/// A file of a library whose materials get pages.
using SiteInput = LibraryFile;

/// What came of a file.
struct SiteInputRead {
  std::vector<SiteMaterial> materials;
  /// The paths that it rests on, itself first, and the hashes of their bytes.
  std::vector<std::pair<std::string, std::string>> rests_on;
  bool uses_names = false;  ///< other files of the library may change what it means
};

/// Reads the materials of a file and writes what is theirs alone: their pages without neighbours, figures, data and
/// downloads. `page_of` gives each material the name of its page. A file that cannot be read, or in whose text no
/// material can, is one material with a trouble. Errors: those of `SiteFolder::put`, and W0806. Thread-safe.
Result<SiteInputRead> read_site_file(const SiteInput& input, const FileRequest& request, const DeclaredNames& names,
                                     SiteFolder& folder,
                                     const std::function<std::string(const std::string& material)>& page_of);

}  // namespace wale
