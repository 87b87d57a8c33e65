#pragma once

#include <cstddef>

namespace wale {

/// 1 / (1 + exp(-a)) of some values, to 4e-16: the same bits on every machine. Not-a-number propagates.
void logistic_of(const double* values, std::size_t count, double* found);

inline double logistic_of(double value) {
  logistic_of(&value, 1, &value);
  return value;
}

}  // namespace wale
