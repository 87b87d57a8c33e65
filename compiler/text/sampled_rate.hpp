#pragma once

#include <string>

namespace wale {

/// The rate, in Hz, of the wave of `rate` after it is sampled `samples` times a second: between 0 and half of that.
double rate_when_sampled(double rate, double samples);

/// Hz: up to this rate, a little below half of the loop's, a wave comes out as one of its rate that a hand feels as
/// steady. Above, its samples fall near its peaks for a while and near its zeros for a while: the force swells and
/// vanishes by turns, as often as twice the rate lacks to the loop's, and less than ten times a second.
double fastest_as_written(double loop);

/// "one of 300 Hz", "a force that stays the same": what a wave of `rate` (Hz), above
/// `fastest_as_written` at a loop's rate (Hz), comes out as.
std::string what_comes_out(double rate, double loop);

}  // namespace wale
