#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "compiler/text/source.hpp"
#include "schema/result.hpp"

namespace wale {

/// A file that somebody names, and which of its materials is meant.
struct NamedFile {
  std::string name;  ///< its path, or that of a file of the library that is part of the binary
  std::string bytes;
  std::optional<SourceId> embedded;  ///< of a file that is part of the binary
  std::string material;              ///< empty where only the file is named
  std::string taken;  ///< where the argument may mean another material too: a sentence that names both; mostly empty
};

/// Finds what a FILE argument means, the first that there is:
///
///   - a file: `my.wale`, `./brick`; outside a checkout also the path that `wale find` prints,
///   `library/stone/brick.wale`;
///   - FILE:MATERIAL, one material of it;
///   - a module that a file in the present folder could import: `fabric.denim`;
///   - a material of the project in the present folder, of the folders `roots`, or of the shipped library, by the rule
///   of
///     compiler/modules/meant_material.hpp: its name, its title or another name, or its kind.
///
/// A text with a `/` or with the ending of a file is never looked for as a name. Errors: W0501 for a file that cannot
/// be read, W0201 for an unknown name, with the nearest three, W0217 for a name of several materials, W0801 for nothing
/// behind the colon and for a recording, a picture or another file that is neither Wale nor a patch program.
Result<NamedFile> find_named(const std::string& argument, const std::vector<std::string>& roots);

/// Whether a file is a patch program, by its name or by the bytes that it begins with.
bool is_patch_program(std::string_view path, std::string_view bytes);

/// FILE:MATERIAL in two parts; where there is a file of the whole name, or no `:`, the material is empty. With nothing
/// behind the `:` it stays with the file, and `find_named` refuses it.
struct NamedMaterial {
  std::string file;
  std::string material;
};
NamedMaterial named_material(const std::string& argument);

}  // namespace wale
