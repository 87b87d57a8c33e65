#pragma once

#include <string>
#include <string_view>

namespace wale {

/// How the digits before a point stand: in groups of three from five on, "32 767", or together, as a machine reads
/// them.
enum class Digits { grouped, together };

/// The text of a number without an exponent, if its size is 1e-6 or more and less than 1e15: a whole number with all
/// its digits, another with those of `text`. Blanks around the number stay as far as the groups leave room, so that
/// columns stay aligned.
std::string as_people_write(std::string_view text, double value, Digits digits = Digits::grouped);

}  // namespace wale
