#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "compiler/modules/library_index.hpp"
#include "wale/result.hpp"

namespace wale {

// The rule by which a name means a material of a library, in a file (`like`, `=`, blends, `between`) and on the command
// line. First, `LibraryIndex::meant_by` finds candidates: by name; else by title or `called`; else by kind; else by
// module (`fabric.denim`, `sandpaper.chapter4.Viscous`). Of several candidates, those of `imported` modules take
// precedence over others, and those of the user's own files over the shipped ones, and
// files that an import can find over files that another one of the same module name hides.

/// Keeps only the materials that take precedence over the others.
void keep_preferred(std::vector<const IndexedMaterial*>& found, const std::vector<std::string_view>& imported);

/// The material that `text` means without any imports. Errors: W0201 if there is none, with up to three near ones in
/// its mend; W0217 if there are several, with a list of them, and as nearest names those that each has alone. The result points into `index`.
Result<const IndexedMaterial*> meant_material(const LibraryIndex& index, std::string_view text);

/// A material that has a name near to a text.
struct NearMaterial {
  const IndexedMaterial* material = nullptr;
  std::string name;          ///< the near one: its name, title or `called` text, or its name with its module
  std::size_t distance = 0;  ///< `distance_from` the text
};

/// The materials whose names are nearest to `text`: at most `most`, the nearest first. Those with their modules are
/// compared if `text` has a dot. Names that are not near are left out.
std::vector<NearMaterial> nearest_materials(const LibraryIndex& index, std::string_view text, std::size_t most = 3);

/// "`denim` of `fabric.denim`, `jeans` of `shop.cloth` and 3 more".
std::string listed(const std::vector<const IndexedMaterial*>& materials);
/// "`denim` of `fabric.denim`, `corduroy` of `fabric.corduroy` ("ribbed cotton")".
std::string listed_near(const std::vector<NearMaterial>& materials);

}  // namespace wale
