#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "calibration/analysis/table.hpp"
#include "wale/result.hpp"

namespace wale::analysis {

/// What the answers of a task are.
enum class Answers {
  magnitudes,  ///< numbers above zero
  ratings,     ///< numbers from 0 to 100
  choices,     ///< 1 or 0, also in words: yes, no; true, false; correct, incorrect; different, same
  labels,      ///< texts: the group that a stimulus was put into
};

/// What a cell of the column `grade` says a trial is evidence of.
enum class GradeWord { none, measured, simulated };
/// Capitals do not matter, and a missing cell says nothing. Nothing for a word that is no grade.
std::optional<GradeWord> grade_in(std::string_view cell);
/// Whether a device of this name is felt by nobody: a simulated one, or a pointer, which only shows forces.
bool is_unfelt_device(std::string_view name);

/// A number that was varied: the commanded size of a stimulus.
struct SizeColumn {
  std::string name;    ///< in the analysis: "amplitude"
  std::string column;  ///< in the table; empty for the same
  std::string unit;    ///< "N"; empty if cells or the column's name ("amplitude (N)") say it, or for a plain number
};

/// Rows that are analysed: those whose cell of a column is, or is not, a text.
struct Selection {
  std::string column, text;
  bool is = true;
};

/// Which column of a table is what. An empty name of `run`, `trial` or `device` stands for a column of that name that
/// may be missing.
struct TrialColumns {
  std::string observer = "participant";
  std::string answer = "response";
  Answers answers = Answers::magnitudes;
  std::vector<SizeColumn> sizes;
  std::vector<std::string> factors;  ///< columns of words: "waveform"
  std::string run, trial, device;
  std::vector<Selection> keep;      ///< rows that fail one are excluded
  bool by_study = true;             ///< rows that the study itself marks are excluded: those with a text in a column
                                    ///< `excluded`, and those of `trial_type` practice
  bool leave_out_nonpositive = false;  ///< magnitudes of zero or below are excluded and not refused
};

/// A row that is not analysed, and why.
struct Exclusion {
  std::size_t file = 0;  ///< index in `Trials::files`
  std::size_t line = 0;  ///< of the file, from 1
  std::size_t rule = 0;  ///< index in `Trials::rules`
  std::optional<std::size_t> selection = {};  ///< which of `TrialColumns::keep` left it out; nothing for other rules
};

/// A varied number in each trial.
struct SizeValues {
  std::string name, unit;
  std::vector<double> values;  ///< in `unit`, finite
};

/// A word in each trial.
struct FactorValues {
  std::string name;
  std::vector<std::string> levels;    ///< in alphabetical order
  std::vector<std::uint32_t> values;  ///< index of the level
};

/// The trials of a study that are analysed, in the order of the file. All columns have one entry for each trial.
struct Trials {
  std::vector<std::string> files;
  std::vector<std::string> observers;    ///< identifiers, in the order in which they appear
  std::vector<std::uint32_t> observer;   ///< index in `observers`
  std::vector<std::uint32_t> run;        ///< index in `runs`; all 0 if the table has none
  std::vector<std::string> runs;         ///< names, in the order in which they appear
  std::vector<double> answer;            ///< of labels, index in `labels`
  std::vector<std::string> labels;
  std::vector<SizeValues> sizes;
  std::vector<FactorValues> factors;
  std::vector<std::uint32_t> stimulus;   ///< trials with the same sizes and factors have the same number
  std::size_t stimuli = 0;
  std::vector<std::uint32_t> file;       ///< index in `files`
  std::vector<std::size_t> line;         ///< of the file, from 1
  bool simulated = false;                ///< a column `grade` or the device says so of at least one trial
  bool ungraded = false;                 ///< nothing grades at least one trial
  std::string device;                    ///< the one device of all trials; empty if the table does not say
  std::vector<std::string> rules;        ///< of the exclusions, in words
  std::vector<Exclusion> exclusions;     ///< in the order of the file
  std::vector<std::string> notes;        ///< what a reader of the results should know: mended text, missing trials

  std::size_t size() const { return answer.size(); }
  /// Where a trial stands.
  Place place(std::size_t trial) const { return {.name = files[file[trial]], .number = line[trial]}; }
  const SizeValues* size_named(const std::string& name) const;
  const FactorValues* factor_named(const std::string& name) const;
};

/// Reads the trials of a table. Rows without an answer and rows that `keep` leaves out become exclusions; anything else
/// that cannot be analysed is an error.
///
/// Errors (W0801) name file and row: an unknown column, a word for a number, a magnitude of zero or below, a rating
/// outside 0 to 100, a size that is missing, two units in one column, a word that is no grade, decimal commas beside decimal points, a row that is
/// there twice, trials on several devices, a size or factor that is the same in all trials, no trials left.
Result<Trials> read_trials(const Table& table, const TrialColumns& columns);
/// The same of several tables, such as one for each participant, in their order.
Result<Trials> read_trials(const std::vector<Table>& tables, const TrialColumns& columns);

}  // namespace wale::analysis
