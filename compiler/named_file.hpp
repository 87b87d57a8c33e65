#pragma once

#include <optional>
#include <string>
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
  std::string also;  ///< FILE:MATERIAL of the material that has the same name as this file; empty where there is none
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
/// behind the colon.
Result<NamedFile> find_named(const std::string& argument, const std::vector<std::string>& roots);

/// FILE:MATERIAL in two parts; where there is a file of the whole name, or no `:`, the material is empty. With nothing
/// behind the `:` it stays with the file, and `find_named` refuses it.
struct NamedMaterial {
  std::string file;
  std::string material;
};
NamedMaterial named_material(const std::string& argument);

}  // namespace wale
