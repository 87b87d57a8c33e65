#include "calibration/analysis/trials.hpp"

#include <algorithm>
#include <map>
#include <numeric>
#include <set>
#include <tuple>
#include <unordered_map>
#include <unordered_set>

#include "schema/visible_text.hpp"

namespace wale::analysis {
namespace {

std::string as_code(std::string_view text) { return "`" + visible_text(text.substr(0, 60)) + "`"; }

/// Names in the order in which they appear.
class Names {
 public:
  std::uint32_t number_of(std::string_view name) {
    if (!names_.empty() && names_[last_] == name) return last_;
    const auto [at, is_new] = numbers_.try_emplace(std::string(name), static_cast<std::uint32_t>(names_.size()));
    if (is_new) names_.emplace_back(name);
    return last_ = at->second;
  }
  std::vector<std::string> take() { return std::move(names_); }
  std::size_t size() const { return names_.size(); }
  const std::vector<std::string>& all() const { return names_; }

 private:
  std::unordered_map<std::string, std::uint32_t> numbers_;
  std::vector<std::string> names_;
  std::uint32_t last_ = 0;
};

/// A number of a column and the unit behind it.
struct Measure {
  double value = 0;
  std::string_view unit;
};

std::optional<Measure> measure_in(std::string_view cell) {
  if (const auto plain = number_in(cell)) return Measure{*plain, {}};
  const auto space = cell.find(' ');
  if (space == std::string_view::npos || space + 1 >= cell.size()) return std::nullopt;
  const auto number = number_in(cell.substr(0, space));
  const std::string_view unit = cell.substr(space + 1);
  if (!number || number_in(unit)) return std::nullopt;
  return Measure{*number, unit};
}

/// The unit in a column's name: "N" of "amplitude (N)" and "amplitude [N]".
std::string unit_in_name(std::string_view name) {
  for (const auto& [open, close] : {std::pair('(', ')'), std::pair('[', ']')})
    if (const auto at = name.find(open); at != std::string_view::npos && name.ends_with(close))
      return std::string(name.substr(at + 1, name.size() - at - 2));
  return {};
}

std::optional<double> choice_in(std::string_view cell) {
  static const std::map<std::string, double, std::less<>> words = {
      {"1", 1}, {"0", 0}, {"yes", 1}, {"no", 0}, {"true", 1}, {"false", 0}, {"correct", 1}, {"incorrect", 0}, {"wrong", 0},
      {"different", 1}, {"same", 0}, {"1.0", 1}, {"0.0", 0}};
  std::string lower(cell.substr(0, 16));
  for (char& c : lower) c = c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
  const auto found = words.find(lower);
  if (found == words.end()) return std::nullopt;
  return found->second;
}

/// Reads the rows of one table.
class TrialReader {
 public:
  TrialReader(const Table* tables, std::size_t count, const TrialColumns& columns)
      : tables_(tables), count_(count), columns_(columns) {
    for (const SizeColumn& each : columns.sizes) trials_.sizes.push_back({each.name, "", {}});
    for (const std::string& each : columns.factors) trials_.factors.push_back({each, {}, {}});
    factor_names_.resize(columns.factors.size());
  }

  Result<Trials> read() {
    if (count_ == 0)
      return Error{.code = Code::malformed_value, .sentence = "there is no table of trials", .mend = "name one"};
    reserve();
    std::size_t rows = 0;
    for (std::size_t i = 0; i < count_; ++i) {
      table_ = &tables_[i];
      trials_.files.push_back(table_->file());
      for (const std::string& note : table_->notes()) trials_.notes.push_back((count_ > 1 ? table_->file() + ": " : "") + note);
      if (const auto found = find_columns(); !found) return found.error();
      for (std::size_t row = 0; row < table_->rows(); ++row)
        if (const auto done = read_row(row); !done) return done.error();
      rows += table_->rows();
    }
    if (trials_.size() == 0)
      return Error{.code = Code::malformed_value,
                   .sentence = "no trial is left: each of the " + std::to_string(rows) +
                               " rows is excluded" + (trials_.rules.empty() ? "" : ", as by: " + trials_.rules.front()),
                   .mend = "look at the rules of the exclusions",
                   .place = {.name = table_->file()}};
    finish_names();
    if (const auto varied = require_varied(); !varied) return varied.error();
    number_stimuli();
    note_missing_trials();
    note_short_runs();
    note_equal_rows();
    return std::move(trials_);
  }

