#pragma once

#include "wale/program.hpp"

namespace wale {

/// The largest force, in N, that a thorough search finds on a hand at rest inside the patch's rim: all over the patch,
/// and where the force may jump or is steep, since a feature may be a few encoder counts wide. It is sought at the
/// bank's parameters and, while it is below `enough` (N), at both ends of their ranges, all together and one by one.
/// For a program without states. Deterministic; up to some ten milliseconds for each choice of parameters.
double sought_force(const Bank& bank, double enough);

}  // namespace wale
