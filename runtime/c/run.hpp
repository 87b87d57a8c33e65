#pragma once

#include <memory>

#include "runtime/c/call.hpp"
#include "wale/run.h"
#include "wale/run.hpp"

struct WaleRun {
  wale::RunResult result;
  std::unique_ptr<WaleError> problem = {};
};

namespace wale::c {

inline WaleVector vector_of(const glm::vec2& vector) noexcept { return {vector.x, vector.y}; }
WaleGuards guards_of(const GuardCounts& counts) noexcept;
/// Gives a handle to the caller, if it wants one.
void give_run(RunResult result, HandleToBe<WaleRun>& handle);

}  // namespace wale::c
