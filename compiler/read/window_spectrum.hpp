#pragma once

#include <functional>
#include <glm/vec2.hpp>
#include <span>
#include <vector>

#include "compiler/read/still_forces.hpp"

namespace wale {

/// The waves of a window's forces, seen through Hann's window. Places are one in each cell, anywhere in it: what is too
/// fine for the cells is spread over all waves alike, and taken off.
class WindowSpectrum {
 public:
  /// `forces` are at the window's places, without trends.
  WindowSpectrum(const StillForces& window, std::span<const glm::dvec2> forces);

  /// 0 .. 1: the share of the mean square that is in waves too fine for this window.
  double finer() const { return finer_; }
  /// Periods over a metre of the strongest waves, strongest first, none next to another.
  std::vector<glm::dvec2> peaks(std::size_t most, double fewest_periods) const;
  /// Calls `visit(waves, power)` for half of all waves: their periods over a metre, and their share of the mean square.
  void each(const std::function<void(glm::dvec2, double)>& visit) const;
  /// m: waves with shorter periods are too fine for the window's cells.
  double finest() const { return finest_; }

 private:
  std::size_t side_;
  glm::dvec2 size_;
  std::vector<double> shares_;  // of the mean square, row by row up to half of the rows: the others mirror them
  double finer_ = 0, finest_ = 0;
};

/// Hann's window over `count` samples. It keeps a wave that does not fit a whole number of times from spreading.
std::vector<float> hann_window(std::size_t count);

}  // namespace wale
