#pragma once

#include <memory>
#include <vector>

#include "runtime/stage/patch_table.hpp"

namespace wale {

struct StageState;

/// The patches that a hand touched in a run, as they were at its end.
struct PatchesInRun {
  std::weak_ptr<const StageState> stage;
  std::vector<PatchTable::Published> all;

  PatchesInRun(std::weak_ptr<const StageState> of, std::vector<PatchTable::Published> touched)
      : stage(std::move(of)), all(std::move(touched)) {}
};

}  // namespace wale
