#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "library/store/library_store.hpp"

namespace wale {

/// The folder of indexes in the user's cache, which is made if it is not there; empty if the system names no place.
std::string cache_folder();

/// Where the index of that library is kept, a file in the user's cache; empty if the system names no place. Programs that
/// ask for the same device and the same folders, in the same folder if it has materials, share it. One of a folder begins
/// with a copy of the one of the shipped files alone, so that these are read once for all folders.
std::string kept_index(const FileRequest& request, const std::vector<LibraryFile>& files);

/// What is told while an index is opened.
struct IndexTold {
  StoreProgress progress = {};
  /// A warning: that the index is of another build of Wale; that none can be kept, and the whole library is read.
  std::function<void(Error warning)> warn = [](const Error&) {};
};

/// The index that is looked in. Safe from one thread at a time.
struct IndexHere {
  std::shared_ptr<const LibraryIndex> catalogue = {};  ///< null for one that was named
  std::string place = {}, device = {};
  std::unique_ptr<LibraryStore> store = {};
  std::unique_ptr<MaterialIndex> in_memory = {};  ///< if nothing can be kept
  StoreReport report = {};

  const MaterialIndex& index() const { return store ? store->index() : *in_memory; }
};

/// Opens the index that is kept for these files, and brings it up to date with them. Error: none can be kept, or W0706.
Result<> refresh_kept(IndexHere& here, const FileRequest& request, const std::vector<LibraryFile>& files,
                      const StoreProgress& progress);

/// Opens the index at `place` as it stands, a file or the address of a shared one; or, if `place` is empty, brings the one
/// that is kept for the library of the current folder up to date. What `here` has open of the same library is used again.
/// Where no index can be kept, reads the library, once for each `here`. What `can_be_felt` refuses of
/// `meant` is told before anything is read. Errors: those of `LibraryStore::open` for a place that was named; those of
/// `can_be_felt`; W0706.
Result<> open_index(IndexHere& here, const std::string& place, const FileRequest& request,
                    const std::vector<std::string>& meant = {}, const IndexTold& told = {});

}  // namespace wale
