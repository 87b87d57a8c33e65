#pragma once

#include <sstream>
#include <string>

#include "schema/patch_program.hpp"

namespace wale {

/// One sentence of all `parts`.
template <typename... Parts>
std::string sentence(const Parts&... parts) {
  std::ostringstream text;
  (text << ... << parts);
  return text.str();
}

/// Ends reading or verifying with a sentence made of `parts`. Thrown and caught within one public function, which
/// returns the `Refusal`: callers never see the exception.
template <typename... Parts>
[[noreturn]] void refuse(const Parts&... parts) {
  throw Refusal{sentence(parts...), {}};
}

}  // namespace wale
