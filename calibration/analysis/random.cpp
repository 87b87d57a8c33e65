#include "calibration/analysis/random.hpp"

#include "calibration/analysis/distributions.hpp"

namespace wale::analysis {

double Random::uniform() { return (static_cast<double>(engine_() >> 11) + 0.5) * 0x1p-53; }

double Random::normal() { return normal_quantile(uniform()); }

std::uint64_t Random::below(std::uint64_t count) {
  // Draws beyond the last whole multiple of `count` would favour small numbers.
  const std::uint64_t whole = UINT64_MAX - UINT64_MAX % count;
  std::uint64_t drawn = engine_();
  while (drawn >= whole) drawn = engine_();
  return drawn % count;
}

std::uint64_t Random::binomial(std::uint64_t n, double p) {
  std::uint64_t successes = 0;
  for (std::uint64_t i = 0; i < n; ++i) successes += uniform() < p ? 1 : 0;
  return successes;
}

}  // namespace wale::analysis
