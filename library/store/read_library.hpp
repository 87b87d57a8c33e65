#pragma once

#include <mutex>
#include <string>
#include <unordered_map>
#include <utility>
#include <vector>

#include "library/store/library_store.hpp"

namespace wale {

/// The entries of a file, and what they rest on.
struct ReadFile {
  std::vector<Entry> entries;
  std::vector<std::pair<std::string, std::string>> rests_on;  ///< paths, the file's first, and the hashes of their bytes
  bool uses_names = false;    ///< other files of the library may change what it means
  std::string imports_keep_back;  ///< why what it imports forbids to pass it on; empty if it does not, or was not asked
};

/// Reads one file. One that cannot be read, or in whose text no material can, is an entry with its trouble. `to_pass_on`
/// asks whether its imports may be passed on; `kept` has what was measured of equal programs. Thread-safe.
ReadFile read_library_file(const LibraryFile& file, const FileRequest& request, bool to_pass_on = false,
                           KeptReadings* kept = nullptr);

/// Reads `files[i]` for each `i` of `which`, on all cores, and hands each to `keep`, one at a time, in any order. Ends at
/// the first error of `keep`, which it returns, or with W0706 where `tell` ends it.
Result<> read_library_files(const std::vector<LibraryFile>& files, const std::vector<std::size_t>& which,
                            const FileRequest& request, bool to_pass_on, const StoreProgress& tell,
                            const std::function<Result<>(std::size_t which, ReadFile read)>& keep);

struct KnownFile;

/// The hashes of files, and of what other files of their library may name in them.
struct FileHashes {
  std::vector<std::string> each;   ///< of their bytes
  std::vector<std::string> named;  ///< for each file, as `rests_on_text` keeps it: of its bytes, and of what they may name
  std::string others;              ///< of all that they may name, with the names by which an index knows the files
};
/// `names` are those by which an index knows the files, and `known` what it holds of them, if anything: only of files
/// that it does not know as they are, the texts are parsed.
FileHashes hashes_of(const std::vector<LibraryFile>& files, const std::vector<std::string>& names,
                     const std::function<const KnownFile*(std::size_t which)>& known);

/// The hashes of files that many others rest on, as a library's `wale.project`: each is read once. Thread-safe.
class HashesOnce {
 public:
  std::string of(const std::string& path);

 private:
  std::mutex mutex_;
  std::unordered_map<std::string, std::string> known_;
};

/// What an index knows of a file that it holds.
struct KnownFile {
  std::string module;
  std::string rests_on;  ///< as `rests_on_text` has it
  std::string others;    ///< `FileHashes::others`, if what its library's files are called may change what it means
};

/// What a file rests on as a text: an array of paths and hashes, with the file's `FileHashes::named` before them.
std::string rests_on_text(const std::vector<std::pair<std::string, std::string>>& rests_on, const std::string& named);

/// Whether all that a file rests on is as it was: the file itself, of which `hash` is known and `name` is the name in the
/// index, and the others, whose paths on this machine `path_of` tells. Thread-safe.
bool is_unchanged(const KnownFile& known, const std::string& module, const std::string& name, const std::string& hash,
                  const std::string& others, HashesOnce& hashes,
                  const std::function<std::string(const std::string& name)>& path_of);

}  // namespace wale
