#pragma once

#include "wale/program.hpp"

namespace wale {

/// N: the force that a friction of this size (N, of a hand that slides) holds before it lets a resting hand slide. 0 if
/// it is hardly larger, or if the program remembers nothing, so that it cannot tell a resting hand from a sliding one.
double breakaway_of(const Bank& bank, double sliding);

}  // namespace wale
