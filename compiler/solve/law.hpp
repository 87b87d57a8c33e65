#pragma once

#include <optional>
#include <vector>

#include "compiler/declarations/percepts.hpp"
#include "compiler/solve/isolate.hpp"

namespace wale {

/// A map's law in both directions: from a carrier's size (SI) to its magnitude or level, and from a level to the
/// carrier's size; as expressions and as numbers.
///
/// A law is a table or an equation. In the equation, magnitude and carrier each occur once, or the carrier occurs in a
/// polynomial of degree 2 or less in one function of it (such as a quadratic in logarithms). `couples` are the sizes of
/// the coupled carriers in the map's order, SI; missing ones are 0, as in the reference stimulus.
class Law {
 public:
  Law(const Map& map, const Percept& percept);

  using Sizes = std::vector<TermId>;

  std::optional<TermId> magnitude(Terms& terms, TermId carrier, const Sizes& couples = {}) const;
  /// The level: the magnitude divided by that of the reference stimulus.
  std::optional<TermId> level(Terms& terms, TermId carrier, const Sizes& couples = {}) const;
  std::optional<TermId> level_of_magnitude(Terms& terms, TermId magnitude) const;
  /// The carrier's size. Empty if the law cannot be solved for its carrier. Beyond a quadratic's vertex: its value
  /// there.
  std::optional<TermId> carrier(Terms& terms, TermId level, const Sizes& couples = {}) const;

  /// Whether the law can be solved for its carrier.
  bool has_inverse() const;

  /// The same as numbers; not-a-number if there is no value.
  double level_of(double carrier, const std::vector<double>& couples = {}) const;
  double magnitude_of(double carrier, const std::vector<double>& couples = {}) const;
  double carrier_of(double level, const std::vector<double>& couples = {}) const;
  /// d log(magnitude) / d log(carrier) at that size; for a power law, its exponent.
  double exponent_at(double carrier) const;
  /// Whether some carrier has that level, to 1e-6: false above a vertex, or if the carrier's size would be negative.
  bool reaches(double level, const std::vector<double>& couples = {}) const;

 private:
  /// On which sides of a vertex the measured carriers lie.
  enum class Way { rising, falling, both };

  /// Solves the law for the quantity of `counts`, which occurs in it once. `given` is the other one of magnitude and
  /// carrier. As terms and as a number.
  std::optional<TermId> solved_for(const Occurrences& counts, Terms& terms, TermId given, const Sizes& couples) const;
  double solved_for(const Occurrences& counts, double given, const std::vector<double>& couples) const;
  bool stands_alone(const Occurrences& counts) const;

  Way way_within_range() const;
  /// Looks up the magnitude of a carrier in the table; if `inverse`, the carrier of a magnitude.
  std::optional<TermId> looked_up(Terms& terms, TermId value, bool inverse) const;
  std::optional<TermId> solved_quadratic(Terms& terms, TermId left, TermId right, TermId unknown) const;

  const Map& map_;
  const Percept& percept_;
  Occurrences of_magnitude_, of_carrier_;  ///< their occurrences in the map's terms
  bool magnitude_stands_alone_ = false, carrier_stands_alone_ = false;
  bool upper_root_ = true;  ///< for a quadratic: the root with the square root added
  /// The magnitude of the reference stimulus, cached if the law gives the magnitude explicitly.
  double magnitude_of_one_ = 0;
};

}  // namespace wale
