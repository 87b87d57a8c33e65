#pragma once

#include <string>
#include <utility>

#include "wale/result.hpp"

namespace wale::command {

/// An option that does not fit the others or the files: its name is the error's place.
inline Error misused_option(const char* option, std::string sentence, std::string mend) {
  return {.code = Code::malformed_value, .sentence = std::move(sentence), .mend = std::move(mend), .place = {.name = option}};
}

}  // namespace wale::command
