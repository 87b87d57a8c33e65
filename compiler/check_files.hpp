#pragma once

#include <string>
#include <vector>

#include "compiler/diagnostics/diagnostic.hpp"
#include "compiler/text/resolver.hpp"
#include "wale/result.hpp"

namespace wale {

/// The diagnostics of some files, from all stages and for all of their materials.
struct CheckedFiles {
  SourceSet sources;
  Diagnostics diagnostics;
};

/// All errors and warnings of one text, of which the errors offer those fixes alone that mend (`try_fixes.hpp`).
Diagnostics check_text(SourceSet& sources, SourceId source, const std::vector<std::string>& roots = {},
                       Sandbox sandbox = Sandbox::required);

/// Reads and checks files; a file that cannot be read gives a diagnostic (W0501), and so does a file of another kind,
/// such as a picture or a patch program (W0506). Errors in a file that several of them import are reported once.
/// `roots` are the last folders that are searched for imports.
CheckedFiles check_files(const std::vector<std::string>& files, const std::vector<std::string>& roots = {},
                         Sandbox sandbox = Sandbox::required);

/// A change that was made to a file.
struct Mend {
  LineColumn place;  ///< its place in the text at that time
  std::string title;
};

struct MendedFile {
  std::string file;
  std::vector<Mend> mends;
  Result<> written = {};  ///< the error (W0505) if the mends could not be written
};

/// Applies the safe fixes of the files and checks again, until nothing more can be mended. Writes only the named files
/// and never those that they import, each atomically, and only if it changed.
std::vector<MendedFile> mend_files(const std::vector<std::string>& files, const std::vector<std::string>& roots = {},
                                   Sandbox sandbox = Sandbox::required);

}  // namespace wale
