#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "compiler/text/source.hpp"
#include "wale/result.hpp"

namespace wale {

/// A file that the user named, and which of its materials is meant.
struct NamedFile {
  std::string name;  ///< its path, or that of a shipped file of the library
  std::string bytes;
  std::optional<SourceId> embedded;  ///< for a shipped file: its source
  std::string material;              ///< empty if only the file was named
  std::string taken;  ///< if the argument may mean another material too, a sentence that names both; mostly empty
};

/// Finds the meaning of a FILE argument. The first of these that exists:
///
///   - a file: `my.wale`, `./brick`; outside a checkout also the path that `wale find` prints,
///   `library/stone/brick.wale`;
///   - FILE:MATERIAL, one material of it;
///   - a module that a file in the current folder could import: `fabric.denim`;
///   - a material of the project in the current folder, of the folders `roots`, or of the shipped library, by the rule
///   in
///     compiler/modules/meant_material.hpp: its name, its title or another name, or its kind.
///
/// A text with a `/` or the extension of a file is never used as a name. Errors: W0501 for a file that cannot be read,
/// W0201 for an unknown name, with the nearest three, W0217 for a name of several materials, W0801 for nothing after
/// the colon, W0506 for a file of another kind, such as a recording or a picture.
Result<NamedFile> find_named(const std::string& argument, const std::vector<std::string>& roots);

/// As `find_named`, but never a file of that name: a module, or a material by its name, or MODULE:MATERIAL. Errors:
/// W0201, W0217, W0801.
Result<NamedFile> find_named_material(const std::string& name, const std::vector<std::string>& roots);

/// Reads a file by its path alone, also a shipped one outside a checkout. Errors: W0501, W0506.
Result<NamedFile> read_named_file(const std::string& path);

/// Error W0506 if the bytes are those of another kind of file, such as a recording or a picture.
Result<> is_wale_or_program(const std::string& path, std::string_view bytes);

/// Whether a file is a patch program, by its name or by its first bytes.
bool is_patch_program(std::string_view path, std::string_view bytes);

/// FILE:MATERIAL in two parts. The material is empty if there is no `:`, or if the whole text is the name of a file. If
/// nothing follows the `:`, it remains part of the file's name, and `find_named` refuses it.
struct NamedMaterial {
  std::string file;
  std::string material;
};
NamedMaterial named_material(const std::string& argument);

/// Whether an argument of `find_named` is looked for by its name in the folders of the library: it is no path, and no
/// file has that name.
bool is_searched_for(const std::string& argument);

}  // namespace wale
