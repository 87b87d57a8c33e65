#pragma once

#include <string>
#include <vector>

namespace wale {

/// How a quantity is written: shown = value * per_si, followed by `unit`.
struct Notation {
  std::string unit;   ///< "mm"; empty for a plain number
  double per_si = 1;  ///< 1000 for mm
};

/// The unit in which lengths (m), forces (N) or speeds (m/s) up to `largest` read well.
Notation length_notation(double largest);
Notation force_notation(double largest);
Notation speed_notation(double largest);

/// A mark on an axis: where, in shown units, and its label.
struct Tick {
  double at = 0;
  std::string label;
};

/// The largest of 1, 2, 5, 10, 20, 50, … (and their decimal fractions) that is no more than `most`.
double round_number(double most);
/// Round numbers within [low, high], about `count` of them.
std::vector<Tick> round_ticks(double low, double high, int count);

/// A number in three significant digits, without an exponent where it can be: "1.93", "0.0051", "120". A minus is a
/// minus, not a hyphen.
std::string shown_number(double value);
/// With its unit: "2.5 mm"; just the number where there is no unit.
std::string shown_quantity(double value, const Notation& notation);

}  // namespace wale
