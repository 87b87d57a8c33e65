#pragma once

#include <string>
#include <vector>

#include "compiler/diagnostics/diagnostic.hpp"
#include "compiler/text/resolver.hpp"
#include "schema/result.hpp"

namespace wale {

/// What there is to say about some files, all stages and all of their materials.
struct CheckedFiles {
  SourceSet sources;
  Diagnostics diagnostics;
};

/// Reads and checks files; one that cannot be read is a diagnostic (W0501). What is wrong with a file that several of
/// them import is said once. Imports are looked for in `roots` at last.
CheckedFiles check_files(const std::vector<std::string>& files, const std::vector<std::string>& roots = {},
                         Sandbox sandbox = Sandbox::required);

/// A change that was made to a file.
struct Mend {
  LineColumn place;  ///< where it was when it was made
  std::string title;
};

struct MendedFile {
  std::string file;
  std::vector<Mend> mends;
  Result<> written = {};  ///< the error (W0505) where the mends could not be written
};

/// Applies the safe fixes of the files, checks again, and so on until nothing more can be mended. Writes only files
/// that are named here, never those that they import, each whole or not at all, and only if it changed.
std::vector<MendedFile> mend_files(const std::vector<std::string>& files, const std::vector<std::string>& roots = {},
                                   Sandbox sandbox = Sandbox::required);

}  // namespace wale
