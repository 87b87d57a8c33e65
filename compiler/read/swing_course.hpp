#pragma once

#include <complex>
#include <optional>
#include <vector>

#include "compiler/read/swing.hpp"

namespace wale {

/// A swing that dies away or grows over the seconds that were looked at.
struct UnsteadySwing {
  SwingCourse course;
  double amplitude = 0;     ///< N: the 99th percentile of its size over all of these seconds
  std::vector<Force> even;  ///< the part of them in which it is there, as if it were equally strong all the while
};

/// Tells whether the part of a changing force between two frequencies (Hz) dies away or grows; nothing if it does
/// neither. `changes` (N, x + i y) come `rate` times a second, without their mean.
std::optional<UnsteadySwing> unsteady_swing(const std::vector<std::complex<float>>& changes, double rate,
                                            double slowest, double fastest);

}  // namespace wale
