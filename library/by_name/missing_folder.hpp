#pragma once

#include <optional>
#include <string>
#include <vector>

#include "wale/result.hpp"

namespace wale {

/// The error about the first of these that is no folder: `unreadable_file`.
std::optional<Error> missing_folder(const std::vector<std::string>& folders);

}  // namespace wale
