#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "calibration/analysis/least_squares.hpp"
#include "wale/force_response.hpp"
#include "wale/result.hpp"

namespace wale {

/// What a gauge said about one command.
struct GaugeReading {
  Way way = Way::right;
  double command = 0;    ///< N that the motor was told, 0 or more
  double newton = 0;     ///< N at the handle, positive in that way
  int repeat = 1;        ///< the round in which it was taken, from 1
  std::size_t line = 0;  ///< of its table; 0: typed
};

/// The response of one way, fitted to readings. Each figure has its standard error and its degrees of freedom, so
/// `low()` and `high()` are the ends of its 95 % interval.
struct WayFit {
  Way way = Way::right;
  analysis::Coefficient gain;                 ///< N at the handle for each N of command, over the whole range
  analysis::Coefficient dead_band;            ///< N of command
  analysis::Coefficient quadratic, cubic;     ///< bends, as in `ForceResponse`; 0 without freedom if `bends` is less
  std::optional<analysis::Coefficient> most;  ///< N, of the saturation; none: not reached
  analysis::Coefficient offset;               ///< N, what the gauge says without force, in this way
  int bends = 2;                              ///< how many of the bends the readings can tell: 0, 1 or 2
  std::size_t readings = 0, commands = 0;     ///< how many, and how many different commands
  double deviation = 0;                       ///< N, the standard deviation of the readings around the fit
  double greatest_residual = 0;               ///< N
  double greatest_command = 0;                ///< N, that was read
  /// The chance of so much more deviation between commands than between readings of the same command, if the fit is
  /// right. None without repeated readings.
  std::optional<double> lack_of_fit;
  /// How much the force changed from the first round to the last, as a share. None with fewer than three commands read
  /// in more than one round.
  std::optional<analysis::Coefficient> drift;
  std::vector<double> residuals;  ///< N, in the order of the readings

  /// The response with the gain as a whole: for an axis of gain 1.
  ForceResponse response() const;
};

/// Fits gain, dead band, bends, saturation and offset to the readings of one way, by least squares. `peak`: N, the
/// device's force, above zero. The readings' noise is taken to be the same for all commands.
///
/// A saturation is only found if two commands at least lie in it and chance would not make it (p < 0.001). Bends need
/// readings at six different commands between dead band and saturation, one bend needs five.
///
/// Errors (W0802): fewer than five different commands, or than 8 readings; none at a command of zero, since dead band
/// and offset cannot be told apart without; force that does not grow with the command; figures that no device has, as
/// the loader of declarations checks them. A gain outside 0.1 .. 10 is one: it says how gram-force would look.
Result<WayFit> fit_way(std::span<const GaugeReading> readings, double peak);

/// The force that the handle gets in an axis without a command, N to the right or away, from the offsets of both of its
/// ways; the rest is the gauge's own zero.
analysis::Coefficient axis_offset(const WayFit& forward, const WayFit& backward);

}  // namespace wale
