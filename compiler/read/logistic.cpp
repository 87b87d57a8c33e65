#include "compiler/read/logistic.hpp"

#include <bit>
#include <cstdint>
#include <initializer_list>

#include "compiler/read/wide_vectors.hpp"

namespace wale {
namespace {

constexpr double rounder = 0x1.8p52;  // its sum with a small number has the nearest whole number in the low bits
constexpr double one_over_ln2 = 1.4426950408889634, ln2_high = 0x1.62e42fee00000p-1, ln2_low = 0x1.a39ef35793c76p-33;
constexpr double largest = 700;  // beyond it the exponential is none that a double holds

struct Logistic {
  [[gnu::always_inline]] static void run(const double* values, std::size_t count, double* found) {
    for (std::size_t i = 0; i < count; ++i) {
      const double a = -values[i], above = a < -largest ? -largest : a, power = above > largest ? largest : above;
      const double rounded = power * one_over_ln2 + rounder, whole = rounded - rounder;
      const double f = (power - whole * ln2_high) - whole * ln2_low;  // within half of ln 2
      double sum = 1.0 / 6227020800;                                  // Taylor's series up to the 13th power
      for (const double factorial :
           {479001600.0, 39916800.0, 3628800.0, 362880.0, 40320.0, 5040.0, 720.0, 120.0, 24.0, 6.0, 2.0, 1.0, 1.0})
        sum = sum * f + 1 / factorial;
      const auto exponent = std::bit_cast<std::uint64_t>(rounded) - std::bit_cast<std::uint64_t>(rounder);
      found[i] = 1 / (1 + std::bit_cast<double>(std::bit_cast<std::uint64_t>(sum) + (exponent << 52)));
    }
  }
};

}  // namespace

void logistic_of(const double* values, std::size_t count, double* found) { run_wide<Logistic>(values, count, found); }

}  // namespace wale
