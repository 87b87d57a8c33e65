#pragma once

#include <cmath>
#include <cstdint>
#include <limits>
#include <string>

#include "wale/result.hpp"

/// Reads plain numbers as people type them for an option. `option` is its name, "--steps". An error (W0801) has the
/// text, the expected value, and an example. Empty texts, letters after the number, digits of other scripts,
/// hexadecimal digits and not-a-number are refused.
namespace wale {

/// The whole numbers that an option accepts.
struct CountRange {
  std::uint64_t least = 0, most = std::numeric_limits<std::uint64_t>::max();
  std::uint64_t example = 12;
};
Result<std::uint64_t> read_count(const std::string& option, const std::string& text, const CountRange& range = {});

/// The finite numbers that an option accepts, from `least` to `most`.
struct NumberRange {
  double least = -HUGE_VAL, most = HUGE_VAL;
  bool above_least = false;  ///< `least` itself is refused
  double example = 0.5;
};
Result<double> read_number(const std::string& option, const std::string& text, const NumberRange& range = {});

/// The durations that an option accepts, in s, all above 0.
struct DurationRange {
  double most = HUGE_VAL;
  bool endless = false;  ///< "inf" is accepted and means without a limit
  double example = 5;
};
/// A duration in s: "5", "5 s", "200 ms", "2 min", "1 h".
Result<double> read_duration(const std::string& option, const std::string& text, const DurationRange& range = {});

/// `found "5x"`, or `found nothing`: the part of such an error that quotes the text.
std::string found_typed(const std::string& text);

}  // namespace wale