 private:
  Result<std::size_t> column(const std::string& name) const {
    if (const auto found = table_->column(name)) return *found;
    Error error{.code = Code::malformed_value,
                .sentence = "there is no column " + as_code(name),
                .mend = "its columns are ",
                .place = {.name = table_->file()}};
    for (std::size_t i = 0; i < std::min<std::size_t>(table_->columns().size(), 20); ++i)
      error.mend += (i == 0 ? "" : ", ") + as_code(table_->columns()[i]);
    if (table_->columns().size() > 20) error.mend += " and " + std::to_string(table_->columns().size() - 20) + " more";
    return error;
  }

  /// A column that may be missing unless it is named.
  Result<std::optional<std::size_t>> column_if(const std::string& named, const char* usual) const {
    if (named.empty()) return table_->column(usual);
    const auto found = column(named);
    if (!found) return found.error();
    return std::optional(*found);
  }

  Result<> find_columns() {
    const auto observer = column(columns_.observer), answer = column(columns_.answer);
    if (!observer) return observer.error();
    if (!answer) return answer.error();
    observer_ = *observer, answer_ = *answer;
    sizes_.clear(), factors_.clear(), keep_.clear(), stated_.clear();
    for (std::size_t i = 0; i < columns_.sizes.size(); ++i) {
      const SizeColumn& each = columns_.sizes[i];
      const auto found = column(each.column.empty() ? each.name : each.column);
      if (!found) return found.error();
      sizes_.push_back(*found);
      const std::string unit = each.unit.empty() ? unit_in_name(table_->columns()[*found]) : each.unit;
      if (!unit.empty()) trials_.sizes[i].unit = unit;
      stated_.push_back(!unit.empty());
    }
    for (const std::string& each : columns_.factors) {
      const auto found = column(each);
      if (!found) return found.error();
      factors_.push_back(*found);
    }
    for (const Selection& each : columns_.keep) {
      const auto found = column(each.column);
      if (!found) return found.error();
      keep_.push_back(*found);
    }
    const auto run = column_if(columns_.run, "run"), trial = column_if(columns_.trial, "trial"),
               device = column_if(columns_.device, "device");
    if (!run) return run.error();
    if (!trial) return trial.error();
    if (!device) return device.error();
    run_ = *run, trial_ = *trial, device_ = *device;
    grade_ = table_->column("grade");
    if (columns_.by_study) excluded_ = table_->column("excluded"), type_ = table_->column("trial_type");
    return {};
  }

  void reserve() {
    std::size_t rows = 0;
    for (std::size_t i = 0; i < count_; ++i) rows += tables_[i].rows();
    trials_.observer.reserve(rows), trials_.run.reserve(rows), trials_.answer.reserve(rows), trials_.line.reserve(rows);
    for (SizeValues& each : trials_.sizes) each.values.reserve(rows);
    for (FactorValues& each : trials_.factors) each.values.reserve(rows);
    seen_.reserve(rows);
    trials_.file.reserve(rows);
  }

  void exclude(std::size_t row, const std::string& rule, std::optional<std::size_t> selection = {}) {
    auto at = std::ranges::find(trials_.rules, rule);
    if (at == trials_.rules.end()) at = trials_.rules.insert(at, rule);
    trials_.exclusions.push_back({trials_.files.size() - 1, table_->line(row), static_cast<std::size_t>(at - trials_.rules.begin()),
                                  selection});
  }

