#pragma once

#include <memory>
#include <utility>
#include <vector>

#include "runtime/c/call.hpp"
#include "wale/workspace.h"
#include "wale/workspace.hpp"

struct WaleWorkspace {
  wale::Workspace workspace;
  std::vector<std::pair<std::size_t, std::size_t>> statements = {};  ///< of each patch in its text; may be empty
  std::vector<std::unique_ptr<WaleError>> warnings = {};
};
