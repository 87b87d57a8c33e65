#pragma once

#include <string>
#include <vector>

#include "compiler/modules/library_index.hpp"
#include "wale/result.hpp"

namespace wale {

/// A file of a library.
struct LibraryFile {
  std::string path;    ///< as messages show it; of a shipped file "library/fabric/denim.wale"
  std::string module;  ///< as imports name it: "fabric.denim"
};

/// The Wale files that the paths name, and those in the folders that they name, each once, in the order of their paths.
/// Without a path, the shipped ones. A module is named from the nearest folder with a `wale.project`, or else from the
/// folder that was named. Errors: W0501 for a path that cannot be read, W0602 if there is no Wale file.
Result<std::vector<LibraryFile>> library_files_in(const std::vector<std::string>& paths);

/// The files of all materials of a catalogue but those that imports do not find, in the order of their paths.
std::vector<LibraryFile> library_files_in(const LibraryIndex& catalogue);

/// The hash of a file's bytes; empty if there is none on disk, as of a shipped file outside a checkout.
std::string hash_of_file(const std::string& path);

}  // namespace wale
