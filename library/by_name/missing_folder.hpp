#pragma once

#include <optional>
#include <string>
#include <vector>

#include "wale/result.hpp"

namespace wale {

/// The error about the first of these that is no folder: `unreadable_file`. `argument` is what named them.
std::optional<Error> missing_folder(const std::vector<std::string>& folders, const std::string& argument = "folders");

/// The same folders by their whole paths, so that they stay the same when the process goes to another folder.
std::vector<std::string> whole_paths(std::vector<std::string> folders);

}  // namespace wale
