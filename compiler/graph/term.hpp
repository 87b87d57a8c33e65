#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "compiler/text/source.hpp"
#include "wale/instruction.hpp"

namespace wale {

/// A checked expression is a graph of terms. Dimensions have been checked and dropped, vectors split into their parts,
/// functions inlined, names resolved; all values are in SI units. A `let` that is used twice is one term with two
/// users.
using TermId = std::uint32_t;

enum class TermKind : std::uint8_t {
  literal,    ///< `value`
  input,      ///< `input`
  parameter,  ///< parameter number `index`
  open,       ///< open quantity number `index`; `solve` settles it
  settled,    ///< the value of `a`; this term was open
  magnitude,  ///< in a map's law: the perceived magnitude
  carrier,    ///< in a map's law: the size of the carrier
  state,      ///< state number `index` at the beginning of the tick
  cells,      ///< number of columns (index 2 g) or rows (2 g + 1) of memory number g; `solve` settles it
  operation,  ///< `operation` on as many of a, b, c as it takes; `sample` reads table number `index`, `recall` and
              ///< `cell` grid number `index`
  component,  ///< result `index` of the sample or recall `a`
  gradient,   ///< derivative of `a` along axis `index` (0 x, 1 y)
  peak,       ///< 99th percentile of `a` over the patch less its rim
};

/// The quantities with which a term's value changes, one bit each.
class Dependence {
 public:
  enum Cause : std::uint8_t {
    parameter = 1,
    position = 2,
    velocity = 4,
    open = 8,
    moment = 16,  ///< time, acceleration, the button, the hand's place on the workspace
    state = 32,   ///< states and memories
    table = 64,   ///< a look-up: constant, but the compiler cannot evaluate it
  };

  Dependence() = default;
  /// Dependence on one cause, or on several joined by `|`.
  Dependence(int causes) : causes_(static_cast<std::uint8_t>(causes)) {}

  /// Whether it depends on any of these causes.
  bool on(int causes) const { return (causes_ & causes) != 0; }
  Dependence without(Cause cause) const { return causes_ & ~cause; }
  void operator|=(Dependence other) { causes_ |= other.causes_; }

  bool constant() const { return (causes_ & ~table) == 0; }
  /// Whether it is computed only from literals, by operations that the compiler can evaluate.
  bool known() const { return causes_ == 0; }
  bool in_tick() const { return on(position) || changing(); }
  /// Whether its value at one place may change, so that it is neither a height nor an argument of `peak`.
  bool changing() const { return on(velocity | moment | state); }

 private:
  std::uint8_t causes_ = 0;
};

struct Term {
  TermKind kind = TermKind::literal;
  Operation operation = Operation::add;
  Dependence dependence;      ///< filled in by `Terms::add`
  std::uint8_t operands = 0;  ///< how many of a, b, c it uses; filled in by `Terms::add`
  TermId a = 0, b = 0, c = 0;
  double value = 0;  ///< of a literal, or of a `known` operation; the latter is filled in by `Terms::add`
  std::uint32_t index = 0;
  Span span;

  Input input() const { return static_cast<Input>(index); }
  bool known() const { return dependence.known(); }
};

/// The terms of one material. Operands always precede their users, so one pass in order suffices.
class Terms {
 public:
  const Term& operator[](TermId id) const { return terms_[id]; }
  std::size_t size() const { return terms_.size(); }
  /// Reserves room for that many terms.
  void reserve(std::size_t terms) { terms_.reserve(terms); }

  TermId add(const Term& term);
  TermId literal(double value, Span span = {});
  TermId input(Input input, Span span = {});
  TermId parameter(std::uint32_t index, Span span = {});
  TermId apply(Operation operation, TermId a, Span span = {});
  TermId apply(Operation operation, TermId a, TermId b, Span span = {});
  TermId apply(Operation operation, TermId a, TermId b, TermId c, Span span = {});

  Dependence dependence(TermId id) const { return terms_[id].dependence; }

  /// Appends all terms of `others`; returns the offset of their new numbers.
  TermId append(const Terms& others);
  /// Gives an open quantity, or a number of cells, the value of `solution`, an earlier term. Terms that use it keep the
  /// dependence on an open quantity.
  void settle(TermId open, TermId solution);

  /// From now on, terms from another file than that of `place`, or without a file, are attributed to `place`: the terms
  /// of a function of another file belong to the author's call. With nothing, each term keeps its own span.
  void attribute(std::optional<Span> place) { place_ = place; }
  std::optional<Span> attributed() const { return place_; }

 private:
  void find_dependence(Term& term) const;
  TermId entered(Term& term);

  std::vector<Term> terms_;
  std::optional<Span> place_;
};

/// The result of an operation on numbers in double precision; not-a-number for an operation that needs more than
/// numbers.
double result_in_double(Operation operation, double a, double b, double c);

/// The operands of a term: as many of a, b, c as it uses.
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