  Result<> read_row(std::size_t row) {
    for (std::size_t i = 0; i < keep_.size(); ++i) {
      const Selection& each = columns_.keep[i];
      if ((table_->cell(row, keep_[i]) == each.text) == each.is) continue;
      exclude(row, "only rows whose " + each.column + (each.is ? " is " : " is not ") + visible_text(each.text), i);
      return {};
    }
    if (excluded_ && !is_missing(table_->cell(row, *excluded_))) {
      exclude(row, visible_text(table_->cell(row, *excluded_)));
      return {};
    }
    if (type_ && table_->cell(row, *type_) == "practice") {
      exclude(row, "practice");
      return {};
    }
    const std::string_view observer = table_->cell(row, observer_);
    if (is_missing(observer)) return table_error(*table_, row, "this row names no observer", "write an identifier");
    if (const auto once = require_once(row, observer); !once) return once;
    const std::string_view answer_cell = table_->cell(row, answer_);
    if (run_) ++presented_[{std::string(observer), std::string(table_->cell(row, *run_))}];
    if (is_missing(answer_cell)) {
      exclude(row, "no answer");
      return {};
    }
    const auto answer = answer_in(row, answer_cell);
    if (!answer) return answer.error();
    if (columns_.answers == Answers::magnitudes && *answer <= 0) {
      exclude(row, "magnitudes of zero or below");
      return {};
    }
    for (std::size_t i = 0; i < sizes_.size(); ++i) {
      const auto value = size_in(row, i);
      if (!value) return value.error();
      trials_.sizes[i].values.push_back(*value);
    }
    for (std::size_t i = 0; i < factors_.size(); ++i) {
      const std::string_view cell = table_->cell(row, factors_[i]);
      if (is_missing(cell))
        return table_error(*table_, row, "the " + trials_.factors[i].name + " is missing", "leave the row out, or say it");
      trials_.factors[i].values.push_back(factor_names_[i].number_of(cell));
    }
    if (const auto same = require_one_device(row); !same) return same;
    if (const auto graded = take_grade(row); !graded) return graded;
    trials_.observer.push_back(observers_.number_of(observer));
    trials_.run.push_back(run_ ? runs_.number_of(table_->cell(row, *run_)) : 0);
    trials_.answer.push_back(*answer);
    trials_.file.push_back(static_cast<std::uint32_t>(trials_.files.size() - 1));
    trials_.line.push_back(table_->line(row));
    return {};
  }

  /// A trial's number occurs once in each run of each observer.
  Result<> require_once(std::size_t row, std::string_view observer) {
    if (!trial_) return {};
    key_.assign(observer);
    key_ += '\n';
    if (run_) key_ += table_->cell(row, *run_);
    key_ += '\n';
    key_ += table_->cell(row, *trial_);
    if (is_missing(table_->cell(row, *trial_))) return {};
    const auto [at, is_new] = seen_.try_emplace(key_, table_->line(row));
    if (is_new) return {};
    return table_error(*table_, row,
                       "trial " + visible_text(table_->cell(row, *trial_)) + " of " + visible_text(observer) +
                           (run_ ? " in run " + visible_text(table_->cell(row, *run_)) : "") +
                           " is there twice: first in row " + std::to_string(at->second),
                       "keep one of them, or name the column of the run");
  }

