#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "compiler/text/source.hpp"
#include "schema/instruction.hpp"

namespace wale {

/// A checked expression is a graph of terms: dimensions have been checked and left behind, vectors have been taken
/// apart, functions inlined, names resolved; all values are in SI units. A `let` used twice is one term used twice.
using TermId = std::uint32_t;

enum class TermKind : std::uint8_t {
  literal,    ///< `value`
  input,      ///< `input`
  parameter,  ///< parameter number `index`
  open,       ///< a quantity left open, number `index`; `solve` settles it
  settled,    ///< what `a` is: what was open here
  magnitude,  ///< in a map's law: the perceived magnitude
  carrier,    ///< in a map's law: the size of the carrier
  state,      ///< state number `index` as it was when the tick began
  cells,      ///< how many columns (index 2 g) or rows (2 g + 1) memory number g has; `solve` settles it
  operation,  ///< `operation` of a, b, c as far as it takes operands; `sample` reads table number `index`, `recall` and
              ///< `cell` grid number `index`
  component,  ///< result `index` of the sample or recall `a`
  gradient,   ///< derivative of `a` along axis `index` (0 x, 1 y)
  peak,       ///< 99th percentile of `a` over the patch less its rim
};

/// The quantities that a term's value changes with, a bit each.
class Dependence {
 public:
  enum Cause : std::uint8_t {
    parameter = 1,
    position = 2,
    velocity = 4,
    open = 8,
    moment = 16,  ///< time, acceleration, the button, the hand's place on the workspace
    state = 32,   ///< states and memories
    table = 64,   ///< nothing by itself, but only the machine knows what is looked up
  };

  Dependence() = default;
  /// On one cause, or several joined by `|`.
  Dependence(int causes) : causes_(static_cast<std::uint8_t>(causes)) {}

  /// On any of them.
  bool on(int causes) const { return (causes_ & causes) != 0; }
  Dependence without(Cause cause) const { return causes_ & ~cause; }
  void operator|=(Dependence other) { causes_ |= other.causes_; }

  bool constant() const { return (causes_ & ~table) == 0; }
  /// Worked out of nothing but literals by operations whose results the compiler knows.
  bool known() const { return causes_ == 0; }
  bool in_tick() const { return on(position) || changing(); }
  /// Not the same at the same place: no height, and nothing to take a peak of.
  bool changing() const { return on(velocity | moment | state); }

 private:
  std::uint8_t causes_ = 0;
};

struct Term {
  TermKind kind = TermKind::literal;
  Operation operation = Operation::add;
  Dependence dependence;      ///< what `Terms::add` finds
  std::uint8_t operands = 0;  ///< how many of a, b, c it is worked out from, which `Terms::add` finds too
  TermId a = 0, b = 0, c = 0;
  double value = 0;  ///< of a literal; of an operation that is `known` what it comes to, which `Terms::add` finds
  std::uint32_t index = 0;
  Span span;

  Input input() const { return static_cast<Input>(index); }
  bool known() const { return dependence.known(); }
};

/// The terms of one material. Operands always stand before what uses them, so one pass in order reaches everything.
class Terms {
 public:
  const Term& operator[](TermId id) const { return terms_[id]; }
  std::size_t size() const { return terms_.size(); }
  /// Makes room for so many terms; there may be more.
  void reserve(std::size_t terms) { terms_.reserve(terms); }

  TermId add(const Term& term);
  TermId literal(double value, Span span = {});
  TermId input(Input input, Span span = {});
  TermId parameter(std::uint32_t index, Span span = {});
  TermId apply(Operation operation, TermId a, Span span = {});
  TermId apply(Operation operation, TermId a, TermId b, Span span = {});
  TermId apply(Operation operation, TermId a, TermId b, TermId c, Span span = {});

  Dependence dependence(TermId id) const { return terms_[id].dependence; }

  /// Adds all of the others as they are; gives by how much their numbers have grown.
  TermId append(const Terms& others);
  /// What was open, or a number of cells, is what `solution` is, which stands before it. What depends on it is still
  /// said to depend on something open.
  void settle(TermId open, TermId solution);

  /// From now on, what is added from another file than `place`'s, or from nowhere, is said to come from `place`: what a
  /// function of another file does belongs where the author calls it. Nothing: each term keeps its own span.
  void attribute(std::optional<Span> place) { place_ = place; }
  std::optional<Span> attributed() const { return place_; }

 private:
  void find_dependence(Term& term) const;
  TermId entered(Term& term);

  std::vector<Term> terms_;
  std::optional<Span> place_;
};

/// What an operation makes of numbers, in double precision; not-a-number where it takes something else.
double result_in_double(Operation operation, double a, double b, double c);

/// The terms that a term is worked out from: a, b, c as far as it has them.
struct TermOperands {
  std::array<TermId, 3> terms{};
  std::size_t count = 0;

  std::size_t size() const { return count; }
  TermId operator[](std::size_t i) const { return terms[i]; }
  const TermId* begin() const { return terms.data(); }
  const TermId* end() const { return terms.data() + count; }
};

inline TermOperands operands(const Term& term) { return {{term.a, term.b, term.c}, term.operands}; }

}  // namespace wale
