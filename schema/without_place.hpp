#pragma once

#include <string>

#include "wale/result.hpp"

namespace wale {

/// As `in_words`, without the error's place: for a sentence that says the place itself.
std::string in_words_without_place(const Error& error);

}  // namespace wale