  /// Whether a column has numbers with points or with commas, but not both.
  Result<> require_one_mark(std::size_t row, std::size_t column, std::string_view cell) {
    const bool comma = cell.find(',') != std::string_view::npos, point = cell.find('.') != std::string_view::npos;
    if (!comma && !point) return {};
    // Between commas that separate cells, a comma in a number may be one of thousands: 1,234.
    if (table_->comma_separates())
      for (const auto& [other, mark] : marks_)
        if (other != column && mark != (comma ? ',' : '.'))
          return table_error(*table_, row,
                             "a number with a decimal " + std::string(comma ? "comma" : "point") +
                                 " in a table with decimal " + (comma ? "points" : "commas"),
                             "write a decimal point, and no comma between thousands", cell);
    char& known = marks_.try_emplace(column, comma ? ',' : '.').first->second;
    if (known == (comma ? ',' : '.')) return {};
    return table_error(*table_, row,
                       "a decimal " + std::string(comma ? "comma" : "point") + " in a column with decimal " +
                           (comma ? "points" : "commas"),
                       "write all numbers of a column alike", cell);
  }

  Result<double> answer_in(std::size_t row, std::string_view cell) {
    if (columns_.answers == Answers::labels) return static_cast<double>(labels_.number_of(cell));
    if (columns_.answers == Answers::choices) {
      if (const auto choice = choice_in(cell)) return *choice;
      return table_error(*table_, row, "expected 1 or 0, yes or no, correct or incorrect, different or same, found " + as_code(cell),
                         "name the column that has them");
    }
    const auto value = number_in(cell);
    if (!value) return table_error(*table_, row, "expected a number for an answer, found " + as_code(cell), "write n/a for no answer");
    if (const auto alike = require_one_mark(row, answer_, cell); !alike) return alike.error();
    if (columns_.answers == Answers::ratings && !(*value >= 0 && *value <= 100))
      return table_error(*table_, row, "expected a rating from 0 to 100, found " + as_code(cell), "correct it, or leave the row out");
    if (columns_.answers == Answers::magnitudes && *value <= 0 && !columns_.leave_out_nonpositive)
      return table_error(*table_, row, "expected a magnitude above zero, found " + as_code(cell),
                         "a magnitude has a logarithm; leave such answers out by rule, --leave-out-nonpositive, which the report then states");
    return *value;
  }

  Result<double> size_in(std::size_t row, std::size_t i) {
    const std::string_view cell = table_->cell(row, sizes_[i]);
    SizeValues& size = trials_.sizes[i];
    if (is_missing(cell))
      return table_error(*table_, row, "the " + size.name + " is missing", "leave the row out by rule, or say it");
    const auto measure = measure_in(cell);
    if (!measure) return table_error(*table_, row, "expected a number for the " + size.name + ", found " + as_code(cell), "");
    if (const auto alike = require_one_mark(row, sizes_[i], cell); !alike) return alike.error();
    // A unit that the column's name or the analyst states need not be repeated. Otherwise the first row decides.
    if (!stated_[i] && size.values.empty()) size.unit = measure->unit;
    if (measure->unit != size.unit && !(stated_[i] && measure->unit.empty()))
      return table_error(*table_, row,
                         "two units for the " + size.name + ": " + (size.unit.empty() ? "none" : as_code(size.unit)) +
                             " before and " + (measure->unit.empty() ? "none" : as_code(measure->unit)) + " here",
                         "convert the column to one unit");
    return measure->value;
  }

  Result<> require_one_device(std::size_t row) {
    if (!device_) return {};
    const std::string_view cell = table_->cell(row, *device_);
    if (trials_.size() == 0) {
      trials_.device = cell;
      device_line_ = table_->line(row);
      return {};
    }
    if (cell == trials_.device) return {};
    return table_error(*table_, row,
                       "the device is " + as_code(cell) + " here and " + as_code(trials_.device) + " in row " +
                           std::to_string(device_line_),
                       "analyse each device alone: keep the rows of one");
  }

  /// A misspelt grade is no better one: it would be taken for people on a real device.
  Result<> take_grade(std::size_t row) {
    const std::string_view cell = grade_ ? table_->cell(row, *grade_) : std::string_view();
    const auto grade = grade_in(cell);
    if (!grade)
      return table_error(*table_, row, "expected measured or simulated for the grade, found " + as_code(cell),
                         "write one of the two, or n/a where nobody knows");
    trials_.simulated |= *grade == GradeWord::simulated || (device_ && is_unfelt_device(table_->cell(row, *device_)));
    trials_.ungraded |= *grade == GradeWord::none;
    return {};
  }

