#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "compiler/prove/enclosure.hpp"
#include "wale/patch_program.hpp"

namespace wale {

/// A value of straight-line code: the content of a register before it, or a result of one of its instructions.
using ValueNumber = std::uint32_t;

/// The known ranges of the values in one run.
struct KnownRanges {
  std::span<const Enclosure> registers;  ///< the registers that the code does not write
  std::span<const Interval> results;     ///< three for each instruction that has been run

  const Interval& operator()(ValueNumber value) const {
    return value < registers.size() ? registers[value].range : results[value - registers.size()];
  }
};

/// Relations of values in setup and tick that the ranges of single registers do not show: lengths of vectors, guarded
/// quotients, divisions followed by multiplications, and the two components of a force.
///
/// A value r = sqrt(x x + y y + ..) is at least |x| apart from a few roundings, so x / r is within +-1 if r is not
/// zero. If squares are flushed to zero, r is zero too, or belongs to a larger component.
class Relations {
 public:
  /// For the tick and the setup before it; the instructions of setup have the first numbers.
  Relations(const PatchProgram& program, std::span<const Instruction> setup, std::span<const Instruction> tick);

  /// The value of a register when both have run.
  ValueNumber last(RegisterNumber number) const { return last_[number]; }
  std::size_t instructions() const { return operands_.size(); }

  /// A range for the result of instruction `number` beyond the ranges of its operands, a few roundings wider. A
  /// component over its length, if not zero, is within [-1, 1]; a fraction x - floor(x) within [0, 1]; a remainder x -
  /// p floor(x / p) within [0, p]; the smooth steps t t (3 - 2 t) and t t t (t (6 t - 15) + 10) of a t in [0, 1] within
  /// [0, 1]; a term's share in a sum of terms that are not negative within [0, 1]; a mixture a + t (b - a) between a
  /// and b; the component of a vector in a direction within its length; g times a value limited to C / g within C.
  std::optional<Interval> bound(std::size_t number, const KnownRanges& known) const;
  /// For the `select` instruction `number` with a condition that compares the divisor of one of its choices with a
  /// bound: the range of that choice, 1 (b) or 2 (c), when it is taken.
  struct Guarded {
    int operand;
    Interval range;
  };
  std::optional<Guarded> guarded(std::size_t number, const KnownRanges& known) const;

  /// An upper bound of the length of the vector (x, y), with not-a-number as 0. It follows how both are computed in the
  /// same way: sums; scaled, chosen and limited vectors; unit vectors; and vectors whose length is limited.
  double length(ValueNumber x, ValueNumber y, const KnownRanges& known) const;

 private:
  struct Definition {
    Operation operation;
    std::array<ValueNumber, 3> operands;
  };
  const Definition* definition(ValueNumber value) const;
  const Definition* made_by(ValueNumber value, Operation operation) const;
  bool is_square_sum(ValueNumber sum, std::vector<ValueNumber>& components, int depth) const;
  /// The components of the vector whose length the value is; none if it is not a length.
  std::vector<ValueNumber> components(ValueNumber length) const;
  bool is_length_of(ValueNumber length, ValueNumber component) const;
  std::optional<Interval> remainder(const Definition& difference, const KnownRanges& known) const;
  bool is_share(const Definition& quotient, const KnownRanges& known) const;
  bool is_smooth_step(const Definition& product, const KnownRanges& known) const;
  bool is_smoother_step(const Definition& product, const KnownRanges& known) const;
  std::optional<ValueNumber> times(ValueNumber product, ValueNumber factor) const;
  std::optional<Interval> mixture(const Definition& sum, const KnownRanges& known) const;
  std::optional<Interval> scalar_product(const Definition& sum, const KnownRanges& known) const;
  bool is_turn(const Definition& a, const Definition& b, const KnownRanges& known) const;
  std::optional<double> cancelled(ValueNumber factor, ValueNumber quotient, const KnownRanges& known) const;
  Interval quotient_above(const Definition& quotient, float least, const KnownRanges& known) const;
  /// A vector whose length is at most the value `most`, plus a few roundings and `more`.
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

/// The length of the vector (x, y), rounded up.
double length_bound(const Interval& x, const Interval& y);

}  // namespace wale
