#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "compiler/prove/enclosure.hpp"
#include "schema/patch_program.hpp"

namespace wale {

/// A value of straight-line code: what a register holds before it, or a result of one of its instructions.
using ValueNumber = std::uint32_t;

/// What is known of the values of one run.
struct KnownRanges {
  std::span<const Enclosure> registers;  ///< those that the code does not write
  std::span<const Interval> results;     ///< three for each instruction that has been run

  const Interval& operator()(ValueNumber value) const {
    return value < registers.size() ? registers[value].range : results[value - registers.size()];
  }
};

/// How values of setup and tick hang together in ways that ranges of single registers do not show: which are lengths
/// of vectors, which quotients are guarded, what is divided and multiplied again, and how the two components of a force
/// come about.
///
/// A value r = sqrt(x x + y y + ..) is at least |x| but for a few roundings, so that x / r is within +-1 wherever r is
/// not zero; where squares are flushed to zero so is r, or it belongs to a larger component.
class Relations {
 public:
  /// Of the tick, and of the setup before it: its instructions have the first numbers.
  Relations(const PatchProgram& program, std::span<const Instruction> setup, std::span<const Instruction> tick);

  /// The value of a register when both have run.
  ValueNumber last(RegisterNumber number) const { return last_[number]; }
  std::size_t instructions() const { return operands_.size(); }

  /// What is known of the result of instruction `number` besides what its operands' ranges tell, a few roundings wider:
  /// a component over its length, where that is not zero, is within [-1, 1]; a fraction x - floor(x) within [0, 1], a
  /// remainder x - p floor(x / p) within [0, p], the smooth steps t t (3 - 2 t) and t t t (t (6 t - 15) + 10) of a t in
  /// [0, 1] within [0, 1]; a mixture a + t (b - a) between a and b; a vector's share in a direction within its length;
  /// g times what is limited to C / g within C.
  std::optional<Interval> bound(std::size_t number, const KnownRanges& known) const;
  /// For `select` instruction `number` whose condition compares the divisor of one of its choices with a bound: the
  /// range of that choice, 1 (b) or 2 (c), where it is taken.
  struct Guarded {
    int operand;
    Interval range;
  };
  std::optional<Guarded> guarded(std::size_t number, const KnownRanges& known) const;

  /// No vector of the values x and y is longer, not-a-number counting as 0. Follows how both are made in the same way:
  /// sums, scaled, chosen and limited vectors, unit vectors, and vectors whose length is limited.
  double length(ValueNumber x, ValueNumber y, const KnownRanges& known) const;

 private:
  struct Definition {
    Operation operation;
    std::array<ValueNumber, 3> operands;
  };
  const Definition* definition(ValueNumber value) const;
  const Definition* made_by(ValueNumber value, Operation operation) const;
  bool is_square_sum(ValueNumber sum, std::vector<ValueNumber>& components, int depth) const;
  /// The components of the vector whose length the value is; none when it is no length.
  std::vector<ValueNumber> components(ValueNumber length) const;
  bool is_length_of(ValueNumber length, ValueNumber component) const;
  std::optional<Interval> remainder(const Definition& difference, const KnownRanges& known) const;
  bool is_smooth_step(const Definition& product, const KnownRanges& known) const;
  bool is_smoother_step(const Definition& product, const KnownRanges& known) const;
  std::optional<ValueNumber> times(ValueNumber product, ValueNumber factor) const;
  std::optional<Interval> mixture(const Definition& sum, const KnownRanges& known) const;
  std::optional<Interval> scalar_product(const Definition& sum, const KnownRanges& known) const;
  bool is_turn(const Definition& a, const Definition& b, const KnownRanges& known) const;
  std::optional<double> cancelled(ValueNumber factor, ValueNumber quotient, const KnownRanges& known) const;
  Interval quotient_above(const Definition& quotient, float least, const KnownRanges& known) const;
  /// A vector no longer than the value `most`, a few roundings and `more`.
  struct Limited {
    ValueNumber most;
    double more;
    double length(const KnownRanges& known) const;
  };
  std::optional<Limited> limited(ValueNumber x, ValueNumber y, std::optional<ValueNumber> ceiling,
                                 const KnownRanges& known) const;
  std::optional<double> scaled_back(ValueNumber factor, ValueNumber x, ValueNumber y, const KnownRanges& known) const;
  double length(ValueNumber x, ValueNumber y, const KnownRanges& known, int depth, int& left) const;

  ValueNumber registers_;
  std::vector<Definition> operands_;
  std::vector<ValueNumber> last_;
  std::vector<float> constants_;
};

/// No vector of x and y is longer; rounded up.
double length_bound(const Interval& x, const Interval& y);

}  // namespace wale
