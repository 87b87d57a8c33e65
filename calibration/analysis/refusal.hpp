#pragma once

#include <string>
#include <utility>

#include "wale/result.hpp"

namespace wale::analysis {

/// Why an analysis cannot be made, and what helps. It has no place: trials, not a text, are at fault.
inline Error refusal(Code code, std::string sentence, std::string mend) {
  return Error{.code = code, .sentence = std::move(sentence), .mend = std::move(mend)};
}

/// The same of what the trials do not hold.
inline Error refusal(std::string sentence, std::string mend) {
  return refusal(Code::not_measured, std::move(sentence), std::move(mend));
}

}  // namespace wale::analysis
