#pragma once

#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "wale/library.hpp"

namespace wale {

/// A material that a person can choose.
struct CatalogueEntry {
  std::string name;
  std::string spelling;  ///< how a text names it: "denim", or with its module where several have that name
  std::string module;    ///< the file that declares it, as an import names it: "fabric.denim"
  std::string title;     ///< may be empty
  std::string kind;      ///< "fabric.woven"; may be empty
  std::vector<std::string> called, feels;  ///< other names; comparisons such as "like ball bearings"
  std::string documentation;               ///< may be empty
  bool shipped = false;                    ///< it comes with Wale; otherwise it is the user's own
  /// Of a shipped material: 64 hexadecimal digits that are the same as long as it compiles to the same, for what is
  /// kept of it from one run to the next, as a thumbnail is. Empty for the user's own, whose imports change at any
  /// time.
  std::string content;
};

/// Materials to choose from. All calls are safe from any thread.
class Catalogue {
 public:
  virtual ~Catalogue() = default;

  /// Error: `unreadable_file` about the first of `LibraryOptions::folders` that is no folder; the materials of the
  /// others are there.
  virtual Result<> folders_exist() const = 0;

  /// The materials that contain every word of `words` at the beginning of one of theirs, as `wale find` gives them; all
  /// if there is no word. `kind` keeps those of that kind and its subkinds; if it is empty, all are kept.
  virtual std::vector<CatalogueEntry> search(std::string_view words, std::string_view kind = {}) const = 0;

  /// All kinds, with their parents, in alphabetic order.
  virtual std::vector<std::string> kinds() const = 0;
};

/// The materials of the library: those of the folders in `options`, of the project in the process's current folder, and
/// the shipped ones. Files that are written later are not in it.
std::unique_ptr<Catalogue> library_catalogue(const LibraryOptions& options = {});

}  // namespace wale
