#pragma once

#include <sstream>
#include <string>

#include "schema/result.hpp"

namespace wale {

/// Joins all `parts`, each as a stream prints it.
template <typename... Parts>
std::string sentence(const Parts&... parts) {
  std::ostringstream text;
  (text << ... << parts);
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
