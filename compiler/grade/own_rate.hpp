#pragma once

#include "wale/program.hpp"

namespace wale {

/// The fastest rate, in Hz, at which a program goes through a cycle by itself: the sine or cosine of a multiple of the
/// time, the fraction of one, or a state that runs from 0 to 1 by the same step at every tick, as `phase` does. 0 if
/// there is none. Rates that change with the hand, the time or memory are not found, and neither are overtones.
double fastest_own_rate(const Bank& bank);

/// The rate, in Hz, of the wave of `rate` after it is sampled `samples` times a second: between 0 and half of that.
double rate_when_sampled(double rate, double samples);

}  // namespace wale
