#pragma once

#include <string>
#include <string_view>

#include "wale/result.hpp"

namespace wale {

/// What a sentence says was expected and found: "expected a number, found a text, which …" has "a number" and "a text".
/// Parts that it does not say are empty.
struct Expectation {
  std::string expected, found;
};
Expectation expectation_in(std::string_view sentence);

/// The error with `expected` and `found` by its sentence, where nobody has filled either.
Error with_expectation(Error error);

/// The text in one line, with one space where it has several: as a program shows it, and not a table.
std::string in_one_line(std::string_view text);

}  // namespace wale
