#pragma once

#include <optional>

#include "compiler/read/read.hpp"

namespace wale {

/// How many times as hard a program pushes at the parameters of `there` as at those of `here`, wherever the hand is and
/// however it moves; 0 if it does not push there at all. Nothing if the forces are not in proportion, if there are
/// none here, or if the program remembers. Felt at some hundred places, speeds, accelerations and moments.
std::optional<double> times_as_strong(const Bank& here, const Bank& there);

/// The reading of a program that pushes so many times as hard everywhere; `times` is at least 0.
ForceReading times_as_strong(ForceReading found, double times);

}  // namespace wale
