#pragma once

#if __cplusplus < 202002L
#error "the C++ headers of Wale need C++20: compile with -std=c++20, or use the C headers"
#endif

#include <optional>
#include <string>
#include <type_traits>
#include <utility>
#include <variant>
#include <vector>

#include "wale/code.hpp"

namespace wale {

/// Where something is wrong outside the text of a Wale file, or on the way to it.
struct Place {
  std::string name = {};  ///< of a file, an option, a packet's field or a section of a program; empty if there is none
  std::optional<std::size_t> number = {};  ///< of its row (from 1), byte or instruction (both from 0)
  std::string text = {};                   ///< the text at that place; may be empty
  std::string source = {};                 ///< the line that it was compiled from, "corduroy.wale:9"; may be empty
  std::optional<std::size_t> column = {};  ///< of a place in a Wale file, from 1, in characters; `number` is its row
  std::size_t length = 0;                  ///< bytes of the file from there on; 0 if that is not known
};

/// An error or a warning (`severity_of(code)`), as a value. Programs decide by `code`; `sentence` is for people and is
/// never searched. It does not repeat the name of `place`, which `in_words` puts before it.
struct Error {
  Code code = {};
  std::string sentence = {};              ///< what is wrong: "expected a number, found a vector"
  std::string mend = {};                  ///< what to do about it; may be empty
  Place place = {};                       ///< where
  std::vector<Place> led_to = {};         ///< its causes in their order: the instructions before a refused one
  std::string expected = {};              ///< what would be right, in a Wale file or as an argument; may be empty
  std::string found = {};                 ///< what the text or the argument has; may be empty
  std::vector<std::string> nearest = {};  ///< names that may have been meant by an unknown one, the nearest first
  std::vector<Error> others = {};  ///< the other errors and warnings of the same text, in the order of their places
};

/// The error in one line for a person, its place first: "my.wale:2:9: expected a number, found a vector; divide by …". A
/// mend may have lines to copy.
std::string in_words(const Error& error);

/// The error for a person in several lines: the line of `in_words`, then the causes, one per line.
std::string explained(const Error& error);

/// A value or an error: every function of this project that can fail returns one.
///
///     Result<Trace> trace = load_trace(file);
///     if (!trace) return trace.error();
///     use(*trace);
///
/// Where there is no value to give, `Result<>`: it holds either nothing or the error.
template <class Value = std::monostate>
class [[nodiscard]] Result {
 public:
  Result(Value value) : held_(std::in_place_index<0>, std::move(value)) {}
  Result(Error error) : held_(std::in_place_index<1>, std::move(error)) {}
  /// From anything that converts to a `Value`, as a `unique_ptr` to a derived class does to one to its base.
  template <class Other>
  requires(std::is_convertible_v<Other, Value> && !std::is_same_v<std::remove_cvref_t<Other>, Value> &&
           !std::is_same_v<std::remove_cvref_t<Other>, Error> && !std::is_same_v<std::remove_cvref_t<Other>, Result>)
      Result(Other&& other)
      : held_(std::in_place_index<0>, std::forward<Other>(other)) {}
  /// Success without a value.
  Result() requires std::is_same_v<Value, std::monostate> : held_(std::in_place_index<0>) {}

  bool has_value() const noexcept { return held_.index() == 0; }
  explicit operator bool() const noexcept { return has_value(); }

  /// The value. Call it only if `has_value()`.
  Value& operator*() & { return std::get<0>(held_); }
  const Value& operator*() const& { return std::get<0>(held_); }
  Value&& operator*() && { return std::get<0>(std::move(held_)); }
  Value* operator->() { return &std::get<0>(held_); }
  const Value* operator->() const { return &std::get<0>(held_); }

  /// The error. Call it only if not `has_value()`.
  Error& error() & { return std::get<1>(held_); }
  const Error& error() const& { return std::get<1>(held_); }
  Error&& error() && { return std::get<1>(std::move(held_)); }

 private:
  std::variant<Value, Error> held_;
};

}  // namespace wale
