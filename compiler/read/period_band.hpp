#pragma once

#include <cmath>
#include <numbers>

namespace wale {

/// Spatial periods, m.
struct PeriodBand {
  double low = 0, high = 0;
};

/// Goes from 1 to 0 as the period goes from one to the other, on a logarithmic scale.
inline double fade(double period, double from, double to) {
  if (period <= from) return 1;
  if (period >= to) return 0;
  return 0.5 + 0.5 * std::cos(std::numbers::pi * std::log(period / from) / std::log(to / from));
}

/// At its ends a band fades in over this ratio of periods.
inline constexpr double gradual = 1.2;

/// The share of an amplitude that a band passes at a square of the number of periods per metre.
inline double share_let_through(const PeriodBand& band, double waves_squared) {
  const auto beyond = [&](double period) { return waves_squared * period * period; };
  if (beyond(band.high * gradual) <= 1 || beyond(band.low / gradual) >= 1) return 0;
  if (beyond(band.high) >= 1 && beyond(band.low) <= 1) return 1;
  const double period = 1 / std::sqrt(waves_squared);
  return fade(period, band.high, band.high * gradual) * (1 - fade(period, band.low / gradual, band.low));
}

}  // namespace wale
