#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "calibration/device/fit_response.hpp"
#include "wale/result.hpp"

namespace wale {

/// Readings of a force gauge, or of hanging weights, with where they come from.
struct GaugeReadings {
  std::vector<GaugeReading> readings;
  bool is_simulated = false;  ///< some were taken from a simulation
};

/// A quantity as people write it beside a gauge: "2.31 N", "235 gf", "1.2 kg" of hanging weight.
struct GaugeQuantity {
  double value = 0;  ///< N; of a command in percent, a share of the device's force
  std::string unit;  ///< as it was written
  bool is_share = false;
};

/// Reads a quantity with its unit. `unit`: the unit of a number without one; may be empty. Units of force: N, mN, gf,
/// kgf, lbf, ozf; of a weight that hangs on the handle: g and kg, by standard gravity; of a command also %. The error
/// (W0801) says what is wrong with the text and names no place.
Result<GaugeQuantity> read_gauge_quantity(std::string_view text, std::string_view unit, bool may_be_share);

/// Reads a table of readings from the bytes of a file: columns `axis` (x, y), `direction` (right, left, away, toward),
/// `command` and `reading`, and perhaps `repeat` (the round, from 1) and `grade` (measured, simulated). Each command
/// and reading has its unit, in its cell or in the header, as in `reading (N)`. `peak`: N, the device's force, for
/// commands in percent and as the greatest command.
///
/// Errors (W0801), with file and line: those of `analysis::read_table`; missing or unknown columns; an axis or a
/// direction that is none, or a direction of the other axis; words for numbers; missing, unknown or mixed units in one
/// column; a command below zero or above the device's force; the same command twice in one round; no reading at all.
Result<GaugeReadings> read_force_table(std::string file, std::string text, double peak);

/// The same readings as such a table, in N.
std::string force_table_text(std::span<const GaugeReading> readings, bool is_simulated);

}  // namespace wale
