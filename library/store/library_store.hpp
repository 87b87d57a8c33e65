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
  std::size_t files = 0;      ///< that were named
  std::size_t read = 0;       ///< materials that were compiled and read anew
  std::size_t gone = 0;       ///< materials that were forgotten
  std::size_t only_there = 0;  ///< materials of a shared index whose files are gone here; `Shelf::forgets` forgets them

  /// A material, its file, and why it is told of.
  struct Troubled {
    std::string material, file, why;
  };
  std::vector<Troubled> troubled;   ///< those of the index that cannot be felt
  std::vector<Troubled> kept_back;  ///< those that a shared index does not take, since nobody may pass them on
};

/// Told while files are read: how many of how many; returns whether to go on. Called from several threads, one at a time.
using StoreProgress = std::function<bool(std::size_t done, std::size_t all)>;

/// What a shared index is told of the files that it is given. One in a file holds what it is given and nothing else.
struct Shelf {
  std::string name;       ///< under which files on disk stand there; empty: the name of the folder with `wale.project`
  bool is_whole = false;  ///< the files are all of their libraries, so that others of the same shelves are gone here
  bool forgets = false;   ///< if so, their materials are forgotten
};

/// An index of a library. In a file of SQLite, the columns of what is felt lie beside it, in a file of the same name with
/// `.felt` behind it; of a shared index, in a database of PostgreSQL, each reader keeps them in a folder of its own. Both
/// can be made again. A process that is killed leaves an index that the next one brings up to date. Safe from one thread
/// at a time; several processes may read, and of a shared index several write.
class LibraryStore {
 public:
  virtual ~LibraryStore() = default;

  /// Opens the index in a file, or at the address of a database, "postgresql://user@host/database". Makes it if `makes`,
  /// and brings the tables of an older shared one to this Wale's version. `cache` is a folder for the columns of shared
  /// indexes; without one they are fetched each time. Errors: W0501, W0505 and W0506; W0507 for one of a newer Wale; W0806
  /// in a Wale that was built without that database.
  static Result<std::unique_ptr<LibraryStore>> open(const std::string& where, bool makes, const std::string& cache = {});

  /// Brings it up to date with these files for `request.device`: reads those that are new, or of which anything that
  /// they rest on has changed, on all cores. An index in a file forgets all others; a shared one has also what others gave
  /// it, and of one file the old or the new materials, never a part. Errors: W0706 if `tell` ends it, and what was read is
  /// kept; W0505 and those of the database; of a shared index also W0910 for a file outside any
  /// library, and W0607 for another device than the index has.
  virtual Result<StoreReport> bring_up_to_date(const std::vector<LibraryFile>& files, const FileRequest& request,
                                               const StoreProgress& tell = {}, const Shelf& shelf = {}) = 0;
  /// Copies it as it stands into a new file. Errors: W0505, also of an index that is no file.
  virtual Result<> copy_to(const std::string& path) const {
    return Error{.code = Code::unwritable_file, .sentence = "a shared index is not copied", .place = {.name = path}};
  }
  /// Whether it was brought up to date by this build of Wale. Maps and levels of another one may be others.
  virtual bool is_of_this_wale() const = 0;
  /// What it holds, as it was when it was opened or brought up to date.
  virtual const MaterialIndex& index() const = 0;
};

/// Whether a text is the address of a database that may hold a shared index, and no file.
bool is_shared_address(std::string_view text);

/// The address as it may be shown: `***` stands for its password.
std::string without_password(std::string_view address);

/// The entries of files, without a store: each is compiled and read. A file that cannot be read is one entry with its
/// trouble. Uses all cores. Error: W0706 if `tell` ends it.
Result<std::vector<Entry>> read_library(const std::vector<LibraryFile>& files, const FileRequest& request,
                                const StoreProgress& tell = {});

}  // namespace wale
