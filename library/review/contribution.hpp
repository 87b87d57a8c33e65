#pragma once

#include <string>
#include <vector>

#include "wale/result.hpp"

namespace wale {

/// A file or folder that a library cannot hold, and why, in a sentence without its name.
struct UnfitFile {
  std::string path, why;
};

/// The Wale files of a contribution.
struct Contribution {
  std::vector<std::string> files;  ///< each once, in the order of their paths
  std::vector<UnfitFile> unfit;    ///< in the order of their paths
};

/// How many folders may lie in one another, and how many files are looked at: a hundred times a large library.
inline constexpr int deepest_folder = 16;
inline constexpr std::size_t most_files = 1'000'000;

/// The files that paths name, and all `.wale` files below folders. No link below a folder is followed: it is unfit, and
/// so are other things than files that end in `.wale`, names that a terminal would obey, and folders that are too deep.
/// Errors: W0501 for a path that cannot be read and for too many files, W0602 if there is no Wale file.
Result<Contribution> contribution_of(const std::vector<std::string>& paths);

}  // namespace wale
