#pragma once

#include <string_view>

#include "schema/sentence.hpp"
#include "wale/patch_program.hpp"

namespace wale {

/// Ends the verification: throws an `Error` with a sentence made of `parts`, which `verify` returns.
template <typename... Parts>
[[noreturn]] void refuse(const Parts&... parts) {
  fail(Code::refused_program, parts...);
}

/// The part of `verify` that checks figures: the number of registers, tables, parameters, states, grids, marks, the
/// lattices of peaks, the patch, the device, percepts and fates. Throws as `refuse` does.
void verify_figures(const PatchProgram& program);

/// Ticks. The filter tries each length of its window at each tick.
inline constexpr double most_velocity_window = 100;

/// A figure of a device that is out of its range.
struct RefusedFigure {
  std::string_view name;  ///< "slew"
  double value = 0, low = 0, high = 0;
};

/// The part of it that checks the figures of a device. `refused` receives the figure that it throws for, if it is one of
/// those with a name.
void verify_device(const DeviceProfile& device, RefusedFigure* refused = nullptr);

/// The part of `verify` that checks the cost of code: each section within its share of the period, setup within its
/// limit. Throws as `refuse` does.
void verify_costs(const PatchProgram& program);

}  // namespace wale