  void finish_names() {
    trials_.observers = observers_.take();
    trials_.runs = runs_.take();
    trials_.labels = labels_.take();
    for (std::size_t i = 0; i < factors_.size(); ++i) {
      // Levels in alphabetical order, so that the first one, to which others are compared, does not depend on the rows.
      FactorValues& factor = trials_.factors[i];
      const std::vector<std::string> names = factor_names_[i].take();
      factor.levels = names;
      std::ranges::sort(factor.levels);
      std::vector<std::uint32_t> place;
      for (const std::string& name : names)
        place.push_back(static_cast<std::uint32_t>(std::ranges::lower_bound(factor.levels, name) - factor.levels.begin()));
      for (std::uint32_t& value : factor.values) value = place[value];
    }
  }

  Result<> require_varied() const {
    const auto constant = [&](const std::string& name, const std::string& value) {
      return Error{.code = Code::malformed_value,
                   .sentence = "the " + name + " is " + value + " in all " + std::to_string(trials_.size()) + " trials",
                   .mend = "what does not vary has no effect that could be estimated: leave it out of the analysis",
                   .place = {.name = table_->file()}};
    };
    for (const SizeValues& each : trials_.sizes) {
      const auto [low, high] = std::ranges::minmax(each.values);
      if (low == high) {
        std::string text = std::to_string(low);
        while (text.ends_with('0')) text.pop_back();
        if (text.ends_with('.')) text.pop_back();
        return constant(each.name, text + (each.unit.empty() ? "" : " " + each.unit));
      }
    }
    for (const FactorValues& each : trials_.factors)
      if (each.levels.size() == 1) return constant(each.name, as_code(each.levels.front()));
    return {};
  }

  void number_stimuli() {
    std::map<std::vector<double>, std::uint32_t> numbers;
    std::vector<double> key(trials_.sizes.size() + trials_.factors.size()), last;
    std::uint32_t last_number = 0;
    trials_.stimulus.reserve(trials_.size());
    for (std::size_t i = 0; i < trials_.size(); ++i) {
      std::size_t at = 0;
      for (const SizeValues& each : trials_.sizes) key[at++] = each.values[i];
      for (const FactorValues& each : trials_.factors) key[at++] = each.values[i];
      if (i == 0 || key != last) {
        last_number = numbers.try_emplace(key, static_cast<std::uint32_t>(numbers.size())).first->second;
        last = key;
      }
      trials_.stimulus.push_back(last_number);
    }
    trials_.stimuli = numbers.size();
  }

  /// Names runs with fewer rows than most have, whose other trials are in no file. Of tasks with right answers, a method
  /// may end a run early.
  void note_short_runs() {
    if (columns_.answers == Answers::choices) return;
    std::map<std::size_t, std::size_t> sizes;
    for (const auto& [of, rows] : presented_) ++sizes[rows];
    std::size_t usual = 0, runs = 0;
    for (const auto& [rows, count] : sizes)
      if (count >= runs) usual = rows, runs = count;
    if (2 * runs <= presented_.size()) return;
    std::size_t fewer = 0;
    std::string first;
    for (const auto& [of, rows] : presented_)
      if (rows < usual && fewer++ == 0)
        first = visible_text(of.first) + " has " + std::to_string(rows) + " trials in run " + visible_text(of.second) +
                ", and most runs have " + std::to_string(usual);
    if (fewer > 0) trials_.notes.push_back(first + (fewer > 1 ? "; " + std::to_string(fewer - 1) + " other runs are short too" : ""));
  }

