#pragma once

#include <string>
#include <vector>

namespace wale {

/// How a quantity is written: shown = value * per_si, followed by `unit`.
struct Notation {
  std::string unit;   ///< "mm"; empty for a plain number
  double per_si = 1;  ///< 1000 for mm
};

/// The unit in which lengths (m), forces (N) or speeds (m/s) up to `largest` have few digits.
Notation length_notation(double largest);
Notation force_notation(double largest);
Notation speed_notation(double largest);

/// A mark on an axis: its position in shown units, and its label.
struct Tick {
  double at = 0;
  std::string label;
};

/// The largest of 1, 2, 5, 10, 20, 50, … (and their decimal fractions) that is not above `most`.
double round_number(double most);
/// Round numbers within [low, high], about `count` of them.
std::vector<Tick> round_ticks(double low, double high, int count);

/// A number with three significant digits, without an exponent if possible: "1.93", "0.0051", "120". A negative number
/// has a minus sign, not a hyphen.
std::string shown_number(double value);
/// The same with its unit: "2.5 mm"; only the number if there is no unit.
std::string shown_quantity(double value, const Notation& notation);

}  // namespace wale
