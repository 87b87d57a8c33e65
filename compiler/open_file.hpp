#pragma once

#include <optional>
#include <string>
#include <vector>

#include "compiler/check/check.hpp"
#include "compiler/compile.hpp"
#include "compiler/diagnostics/diagnostic.hpp"
#include "wale/program.hpp"

namespace wale {

/// A file as a person names it: a Wale file, or a patch program (.wpp).
struct FileRequest {
  std::string file;
  std::string device = default_device;
  std::vector<std::string> roots;                  ///< folders in which imports are looked for at last
  std::vector<std::string>* looked_for = nullptr;  ///< gets the paths of what it imports or shows, found or not
};

/// FILE, or FILE:MATERIAL where there is no file of that whole name.
struct NamedMaterial {
  std::string file;
  std::string material;  ///< empty where none is named
};
NamedMaterial named_material(const std::string& name);

/// What such a file holds.
struct OpenedFile {
  SourceSet sources;
  SourceId source = 0;
  Diagnostics diagnostics;
  std::string refusal;                  ///< why it cannot be read or loaded at all; else empty
  std::optional<Program> program;       ///< of a patch program
  std::optional<CheckedModule> module;  ///< of a Wale file, with or without errors
};

/// Reads a file and, when it is a Wale file, checks it. No material is compiled yet.
OpenedFile open_file(const FileRequest& request);

/// Compiles one material of an opened Wale file; its errors and warnings go to `diagnostics`. Without a name the file's
/// only or first material.
std::optional<Program> compile_opened(const OpenedFile& opened, const FileRequest& request, const std::string& material,
                                      Diagnostics& diagnostics);

/// The names of an opened Wale file's materials, in the order written.
std::vector<std::string> materials_of(const OpenedFile& opened);

}  // namespace wale
