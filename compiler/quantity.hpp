#pragma once

#include <optional>
#include <string>
#include <utility>

#include "compiler/declarations/declarations.hpp"
#include "wale/patch_program.hpp"
#include "wale/program.hpp"
#include "wale/result.hpp"

/// Reads quantities as people type them for an option, "5mm" or "10 mm, 5 mm", with the units of `known`. `option` is
/// its name, "--at". An error has the text, the expected value, and an example. If the dimension, the unit or the size
/// is wrong, its code is that of the same error in a Wale file; otherwise it is W0801.
namespace wale {

/// A hand: its position and optionally its velocity: "10 mm, 5 mm[, 0.1 m/s, 0 m/s]".
Result<Hand> read_hand(const Declarations& known, const std::string& option, const std::string& text);

/// A largest force in N, above 0: "3 N".
Result<double> read_force(const Declarations& known, const std::string& option, const std::string& text);
/// A length in m, above 0: "40 mm".
Result<double> read_length(const Declarations& known, const std::string& option, const std::string& text);
/// Two heights, the first below the second: "0 mm, 1 mm", or "0, 1" of a relief that is a plain number.
struct HeightsBetween {
  double low = 0, high = 0;  ///< m, or plain numbers
  bool is_length = true;
};
Result<HeightsBetween> read_heights_between(const Declarations& known, const std::string& option, const std::string& text);

/// A value for a parameter, in SI and in its range.
struct ParameterValue {
  float value = 0;
  std::optional<Error> unusual;  ///< a warning (W0308) if it is outside its usual (soft) range
};
/// The value of a parameter, "5mm", typed for an option NAME=VALUE, "--set". The parameter's own unit is known even if
/// `known` does not declare it.
Result<ParameterValue> read_parameter(const Declarations& known, const std::string& option, const Parameter& parameter,
                                      const std::string& text);

/// The same in SI, also where it is outside the parameter's range.
Result<double> read_parameter_anyway(const Declarations& known, const std::string& option, const Parameter& parameter,
                                     const std::string& text);

}  // namespace wale
