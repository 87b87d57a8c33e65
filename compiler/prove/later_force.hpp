#pragma once

#include "wale/program.hpp"

namespace wale {

/// N: what a program's force may come to at any time, if that is plainly more than all that it may come to within the
/// first `seconds` (both proved at the bank's parameters, on its patch); otherwise 0. The states of a program that
/// remembers time only are those that it goes through in these seconds.
double later_force(const Bank& bank, double seconds, bool remembers_time_only);

}  // namespace wale
