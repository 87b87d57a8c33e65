#pragma once

#include <cmath>
#include <cstdint>
#include <limits>
#include <string>

#include "schema/result.hpp"

/// Reads plain numbers as people type them for an option. `option` is its name, "--steps"; an error (W0801) says what
/// was typed for it, what was expected, and an example. Nothing, letters behind the number, another script's digits,
/// hexadecimal digits and not-a-number are refused.
namespace wale {

/// The whole numbers that an option takes.
struct CountRange {
  std::uint64_t least = 0, most = std::numeric_limits<std::uint64_t>::max();
  std::uint64_t example = 12;
};
Result<std::uint64_t> read_count(const std::string& option, const std::string& text, const CountRange& range = {});

/// The finite numbers that an option takes, from `least` to `most`.
struct NumberRange {
  double least = -HUGE_VAL, most = HUGE_VAL;
  bool above_least = false;  ///< `least` itself is refused
  double example = 0.5;
};
Result<double> read_number(const std::string& option, const std::string& text, const NumberRange& range = {});

/// The durations that an option takes, in s, all above 0.
struct DurationRange {
  double most = HUGE_VAL;
  bool endless = false;  ///< "inf" is one of them, and means until something else ends it
  double example = 5;
};
/// A duration in s: "5", "5 s", "200 ms", "2 min", "1 h".
Result<double> read_duration(const std::string& option, const std::string& text, const DurationRange& range = {});

/// `found "5x"`, or `found nothing`: how such an error names what was typed.
std::string found_typed(const std::string& text);

}  // namespace wale
