#pragma once

#include <sstream>
#include <string>
#include <type_traits>

#include "schema/as_people_write.hpp"
#include "wale/result.hpp"

namespace wale {

/// A part of a sentence: quantities as people write them; counts of bytes, registers or instructions with their digits
/// together, since a programmer searches for them; anything else as it is.
template <typename Part>
decltype(auto) in_sentence(const Part& part) {
  if constexpr (std::is_arithmetic_v<Part> && !std::is_same_v<Part, bool> && !std::is_same_v<Part, char>) {
    std::ostringstream number;
    number << part;
    return as_people_write(number.str(), static_cast<double>(part),
                           std::is_integral_v<Part> ? Digits::together : Digits::grouped);
  } else {
    return (part);
  }
}

/// Joins all `parts`, each as a stream prints it.
template <typename... Parts>
std::string sentence(const Parts&... parts) {
  std::ostringstream text;
  (text << ... << in_sentence(parts));
  return text.str();
}

/// Ends reading or verifying with an error whose sentence is made of `parts`. It is thrown and caught within one public
/// function, which returns it: callers never see the exception.
template <typename... Parts>
[[noreturn]] void fail(Code code, const Parts&... parts) {
  throw Error{.code = code, .sentence = sentence(parts...)};
}

/// As `fail` with `damaged_file`.
template <typename... Parts>
[[noreturn]] void damaged(const Parts&... parts) {
  fail(Code::damaged_file, parts...);
}

}  // namespace wale
