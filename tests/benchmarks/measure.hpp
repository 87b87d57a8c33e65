#pragma once

#include <algorithm>
#include <chrono>
#include <cstddef>
#include <vector>

namespace wale::benchmarks {

inline double now() {
  using namespace std::chrono;
  return duration<double, std::nano>(steady_clock::now().time_since_epoch()).count();
}

inline double median(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

/// What two ways to do the same took, ns each, and how they compare.
struct Comparison {
  double yardstick = 0, measured = 0;
  double ratio = 0;  ///< the median of the ratios: within one pair the machine hardly drifts
};

/// Times the two by turns. Each does `count` things a call.
template <class Yardstick, class Measured>
Comparison compare(std::size_t repetitions, double count, Yardstick&& yardstick, Measured&& measured) {
  std::vector<double> first, second, ratios;
  for (std::size_t i = 0; i < repetitions + 2; ++i) {
    const double start = now();
    yardstick();
    const double between = now();
    measured();
    const double end = now();
    if (i < 2) continue;  // caches and branch histories fill
    first.push_back((between - start) / count);
    second.push_back((end - between) / count);
    ratios.push_back(second.back() / first.back());
  }
  return {median(first), median(second), median(ratios)};
}

}  // namespace wale::benchmarks
