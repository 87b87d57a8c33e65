#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "wale/session_log.hpp"

namespace wale {

/// A column of a table of trials, and what a reader needs to know of it.
struct TrialColumn {
  std::string name;         ///< snake_case: "response_time"
  std::string description;  ///< a sentence
  std::string units;        ///< SI, "N"; empty for plain numbers and texts
  std::vector<std::pair<std::string, std::string>> levels;  ///< values of a column of words, and what they mean
  friend bool operator==(const TrialColumn&, const TrialColumn&) = default;
};

/// The trials of one session, a row each. A cell that is empty has no value.
struct TrialTable {
  std::string participant, task, device, grade;
  std::string task_description, instructions;
  std::string design;  ///< a JSON object of what was asked and presented, as the log has it; empty if nothing says it
  std::vector<TrialColumn> columns;
  std::vector<std::vector<std::string>> rows;

  std::optional<std::size_t> column(std::string_view name) const;
  friend bool operator==(const TrialTable&, const TrialTable&) = default;
};

/// The trials of a log: all that were presented, those without an answer too; of sorts a row for each stimulus. Needs
/// nothing besides the log. Errors: `damaged_file` for a log of no experiment, and for one whose lines contradict each
/// other; `name` is the file's.
Result<TrialTable> trial_table(const SessionRecord& record, const std::string& name);

}  // namespace wale
