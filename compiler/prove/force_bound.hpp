#pragma once

#include <array>

#include "compiler/prove/domain.hpp"
#include "compiler/prove/largest_force.hpp"
#include "wale/program.hpp"

namespace wale {

/// The proved bound of a program's force, and the largest force that was found.
struct ForceBound {
  double newton = 0;                    ///< no |force| is larger: proved
  std::array<double, 2> axis_newton{};  ///< no force along x or y is larger: proved
  LargestForce found;                   ///< a force that the program does give
  long evaluations = 0;                 ///< parts of the domain that were evaluated

  /// The bound over the force found: 1 if the bound is exact, infinity if nothing was found.
  double ratio() const;
};

/// The effort for a bound: instructions run over ranges, about 0.15 us each. It is a count and not a time, so that the
/// same program has the same bound everywhere.
inline constexpr long usual_effort = 400'000;

/// The bound over `domain`: first by ranges in one pass, then by splitting the domain where the bound is largest, along
/// the quantity that lowers it most. It stops within a thousandth of the force found, when the effort is spent, or when
/// a sixteenth of the effort gained nothing.
ForceBound force_bound(const Program& program, const Domain& domain, long effort = usual_effort);

/// The bound over everything that the runtime allows, with the states and memories that a run can reach.
ForceBound force_bound(const Program& program);

}  // namespace wale
