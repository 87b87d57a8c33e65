#pragma once

#include <cstddef>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "compiler/open_file.hpp"
#include "library/index/library_files.hpp"
#include "library/index/material_index.hpp"
#include "wale/result.hpp"

namespace wale {

/// What bringing an index up to date did.
struct StoreReport {
  std::size_t materials = 0;  ///< of the index, now
  std::size_t files = 0;      ///< that it rests on
  std::size_t read = 0;       ///< materials that were compiled and read anew
  std::size_t gone = 0;       ///< materials that are no more

  /// A material that cannot be felt, and why.
  struct Troubled {
    std::string material, file, why;
  };
  std::vector<Troubled> troubled;
};

/// Told while files are read: how many of how many. Called from several threads.
using StoreProgress = std::function<void(std::size_t done, std::size_t all)>;

/// An index of a library in a file of SQLite, with the columns of what is felt beside it, in a file of the same name with
/// `.felt` behind it, which can be made again. A process that is killed leaves an index that the next one brings up to
/// date. Safe from one thread at a time; several processes may read, and one of them write.
class LibraryStore {
 public:
  virtual ~LibraryStore() = default;

  /// Opens an index, and makes the file if `makes`. Errors: W0501, W0505 and W0506; W0507 for one of a newer Wale; W0504 in
  /// a Wale that was built without SQLite.
  static Result<std::unique_ptr<LibraryStore>> open(const std::string& path, bool makes);

  /// Makes it an index of these files for `request.device`: reads those that are new, or of which anything that they
  /// rest on has changed, on all cores, and forgets those that are no more. Errors: W0505.
  virtual Result<StoreReport> bring_up_to_date(const std::vector<LibraryFile>& files, const FileRequest& request,
                                               const StoreProgress& tell = {}) = 0;
  /// Whether it was brought up to date by this build of Wale. Maps and levels of another one may be others.
  virtual bool is_of_this_wale() const = 0;
  /// What it holds, until it is brought up to date again.
  virtual const MaterialIndex& index() const = 0;
};

/// The entries of files, without a store: each is compiled and read. A file that cannot be read is one entry with its
/// trouble. Uses all cores.
std::vector<Entry> read_library(const std::vector<LibraryFile>& files, const FileRequest& request,
                                const StoreProgress& tell = {});

}  // namespace wale
