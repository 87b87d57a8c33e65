#pragma once

#include <optional>
#include <vector>

#include "compiler/declarations/percepts.hpp"
#include "compiler/solve/isolate.hpp"

namespace wale {

/// A map's law, both ways: the magnitude of a carrier, the level of a carrier, the carrier of a level; as expressions
/// and as numbers.
///
/// A law is an equation in which magnitude and carrier each stand once, or where the carrier makes a polynomial of at
/// most the second degree in one function of itself (quadratic in logarithms), or a table. What it couples are sizes in
/// the map's order; those that are left out are 0, as they are in the reference stimulus.
class Law {
 public:
  Law(const Map& map, const Percept& percept);

  using Sizes = std::vector<TermId>;

  std::optional<TermId> magnitude(Terms& terms, TermId carrier, const Sizes& couples = {}) const;
  /// The magnitude over that of the reference stimulus.
  std::optional<TermId> level(Terms& terms, TermId carrier, const Sizes& couples = {}) const;
  std::optional<TermId> level_of_magnitude(Terms& terms, TermId magnitude) const;
  /// Nothing where the law cannot be solved for its carrier. Beyond a quadratic's vertex: the carrier at the vertex.
  std::optional<TermId> carrier(Terms& terms, TermId level, const Sizes& couples = {}) const;

  /// Whether it can be solved for its carrier.
  bool has_inverse() const;

  /// The same as numbers; not-a-number where there is none.
  double level_of(double carrier, const std::vector<double>& couples = {}) const;
  double magnitude_of(double carrier, const std::vector<double>& couples = {}) const;
  double carrier_of(double level, const std::vector<double>& couples = {}) const;
  /// d log(magnitude) / d log(carrier): a power law's exponent, another's at that size.
  double exponent_at(double carrier) const;
  /// Whether a carrier of that level has it, to 1e-6: not so above a vertex, or where the law would have less than
  /// nothing.
  bool reaches(double level, const std::vector<double>& couples = {}) const;

 private:
  /// How many sides of a vertex the carriers lie on that were measured.
  enum class Way { rising, falling, both };

  /// The law solved for the quantity that `counts` is of, which stands in it once: of the `given` one, magnitude or
  /// carrier, as terms and as a number.
  std::optional<TermId> solved_for(const Occurrences& counts, Terms& terms, TermId given, const Sizes& couples) const;
  double solved_for(const Occurrences& counts, double given, const std::vector<double>& couples) const;
  bool stands_alone(const Occurrences& counts) const;

  Way way_within_range() const;
  /// The magnitude of a carrier by the table, or the carrier of a magnitude.
  std::optional<TermId> looked_up(Terms& terms, TermId value, bool inverse) const;
  std::optional<TermId> solved_quadratic(Terms& terms, TermId left, TermId right, TermId unknown) const;

  const Map& map_;
  const Percept& percept_;
  Occurrences of_magnitude_, of_carrier_;  ///< in the map's terms
  bool magnitude_stands_alone_ = false, carrier_stands_alone_ = false;
  bool upper_root_ = true;  ///< of a quadratic: the one with the square root added
  /// The magnitude of the reference stimulus, where the magnitude stands alone: levels are told by it again and again.
  double magnitude_of_one_ = 0;
};

}  // namespace wale
