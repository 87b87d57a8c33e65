#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "compiler/expression/checked_experiment.hpp"
#include "wale/result.hpp"

namespace wale {

/// What an answer may be.
enum class ResponseKind {
  magnitude,       ///< a number above 0, also with a decimal comma or as a fraction, "1/2"
  rating,          ///< a number from 0 to 100, also with %
  number,          ///< any number
  text,            ///< one line that is not empty
  yes_no,          ///< "yes", "no"
  interval,        ///< "1", "2"
  same_different,  ///< "same", "different"
};

/// A question as it is asked and logged.
struct Asked {
  std::string name;  ///< "response" for that of the trial
  ResponseKind kind = ResponseKind::text;
  std::string says;
};

/// The question of each trial, then those of the design. Empty for sorting.
std::vector<Asked> questions_of_trial(const CheckedExperiment& experiment);
/// The questions after the last trial.
std::vector<Asked> closing_questions(const CheckedExperiment& experiment);

/// What is expected, in words: "a number above 0".
const char* expected_words(ResponseKind kind);

/// An answer as it is logged, from what a person typed: "0.5" for "1/2" and "0,5", "yes" for "y". Error:
/// `malformed_value` with what was expected.
Result<std::string> checked_response(ResponseKind kind, std::string_view typed);

}  // namespace wale
