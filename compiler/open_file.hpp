#pragma once

#include <optional>
#include <string>
#include <vector>

#include "compiler/check/check.hpp"
#include "compiler/compile.hpp"
#include "compiler/diagnostics/diagnostic.hpp"
#include "compiler/named_file.hpp"
#include "wale/program.hpp"

namespace wale {

/// A request for a Wale file, a patch program (.wpp), or a material by name.
struct FileRequest {
  std::string file;  ///< an argument of `find_named`
  std::string device = default_device;
  std::vector<std::string> roots;                  ///< the last folders that are searched for imports
  std::vector<ResolvedFile> devices = {};          ///< see `Resolver::devices`
  std::vector<std::string>* looked_for = nullptr;  ///< receives the paths of all imports and images, found or not
  Sandbox sandbox = Sandbox::required;             ///< of the decoder of its pictures
};

/// The content of such a file.
struct OpenedFile {
  SourceSet sources;
  SourceId source = 0;
  Diagnostics diagnostics;
  std::string name;                     ///< the path of the file
  bool is_on_disk = true;               ///< false for a shipped file that is only in this binary
  std::string material;                 ///< the material that was named; empty if only the file was
  std::string taken;                    ///< as in `NamedFile`
  std::optional<Program> program;       ///< for a patch program
  std::optional<CheckedModule> module;  ///< for a Wale file, with or without errors
};

/// Finds and reads a file and, if it is a Wale file, checks it: errors in its text are in `diagnostics`. No material is
/// compiled yet. Errors: those of `find_named`, and W0606 for a patch program that does not load.
Result<OpenedFile> open_file(const FileRequest& request);

/// The same for a file that was found and read.
Result<OpenedFile> open_named(NamedFile named, const FileRequest& request);

/// Compiles one material of an opened Wale file; its errors and warnings go to `diagnostics`. An empty name means the
/// material that was named with the file, or else the first one of the file.
std::optional<Program> compile_opened(const OpenedFile& opened, const FileRequest& request, const std::string& material,
                                      Diagnostics& diagnostics);

/// The names of an opened Wale file's materials, in the order written. If one was named with the file, only that one.
std::vector<std::string> materials_of(const OpenedFile& opened);

}  // namespace wale
