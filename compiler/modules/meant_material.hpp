#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "compiler/modules/library_index.hpp"
#include "schema/result.hpp"

namespace wale {

// The one rule by which a name means a material of a library, in a file (`like`, `=`, blends, `between`) and on the
// command line. `LibraryIndex::meant_by` goes first: by name; else by title or `called`; else by kind; else by module
// (`fabric.denim`, `sandpaper.chapter4.Viscous`). Of several that remain, those of `imported` modules go before others,
// and those of the person's own files before the shipped ones.

/// Leaves of several materials those that go before the others.
void keep_preferred(std::vector<const IndexedMaterial*>& found, const std::vector<std::string_view>& imported);

/// The material that `text` means to somebody who imports nothing. Errors: W0201 where there is none, with the nearest
/// three in its mend; W0217 where there are several, all listed. The pointer is into `index`.
Result<const IndexedMaterial*> meant_material(const LibraryIndex& index, std::string_view text);

/// The materials whose names, titles or other names are nearest to `text`, at most `most`, the nearest first. None
/// where more than half of the letters would change.
std::vector<const IndexedMaterial*> nearest_materials(const LibraryIndex& index, std::string_view text,
                                                      std::size_t most = 3);

/// "`denim` of `fabric.denim`, `jeans` of `shop.cloth` and 3 more".
std::string listed(const std::vector<const IndexedMaterial*>& materials);

}  // namespace wale
