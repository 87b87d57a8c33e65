#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "wale/result.hpp"

namespace wale {

/// Whether a shared library may pass on, and anybody change and use for any purpose, what has this licence; `id` as SPDX
/// spells it. Of several, `A OR B`, one must be such, and of `A AND B` all.
bool may_be_shared(std::string_view id);

/// The nearest licence of those, for a misspelt one; nothing if none is near.
std::optional<std::string> nearest_licence(std::string_view id);

/// What the `wale.project` of a library says of the files below it.
struct LibraryProject {
  std::string licence;               ///< `licence "CC0-1.0"`: of all files; empty if none is stated
  std::vector<std::string> stimuli;  ///< `stimuli "sandpaper"`: folders, and so kinds, of what an experiment used
  std::vector<std::string> modules;  ///< `modules "std"`: folders of functions, whose materials are samples of them

  /// Whether the materials of a folder are no contributions: they are as the experiment or the function has them, and
  /// nobody looks for them by what they are called.
  bool is_apart(std::string_view folder) const;
};

/// Reads it from the folder of a library; without such a file it says nothing. Errors: W0501 if the file cannot be read,
/// W0801 for a line that is none of those nor a comment, with its number.
Result<LibraryProject> project_of_library(const std::string& folder);

/// That of the shipped library.
const LibraryProject& shipped_project();

/// The licence of `project_of_library`, with its errors.
Result<std::string> licence_of_library(const std::string& folder);

}  // namespace wale
