#pragma once

#include <cstdint>
#include <random>

namespace wale::analysis {

/// Random numbers that are the same on every machine for the same seed: the distributions of the standard library are
/// not, its engine is. One object belongs to one thread.
class Random {
 public:
  explicit Random(std::uint64_t seed) : engine_(seed) {}

  /// Evenly in (0, 1): neither end occurs.
  double uniform();
  /// From the standard normal distribution.
  double normal();
  /// A whole number from 0 to `count` - 1, evenly; `count` > 0.
  std::uint64_t below(std::uint64_t count);
  /// How many of n independent trials succeed, each with probability p in [0, 1].
  std::uint64_t binomial(std::uint64_t n, double p);

 private:
  std::mt19937_64 engine_;
};

}  // namespace wale::analysis
