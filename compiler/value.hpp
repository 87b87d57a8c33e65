#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "compiler/dimension.hpp"
#include "compiler/term.hpp"

namespace wale {

/// What an expression is worth: its type, its dimension and the terms that compute it.
struct Value {
  enum class Type {
    number,   ///< `x`
    vector,   ///< `x` and `y`, of one dimension
    boolean,  ///< `x`, 1 or 0
    text,
    open,    ///< the word `open`: to be solved
    failed,  ///< already reported
  };
  Type type = Type::failed;
  TermId x = 0, y = 0;
  Dimension dimension;
  std::string text;
  Span span;

  bool failed() const { return type == Type::failed; }
};

inline std::string type_words(Value::Type type) {
  switch (type) {
    case Value::Type::number: return "a number";
    case Value::Type::vector: return "a vector";
    case Value::Type::boolean: return "a condition";
    case Value::Type::text: return "a text";
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
};

/// A force algorithm's size, fixed or left open, at one of its calls: "lateral amplitude".
struct Carrier {
  std::string name;  ///< function and argument
  TermId size = 0;   ///< the argument's term
  bool open = false;
  Dimension dimension;
  TermId force_x = 0, force_y = 0;  ///< the call's result
  std::optional<TermId> relief;     ///< its argument `height`
  Span span;                        ///< of the call
};

}  // namespace wale
