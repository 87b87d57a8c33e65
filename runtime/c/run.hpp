#pragma once

#include <memory>

#include "runtime/c/call.hpp"
#include "wale/run.h"
#include "wale/run.hpp"

struct WaleRun {
  wale::RunResult result;
  double position_step = 0;  ///< m
  double most = 0;           ///< N, on a pad m/s^2: what the device gives and its user lets through
  std::unique_ptr<WaleError> problem = {};
};

namespace wale::c {

inline WaleVector vector_of(const glm::vec2& vector) noexcept { return {vector.x, vector.y}; }
WaleGuards guards_of(const GuardCounts& counts) noexcept;
/// Gives a handle to the caller, if it wants one. `most` (N, on a pad m/s^2) is what the user lets through.
void hand_out_run(RunResult result, const DeviceProfile& profile, double most, WaleRun** to);

}  // namespace wale::c
