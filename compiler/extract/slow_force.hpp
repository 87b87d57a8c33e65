#pragma once

#include "compiler/extract/force_field.hpp"
#include "compiler/extract/fourier.hpp"
#include "compiler/extract/period_band.hpp"

namespace wale {

/// What of a field is slow: has periods of many of its samples. Worked out on every fourth line and column.
class SlowForce {
 public:
  SlowForce() = default;
  /// Of a field whose side is a multiple of four; it is taken to go on from its other end.
  explicit SlowForce(const ForceField& field);

  /// What has periods within a band of at least eight samples, up to any length where that is the band's; on every
  /// other line and column of the field, from the first.
  ForceField within(const PeriodBand& band) const { return on_lines_of(side_ / 2, band); }
  /// The same on every fourth.
  ForceField coarsely_within(const PeriodBand& band) const { return on_lines_of(side_ / 4, band); }

  /// N: no more than that is the 99th percentile of its size, wherever one looks at two thirds of it or more.
  double ceiling_within(const PeriodBand& band) const;

 private:
  /// Calls `visit(column, row, share)` for all coefficients of which a share of the amplitude counts.
  template <typename Visit>
  void each_within(const PeriodBand& band, const Visit& visit) const;
  ForceField on_lines_of(std::size_t side, const PeriodBand& band) const;

  std::size_t side_ = 0;
  glm::dvec2 centre_{0}, spacing_{0};  // m, of the field's samples
  Spectrum spectrum_;                  // of every fourth line and column
};

/// The same on twice as many lines and columns, between those that there are by cubics; it goes on from its other end.
ForceField refined(const ForceField& field);

}  // namespace wale
