#pragma once

#include <array>

#include "compiler/prove/interval.hpp"

namespace wale {

/// The number of quantities in a first-order form; only the range is known of others.
inline constexpr std::size_t quantities_limit = 16;

/// The known facts about one register: an interval and, if that is finite, a first-order form in the quantities that
/// the program starts from. The form shows dependences between registers.
///
/// A value that is a number lies in `range` and equals `centre` + sum of slopes[i] e[i] + r. The e[i] in [-1, 1], one
/// for each quantity, are the same for all registers of one run; r is any number in [-rest, rest].
struct Enclosure {
  Interval range;
  double centre = 0, rest = 0;
  std::array<double, quantities_limit> slopes{};  ///< by quantity

  /// A value of which only the range is known.
  static Enclosure of(const Interval& range);
  /// Quantity number `index`, below `quantities_limit`, somewhere in `range`.
  static Enclosure quantity(const Interval& range, std::size_t index);

  /// Half the width of the form; infinity if the range is not finite.
  double radius() const;
};

/// The enclosure of an operation's result: the range of the instruction table and, for smooth operations and for those
/// that choose an operand, the form that follows from the operands. `same` says that a and b are one register. For
/// operations that read tables, grids or peaks it is the range of all floats.
Enclosure enclose(Operation operation, const Enclosure& a, const Enclosure& b, const Enclosure& c, bool same);

}  // namespace wale
