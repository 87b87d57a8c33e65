#pragma once

#include <array>

#include "compiler/prove/interval.hpp"

namespace wale {

/// Quantities that a first-order form can tell apart; of others only the range is known.
inline constexpr std::size_t quantities_limit = 16;

/// What is known of one register: an interval and, where that is finite, a first-order form of the quantities that the
/// program starts from, which knows what registers have in common.
///
/// A value that is a number lies in `range` and is `centre` + sum of slopes[i] e[i] + r, where the e[i] in [-1, 1] are
/// the same for all registers of one run, one for each quantity, and r in [-rest, rest] is anything.
struct Enclosure {
  Interval range;
  double centre = 0, rest = 0;
  std::array<double, quantities_limit> slopes{};  ///< by quantity

  /// A value of which nothing but its range is known.
  static Enclosure of(const Interval& range);
  /// Quantity number `index`, below `quantities_limit`, somewhere in `range`.
  static Enclosure quantity(const Interval& range, std::size_t index);

  /// Half the width of the form; infinity where the range is not finite.
  double radius() const;
};

/// The enclosure of an operation's result: the instruction table's range and, for operations that are smooth or that
/// merely choose one of their operands, what the forms of the operands leave of it. `same` says that a and b are one
/// register. Of operations that read tables, grids or peaks only the range, everything.
Enclosure enclose(Operation operation, const Enclosure& a, const Enclosure& b, const Enclosure& c, bool same);

}  // namespace wale
