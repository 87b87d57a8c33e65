#pragma once

#include "compiler/extract/force_field.hpp"
#include "compiler/extract/fourier.hpp"
#include "compiler/extract/period_band.hpp"

namespace wale {

/// The slow part of a field, with periods of many samples. It is computed on every fourth line and column.
class SlowForce {
 public:
  SlowForce() = default;
  /// The side of the field is a multiple of four; the field is continued periodically.
  explicit SlowForce(const ForceField& field);

  /// The part with periods within a band of at least eight samples; a band without an upper end has none here. On every
  /// other line and column of the field, from the first.
  ForceField within(const PeriodBand& band) const { return on_lines_of(side_ / 2, band); }
  /// The same on every fourth line and column.
  ForceField coarsely_within(const PeriodBand& band) const { return on_lines_of(side_ / 4, band); }

  /// N: an upper bound of the 99th percentile of its size, over any part of two thirds of the field or more.
  double ceiling_within(const PeriodBand& band) const;

 private:
  /// Calls `visit(column, row, share)` for each coefficient of which a share of the amplitude counts.
  template <typename Visit>
  void each_within(const PeriodBand& band, const Visit& visit) const;
  ForceField on_lines_of(std::size_t side, const PeriodBand& band) const;

  std::size_t side_ = 0;
  glm::dvec2 centre_{0}, spacing_{0};  // m, of the field's samples
  Spectrum spectrum_;                  // of every fourth line and column
};

/// The same field on twice as many lines and columns, interpolated by cubics and continued periodically.
ForceField refined(const ForceField& field);

}  // namespace wale
