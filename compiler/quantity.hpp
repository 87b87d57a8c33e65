#pragma once

#include <optional>
#include <string>

#include "compiler/declarations/declarations.hpp"
#include "schema/patch_program.hpp"
#include "schema/result.hpp"
#include "wale/program.hpp"

/// Reads quantities as people type them for an option, "5mm" or "10 mm, 5 mm", with the units of `known`. `option` is
/// its name, "--at". An error says what was typed, what was expected, and an example; its code is that of the same
/// mistake in a Wale file where the dimension, the unit or the size is wrong, and W0801 otherwise.
namespace wale {

/// A hand: position, and velocity where it is given: "10 mm, 5 mm[, 0.1 m/s, 0 m/s]".
Result<Hand> read_hand(const Declarations& known, const std::string& option, const std::string& text);

/// A largest force in N, above 0: "3 N".
Result<double> read_force(const Declarations& known, const std::string& option, const std::string& text);

/// A value for a parameter, in SI and in its range.
struct ParameterValue {
  float value = 0;
  std::optional<Error> unusual;  ///< a warning (W0308) where it is outside its usual (soft) range
};
/// "5mm" for a parameter in mm, typed for an option NAME=VALUE, "--set". The parameter's own unit is known even where
/// nothing else declares it.
Result<ParameterValue> read_parameter(const Declarations& known, const std::string& option, const Parameter& parameter,
                                      const std::string& text);

}  // namespace wale
