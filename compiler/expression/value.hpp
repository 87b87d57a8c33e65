#pragma once

#include <array>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "compiler/declarations/dimension.hpp"
#include "compiler/graph/term.hpp"

namespace wale {

/// A relation between quantities that is called like a function: a curve, a measured table, a relief, a memory.
struct Field {
  enum class Kind {
    curve,   ///< straight from knot to knot, level beyond the first and the last
    table,   ///< equally spaced samples from `first` on, `step` apart, held at both ends
    relief,  ///< a picture centred on the patch
    memory,  ///< a grid over the patch
  };
  Kind kind = Kind::curve;
  Dimension from, to;  ///< of a relief and of a memory, `from` is a length: they take a place
  std::vector<std::array<TermId, 2>> knots;
  std::uint32_t index = 0;       ///< of the table, or of the memory
  std::uint32_t samples = 0;     ///< of a table
  double first = 0, step = 0;    ///< of a table, SI
  double low = 0, span = 0;      ///< value at code 0, and from there to the highest code, SI
  double columns = 0, rows = 0;  ///< of a relief, in samples
  double column = 0, row = 0;    ///< m from sample to sample
};

/// What an expression is worth: its type, its dimension and the terms that compute it.
struct Value {
  enum class Type {
    number,   ///< `x`
    vector,   ///< `x` and `y`, of one dimension
    boolean,  ///< `x`, 1 or 0
    text,
    field,   ///< `field`
    open,    ///< the word `open`: to be solved
    failed,  ///< already reported
  };
  Type type = Type::failed;
  TermId x = 0, y = 0;
  Dimension dimension;
  std::string text;
  std::shared_ptr<const Field> field;
  Span span;

  bool failed() const { return type == Type::failed; }
};

inline std::string type_words(Value::Type type) {
  switch (type) {
    case Value::Type::number: return "a number";
    case Value::Type::vector: return "a vector";
    case Value::Type::boolean: return "a condition";
    case Value::Type::text: return "a text";
    case Value::Type::field: return "a curve or map";
    case Value::Type::open: return "`open`";
    case Value::Type::failed: break;
  }
  return "nothing";
}

/// The names that an expression may use besides what is declared outside it.
struct Scope {
  struct Binding {
    Value value;
    Span declared;
    std::string unit;  ///< the unit its author wrote, to speak of it
    bool used = false;
  };
  std::map<std::string, Binding, std::less<>> names;
  bool hand = false;  ///< position, velocity and the patch may be used

  Binding* find(const std::string& name) {
    const auto found = names.find(name);
    return found == names.end() ? nullptr : &found->second;
  }
  const Binding* find(const std::string& name) const {
    const auto found = names.find(name);
    return found == names.end() ? nullptr : &found->second;
  }
};

/// A force algorithm's size, fixed or left open, at one of its calls: "lateral amplitude".
struct Carrier {
  std::string name;  ///< function and argument
  TermId size = 0;   ///< the argument's term
  bool open = false;
  Dimension dimension;
  TermId force_x = 0, force_y = 0;  ///< the call's result
  std::optional<TermId> relief;     ///< its argument `height`
  Dimension relief_dimension;
  Span span;       ///< of the call
  Span size_span;  ///< of the argument, where it is given
};

}  // namespace wale
