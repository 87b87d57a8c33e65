#pragma once

#include <array>
#include <bit>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace wale {

/// The exponents of a quantity's base dimensions, in the order of declaration. They are in twelfths, so that square,
/// cube and fourth roots of whole exponents are exact. A plain number has only zeros.
struct Dimension {
  static constexpr std::size_t capacity = 8;
  static constexpr int unit_exponent = 12;
  std::array<std::int16_t, capacity> twelfths{};

  bool plain() const { return *this == Dimension{}; }
  friend bool operator==(const Dimension& a, const Dimension& b) {
    const Words of_a = a.words(), of_b = b.words();
    return of_a[0] == of_b[0] && of_a[1] == of_b[1];
  }

 private:
  /// All exponents in two words, for fast comparison.
  using Words = std::array<std::uint64_t, 2>;
  Words words() const { return std::bit_cast<Words>(twelfths); }
};

inline Dimension operator*(Dimension a, const Dimension& b) {
  for (std::size_t i = 0; i < Dimension::capacity; ++i) a.twelfths[i] += b.twelfths[i];
  return a;
}
inline Dimension operator/(Dimension a, const Dimension& b) {
  for (std::size_t i = 0; i < Dimension::capacity; ++i) a.twelfths[i] -= b.twelfths[i];
  return a;
}
/// `a` to the power numerator / denominator; empty if an exponent is not a whole number of twelfths.
std::optional<Dimension> power(Dimension a, int numerator, int denominator = 1);

/// "a length", "an energy".
std::string with_article(const std::string& word);

/// The declared names of dimensions and their coherent units, to describe a dimension in words.
struct DimensionNames {
  struct Named {
    std::string name;
    Dimension dimension;
  };
  std::vector<std::string> base_units;  ///< "m", "kg", "s": one for each base dimension, in order
  std::vector<Named> dimensions;        ///< in the order of declaration; the first that fits names it
  std::vector<Named> units;             ///< units with factor 1

  /// "force", or the unit if it has no name; "a plain number" if it has no dimension.
  std::string words(const Dimension& dimension) const;
  /// The name of the dimension, if one was declared.
  std::optional<std::string> name(const Dimension& dimension) const;
  /// "N", "N/m", "kg m s^-2"; empty for a plain number.
  std::string unit(const Dimension& dimension) const;
  /// "kg m^2 s^-2"; "1" for a plain number.
  std::string factors(const Dimension& dimension) const;

  /// The unit of `found` in terms of that of `expected` if they differ by one factor ("N m" beside N), otherwise
  /// `unit`.
  std::string unit_beside(const Dimension& expected, const Dimension& found) const;

  /// "N    = kg m   s^-2" and "N m  = kg m^2 s^-2": two dimensions with their factors aligned.
  std::array<std::string, 2> side_by_side(const Dimension& expected, const Dimension& found) const;
};

}  // namespace wale
