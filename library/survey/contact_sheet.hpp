#pragma once

#include <memory>
#include <string>
#include <vector>

#include "compiler/declarations/declarations.hpp"
#include "compiler/drawing/canvas.hpp"
#include "library/index/entry.hpp"
#include "wale/result.hpp"

namespace wale {

/// Materials of one kind in rows of a page: "fabric". The kind continues on the next page where it does not fit.
struct SheetKind {
  std::string kind;
  std::vector<const Entry*> entries;  ///< at most as many as fit; in the order of their names
};

/// One page of contact prints.
struct SheetPage {
  std::vector<SheetKind> kinds;
};

/// Materials by kind and name, so many to a page that a person sees each: up to 24. The entries must outlive the pages.
std::vector<SheetPage> sheet_pages(const std::vector<Entry>& entries);

/// Draws one page, 1640 pixels wide: of each material its surface or force and its profile, its name, its title and the
/// size of its patch in mm; of one that cannot be built, why. The text of materials cannot leave its place. The same
/// entries give the same pixels. Error: `missing_library`.
Result<std::unique_ptr<Canvas>> draw_sheet(const SheetPage& page, const std::string& title,
                                           const Declarations& declarations);

/// The name of page `number` (from 1) of `count`: "sheet.png" alone, otherwise "sheet_01.png".
std::string page_name(const std::string& file, std::size_t number, std::size_t count);

}  // namespace wale
