#pragma once

#include <cstdint>
#include <vector>

#include "compiler/source.hpp"
#include "schema/instruction.hpp"

namespace wale {

/// A checked expression is a graph of terms: dimensions have been checked and left behind, vectors have been taken
/// apart, functions inlined, names resolved; all values are in SI units. A `let` used twice is one term used twice.
using TermId = std::uint32_t;

enum class TermKind : std::uint8_t {
  literal,    ///< `value`
  input,      ///< `input`
  parameter,  ///< parameter number `index`
  open,       ///< a quantity left open, number `index`; `solve` replaces it
  magnitude,  ///< in a map's law: the perceived magnitude
  carrier,    ///< in a map's law: the size of the carrier
  operation,  ///< `operation` of a, b, c as far as it takes operands; `sample` reads table number `index`
  component,  ///< result `index` of the sample `a`
  gradient,   ///< derivative of `a` along axis `index` (0 x, 1 y)
  peak,       ///< 99th percentile of `a` over the patch less its rim
};

struct Term {
  TermKind kind = TermKind::literal;
  Operation operation = Operation::add;
  TermId a = 0, b = 0, c = 0;
  double value = 0;
  std::uint32_t index = 0;
  Span span;

  Input input() const { return static_cast<Input>(index); }
};

/// What a term's value changes with.
struct Dependence {
  bool parameter = false, position = false, velocity = false, open = false;
  bool constant() const { return !parameter && !position && !velocity && !open; }
};

/// The terms of one material. Operands always stand before what uses them, so one pass in order reaches everything.
class Terms {
 public:
  const Term& operator[](TermId id) const { return terms_[id]; }
  std::size_t size() const { return terms_.size(); }

  TermId add(const Term& term);
  TermId literal(double value, Span span = {});
  TermId input(Input input, Span span = {});
  TermId parameter(std::uint32_t index, Span span = {});
  TermId apply(Operation operation, TermId a, Span span = {});
  TermId apply(Operation operation, TermId a, TermId b, Span span = {});
  TermId apply(Operation operation, TermId a, TermId b, TermId c, Span span = {});

  Dependence dependence(TermId id) const { return dependences_[id]; }

 private:
  std::vector<Term> terms_;
  std::vector<Dependence> dependences_;
};

/// How many operands an operation reads from registers.
int operand_count(Operation operation);

}  // namespace wale
