#pragma once

#include "compiler/extract/force_field.hpp"
#include "compiler/extract/fourier.hpp"

namespace wale {

/// What of a field is slow: has periods of many of its samples. Worked out on every fourth line and column.
class SlowForce {
 public:
  /// Of a field whose side is a multiple of four; it is taken to go on from its other end.
  explicit SlowForce(const ForceField& field);

  /// Components with longer periods than `to`, none of those with shorter ones than `from` (m, eight samples or more),
  /// and gradually more in between; on every other line and column of the field, from the first.
  ForceField beyond(double from, double to) const;

  /// N: no more than that is the 99th percentile of its size, wherever one looks at two thirds of it or more.
  double ceiling_beyond(double from, double to) const;

 private:
  /// Calls `visit(column, row, share)` for all coefficients of which a share of the amplitude counts.
  template <typename Visit>
  void each_beyond(double from, double to, const Visit& visit) const;

  std::size_t side_;
  glm::dvec2 centre_, spacing_;  // m, of the field's samples
  Spectrum spectrum_;            // of every fourth line and column
};

/// The same on twice as many lines and columns, between those that there are by cubics; it goes on from its other end.
ForceField refined(const ForceField& field);

}  // namespace wale
