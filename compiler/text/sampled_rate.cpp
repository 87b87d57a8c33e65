#include "compiler/text/sampled_rate.hpp"

#include <algorithm>
#include <cmath>

#include "compiler/text/readable.hpp"

namespace wale {

double rate_when_sampled(double rate, double samples) { return std::abs(rate - samples * std::round(rate / samples)); }

double fastest_as_written(double loop) {
  constexpr double slowest_swell = 10;     // Hz: a hand follows what swells more slowly, and each time feels it go
  constexpr double still_in_turn = 0.02;   // of the loop's rate: then many samples lie on either side before it goes
  constexpr double rounding = 1e-5;
  return (0.5 * loop - std::min(0.5 * slowest_swell, still_in_turn * loop)) * (1 + rounding);
}

std::string what_comes_out(double rate, double loop) {
  constexpr double same = 1e-4;  // of the loop's rate
  const double sampled = rate_when_sampled(rate, loop);
  if (sampled < same * loop) return "a force that stays the same";
  if (sampled > (0.5 - same) * loop) return "two forces in turn, which may be equal";
  if (sampled > fastest_as_written(loop))
    return readable("forces in turn, which swell and vanish {:.3g} times a second", loop - 2 * sampled);
  return readable("one of {:.4g} Hz", sampled);
}

}  // namespace wale
