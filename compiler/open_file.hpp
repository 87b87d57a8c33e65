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

/// What a person names: a Wale file, a patch program (.wpp), or a material by name.
struct FileRequest {
  std::string file;  ///< whatever `find_named` finds
  std::string device = default_device;
  std::vector<std::string> roots;                  ///< folders in which imports are looked for at last
  std::vector<std::string>* looked_for = nullptr;  ///< gets the paths of what it imports or shows, found or not
  Sandbox sandbox = Sandbox::required;             ///< of the decoder of its pictures
};

/// What such a file holds.
struct OpenedFile {
  SourceSet sources;
  SourceId source = 0;
  Diagnostics diagnostics;
  std::string name;                     ///< the path of the file
  std::string material;                 ///< the one that was named; empty where only the file was
  std::string also;                     ///< FILE:MATERIAL of the material that has the file's name; mostly empty
  std::optional<Program> program;       ///< of a patch program
  std::optional<CheckedModule> module;  ///< of a Wale file, with or without errors
};

/// Finds and reads a file and, if it is a Wale file, checks it: what is wrong in its text is in `diagnostics`. No
/// material is compiled yet. Errors: those of `find_named`, and W0606 for a patch program that does not load.
Result<OpenedFile> open_file(const FileRequest& request);

/// Compiles one material of an opened Wale file; its errors and warnings go to `diagnostics`. Without a name the
/// material that was named with the file, or else the file's only or first one.
std::optional<Program> compile_opened(const OpenedFile& opened, const FileRequest& request, const std::string& material,
                                      Diagnostics& diagnostics);

/// The names of an opened Wale file's materials, in the order written; only the one that was named with it, if any.
std::vector<std::string> materials_of(const OpenedFile& opened);

}  // namespace wale
