#pragma once

#include <algorithm>
#include <array>
#include <optional>
#include <string>
#include <string_view>
#include <unordered_map>
#include <vector>

#include "compiler/declarations/dimension.hpp"
#include "compiler/graph/term.hpp"

namespace wale {

/// A relation between quantities that is called like a function: a curve, a measured table, a relief, a memory.
struct Field {
  enum class Kind {
    curve,   ///< linear between knots, constant beyond the first and the last
    table,   ///< equally spaced samples from `first`, `step` apart; constant beyond both ends
    relief,  ///< a picture centred on the patch
    memory,  ///< a grid over the patch
  };
  Kind kind = Kind::curve;
  Dimension from, to;  ///< for a relief and a memory, `from` is length, and the argument is a place (a vector)
  std::vector<std::array<TermId, 2>> knots;
  std::uint32_t index = 0;       ///< of the table, or of the memory
  std::uint32_t samples = 0;     ///< of a table
  double first = 0, step = 0;    ///< of a table, SI
  double low = 0, span = 0;      ///< value at code 0, and its difference to the value at the highest code, SI
  double columns = 0, rows = 0;  ///< of a relief, in samples
  double column = 0, row = 0;    ///< spacing of samples, m
};

/// The value of an expression: its type, its dimension and the terms that compute it. Small and cheap to copy: texts
/// are in the syntax tree, fields in the `CallRecord` of the checker that made them.
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
  std::string_view text;
  const Field* field = nullptr;
  Span span;

  bool failed() const { return type == Type::failed; }
  /// One part of a vector, 'x' or 'y', as a number.
  Value part(char which) const {
    Value number = *this;
    number.type = Type::number;
    if (which == 'y') number.x = y;
    number.y = 0;
    return number;
  }
};

/// The value of an expression with an error that has been reported.
inline Value failed_value(Span span) { return {.type = Value::Type::failed, .span = span}; }

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

/// The local names that an expression may use. The names' texts are owned by others, mostly by the syntax tree.
class Scope {
 public:
  struct Binding {
    std::string_view name;
    Value value;
    Span declared;
    bool used = false;
  };

  bool hand = false;  ///< the names of the hand and the patch may be used

  /// The binding of a name, or null. Valid until the next name is declared.
  Binding* find(std::string_view name) {
    const std::size_t index = index_of(name);
    return index < bindings_.size() ? &bindings_[index] : nullptr;
  }
  const Binding* find(std::string_view name) const {
    const std::size_t index = index_of(name);
    return index < bindings_.size() ? &bindings_[index] : nullptr;
  }
  /// The binding of a name, which must exist.
  Binding& at(std::string_view name) { return bindings_.at(index_of(name)); }

  /// Adds a name, or replaces its binding.
  void declare(std::string_view name, const Value& value, Span declared) {
    if (Binding* known = find(name)) {
      *known = {name, value, declared};
      return;
    }
    bindings_.push_back({name, value, declared});
    if (bindings_.size() <= few) return;
    for (std::size_t i = places_.size(); i < bindings_.size(); ++i) places_.emplace(bindings_[i].name, i);
  }

  /// Removes all names, so that the scope can be reused.
  void clear() {
    bindings_.clear();
    places_.clear();
  }

  /// Reserves room for that many names.
  void reserve(std::size_t names) { bindings_.reserve(names); }

  /// All bindings, in the order of declaration.
  const std::vector<Binding>& bindings() const { return bindings_; }
  /// All names in alphabetical order.
  std::vector<std::string> spellings() const {
    std::vector<std::string> names;
    for (const Binding& binding : bindings_) names.emplace_back(binding.name);
    std::ranges::sort(names);
    return names;
  }

 private:
  /// Up to this many names, a linear search is faster than an index; most functions have no more.
  static constexpr std::size_t few = 8;

  std::size_t index_of(std::string_view name) const {
    if (bindings_.size() > few) {
      const auto place = places_.find(name);
      return place == places_.end() ? bindings_.size() : place->second;
    }
    const auto found = std::ranges::find(bindings_, name, &Binding::name);
    return static_cast<std::size_t>(found - bindings_.begin());
  }

  std::vector<Binding> bindings_;
  std::unordered_map<std::string_view, std::size_t>
      places_;  ///< indices into `bindings_`; used with more than `few` names
};

/// The size argument at one call of a force function, fixed or left open: "lateral amplitude".
struct Carrier {
  std::string name;  ///< function and argument
  TermId size = 0;   ///< the argument's term
  bool open = false;
  Dimension dimension;
  TermId force_x = 0, force_y = 0;  ///< the call's result
  std::optional<TermId> relief;     ///< the call's argument `height`
  Dimension relief_dimension;
  Span span;       ///< of the call
  Span size_span;  ///< of the argument, where it is given
};

}  // namespace wale
