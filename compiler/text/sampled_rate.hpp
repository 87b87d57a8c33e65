#pragma once

#include <string>

namespace wale {

/// The rate, in Hz, of the wave of `rate` after it is sampled `samples` times a second: between 0 and half of that.
double rate_when_sampled(double rate, double samples);

/// "one of 300 Hz", "a force that stays the same": what a wave of `rate` (Hz), at or above half of the loop's rate
/// (Hz), comes out as.
std::string what_comes_out(double rate, double loop);

}  // namespace wale
