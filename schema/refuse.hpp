#pragma once

#include <sstream>
#include <string>

#include "schema/patch_program.hpp"

namespace wale {

/// Ends reading or verifying with a sentence made of `parts`. Thrown and caught within one public function, which
/// returns the `Refusal`: callers never see the exception.
template <typename... Parts>
[[noreturn]] void refuse(const Parts&... parts) {
  std::ostringstream sentence;
  (sentence << ... << parts);
  throw Refusal{sentence.str()};
}

}  // namespace wale
