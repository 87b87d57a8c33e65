#pragma once

#include <array>

#include "compiler/prove/domain.hpp"
#include "compiler/prove/largest_force.hpp"
#include "wale/program.hpp"

namespace wale {

/// How hard a program can push at most, proved, and how hard it was found to push.
struct ForceBound {
  double newton = 0;                    ///< no |force| is larger: proved
  std::array<double, 2> axis_newton{};  ///< no force along x or y is larger: proved
  LargestForce found;                   ///< a force that the program really gives
  long evaluations = 0;                 ///< parts of the domain that were looked at

  /// How much larger the bound is than what was found: 1 when it is exact, infinity when nothing was found.
  double ratio() const;
};

/// How much work a bound is worth: instructions run over ranges, about 0.15 us each. A count and not a clock, so that
/// the same program has the same bound everywhere.
inline constexpr long usual_effort = 400'000;

/// The bound over `domain`: by ranges in one pass, then by splitting the domain where the bound is largest, along the
/// quantity that lowers it most, until it is within a thousandth of what the search found, the effort is spent, or a
/// sixteenth of it has gained nothing.
ForceBound force_bound(const Program& program, const Domain& domain, long effort = usual_effort);

/// The bound over everything that the runtime lets a program see, of what it can remember by then.
ForceBound force_bound(const Program& program);

}  // namespace wale