  /// Names observers who lack some of the stimuli.
  void note_missing_trials() {
    if (columns_.answers == Answers::choices) return;  // adaptive methods present to each what they need
    if (trials_.stimuli == trials_.size()) return;  // each trial is its own stimulus, as in adaptive tasks
    std::vector<std::unordered_set<std::uint32_t>> felt(trials_.observers.size());
    for (std::size_t i = 0; i < trials_.size(); ++i) felt[trials_.observer[i]].insert(trials_.stimulus[i]);
    std::size_t incomplete = 0;
    std::string first;
    for (std::size_t i = 0; i < felt.size(); ++i) {
      if (felt[i].size() == trials_.stimuli) continue;
      if (incomplete++ == 0)
        first = visible_text(trials_.observers[i]) + " has answers to " + std::to_string(felt[i].size()) + " of " +
                std::to_string(trials_.stimuli) + " stimuli";
    }
    if (incomplete == 1) trials_.notes.push_back(first);
    if (incomplete > 1)
      trials_.notes.push_back(std::to_string(incomplete) + " observers lack answers to some stimuli: " + first);
  }

  /// Without a number of the trial, rows that were copied are not told from equal answers.
  void note_equal_rows() {
    if (trial_ || columns_.answers != Answers::magnitudes) return;
    std::set<std::tuple<std::uint32_t, std::uint32_t, std::uint32_t, double>> known;
    std::size_t equal = 0;
    for (std::size_t i = 0; i < trials_.size(); ++i)
      equal += known.insert({trials_.observer[i], trials_.run[i], trials_.stimulus[i], trials_.answer[i]}).second ? 0 : 1;
    if (equal > 0)
      trials_.notes.push_back(std::to_string(equal) + (equal == 1 ? " row is" : " rows are") +
                              " like an earlier one in observer, stimulus and answer; without a column of the trial's "
                              "number, trials that are there twice are not told from equal answers");
  }

  const Table* tables_;
  std::size_t count_;
  const Table* table_ = nullptr;
  const TrialColumns& columns_;
  Trials trials_;
  std::size_t observer_ = 0, answer_ = 0, device_line_ = 0;
  std::map<std::pair<std::string, std::string>, std::size_t> presented_;  ///< rows by observer and run
  std::optional<std::size_t> run_, trial_, device_, grade_, excluded_, type_;
  std::vector<std::size_t> sizes_, factors_, keep_;
  std::vector<bool> stated_;  // the unit of a size does not depend on the cells
  Names observers_, runs_, labels_;
  std::vector<Names> factor_names_;
  std::unordered_map<std::string, std::size_t> seen_;
  std::map<std::size_t, char> marks_;
  std::string key_;
};

std::string lower_of(std::string_view text) {
  std::string lower(text);
  for (char& c : lower) c = c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
  return lower;
}

}  // namespace

std::optional<GradeWord> grade_in(std::string_view cell) {
  if (is_missing(cell)) return GradeWord::none;
  const std::string word = lower_of(cell);
  if (word == "measured") return GradeWord::measured;
  if (word == "simulated") return GradeWord::simulated;
  return std::nullopt;
}

bool is_unfelt_device(std::string_view name) {
  const std::string word = lower_of(name);
  return word == "pointer" || word == "simulated" || word.starts_with("simulated:");
}

const SizeValues* Trials::size_named(const std::string& name) const {
  const auto found = std::ranges::find(sizes, name, &SizeValues::name);
  return found == sizes.end() ? nullptr : &*found;
}

const FactorValues* Trials::factor_named(const std::string& name) const {
  const auto found = std::ranges::find(factors, name, &FactorValues::name);
  return found == factors.end() ? nullptr : &*found;
}

Result<Trials> read_trials(const Table& table, const TrialColumns& columns) {
  return TrialReader(&table, 1, columns).read();
}
Result<Trials> read_trials(const std::vector<Table>& tables, const TrialColumns& columns) {
  return TrialReader(tables.data(), tables.size(), columns).read();
}

}  // namespace wale::analysis
