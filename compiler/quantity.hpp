#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "compiler/check/check.hpp"
#include "schema/patch_program.hpp"
#include "wale/program.hpp"

namespace wale {

/// Reads quantities as people type them on a command line, "5mm" or "10 mm, 5 mm", with the units of the language.
///
/// What is wrong is reported with its place in the typed text; `option` names where it was typed, "--at".
class QuantityReader {
 public:
  QuantityReader();

  /// A hand: position, and velocity where it is given: "10 mm, 5 mm[, 0.1 m/s, 0 m/s]".
  std::optional<Hand> hand(const std::string& option, const std::string& text);

  /// A largest force, N: "3 N"; more than nothing.
  std::optional<double> force(const std::string& option, const std::string& text);

  /// A value for a parameter, in SI and in its range: "5mm" for one in mm. Its own unit is known even where nothing
  /// else declares it. One outside its usual (soft) range is a warning.
  std::optional<float> parameter(const std::string& option, const Parameter& parameter, const std::string& text);

  const SourceSet& sources() const { return sources_; }
  const Diagnostics& diagnostics() const { return diagnostics_; }

 private:
  std::optional<std::vector<double>> list(const std::string& option, const std::string& text,
                                          const std::vector<Dimension>& dimensions, std::size_t needed,
                                          const std::string& example);

  SourceSet sources_;
  Diagnostics diagnostics_;
  std::shared_ptr<const CommonModules> common_;
  Declarations names_;
};

}  // namespace wale
