#include "compiler/text/sampled_rate.hpp"

#include <cmath>

#include "compiler/text/readable.hpp"

namespace wale {

double rate_when_sampled(double rate, double samples) { return std::abs(rate - samples * std::round(rate / samples)); }

std::string what_comes_out(double rate, double loop) {
  constexpr double same = 1e-4;  // of the loop's rate
  const double sampled = rate_when_sampled(rate, loop);
  if (sampled < same * loop) return "a force that stays the same";
  if (sampled > (0.5 - same) * loop) return "two forces in turn, which may be equal";
  return readable("one of {:.4g} Hz", sampled);
}

}  // namespace wale
