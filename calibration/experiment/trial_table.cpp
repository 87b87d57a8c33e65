#include "calibration/experiment/trial_table.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <map>
#include <nlohmann/json.hpp>
#include <set>

#include "calibration/analysis/trials.hpp"
#include "calibration/experiment/run_experiment.hpp"
#include "schema/visible_text.hpp"

namespace wale {
namespace {

using Json = nlohmann::ordered_json;

/// A column's name from any name: letters of ASCII, digits and underscores.
std::string column_name(const std::string& text) {
  std::string name;
  for (const char c : text) {
    const bool plain = (c >= '0' && c <= '9') || (c >= 'a' && c <= 'z') || c == '_';
    name += plain ? c : c >= 'A' && c <= 'Z' ? static_cast<char>(c + 32) : '_';
  }
  return name;
}

std::string logged_text(const Json& from, const char* key) {
  const auto found = from.find(key);
  return found != from.end() && found->is_string() ? found->get<std::string>() : std::string();
}

std::string number_text(double value) { return fmt::format("{}", value); }

std::optional<std::uint32_t> trial_in(const std::string& text) {
  std::uint32_t value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (text.empty() || error != std::errc() || end != text.data() + text.size() || value == 0) return std::nullopt;
  return value;
}

struct StimulusFacts {
  std::map<std::string, std::string> levels;  ///< by factor, as cells
  std::string standard;
};

struct FactorFacts {
  std::string name, units;
  bool is_number = true;
};

/// What happened in one trial.
struct TrialFacts {
  std::string stimulus, recording;
  std::uint32_t interval = 0;    ///< with the stimulus
  int shown_stimulus = 0, shown_standard = 0;
  double onset = 0, last_shown = 0;
  std::map<std::string, std::pair<std::string, double>> answers;  ///< and when they were given, s
  int taken_back = 0, resumed = 0;
};

class TableReader {
 public:
  TableReader(const SessionRecord& record, const std::string& name) : record_(record), name_(name) {}

  Result<TrialTable> read() {
    for (const SessionEntry& entry : record_.entries) take(entry);
    if (task_.empty())
      return Error{.code = Code::damaged_file,
                   .sentence = "this log is of no experiment",
                   .mend = "`wale experiment run` writes such logs",
                   .place = {.name = name_}};
    if (problem_) return *problem_;
    table_.task = experiment_;
    if (is_planted_) table_.grade = "simulated";  // whatever the first line says
    add_columns();
    if (task_ == "sorting") add_sorts();
    else add_trials();
    return std::move(table_);
  }

 private:
  void damaged(const SessionEntry& entry, std::string sentence) {
    if (!problem_)
      problem_ = Error{.code = Code::damaged_file,
                       .sentence = std::move(sentence),
                       .place = {.name = name_, .number = entry.number}};
  }

  void take(const SessionEntry& entry) {
    if (const auto* begin = std::get_if<SessionBegin>(&entry.event)) {
      table_.participant = begin->participant, table_.device = begin->device, table_.grade = begin->grade;
      experiment_ = begin->experiment;
      if (!analysis::grade_in(begin->grade))
        damaged(entry, fmt::format("expected measured or simulated for the grade, found `{}`", visible_text(begin->grade)));
    } else if (const auto* other = std::get_if<SessionOther>(&entry.event)) {
      const Json fields = Json::parse(other->fields, nullptr, false);
      if (other->event == "design") take_design(entry, fields);
      if (other->event == "stimulus") take_stimulus(entry, fields);
    } else if (const auto* shown = std::get_if<SessionShown>(&entry.event)) {
      if (shown->number != 0) take_shown(entry, *shown);
    } else if (const auto* answer = std::get_if<SessionAnswer>(&entry.event)) {
      take_answer(entry, *answer);
    } else if (const auto* back = std::get_if<SessionTakenBack>(&entry.event)) {
      for (const std::uint64_t line : back->answers) {
        const auto found = lines_.find(line);
        if (found == lines_.end()) continue;
        TrialFacts& trial = trials_[found->second.first];
        trial.answers.erase(found->second.second);
        ++trial.taken_back;
      }
    } else if (std::holds_alternative<SessionResumed>(entry.event)) {
      if (!trials_.empty() && trials_.rbegin()->second.answers.empty()) ++trials_.rbegin()->second.resumed;
    } else if (const auto* groups = std::get_if<SessionGroups>(&entry.event)) {
      sorts_.push_back(*groups);
    } else if (const auto* note = std::get_if<SessionNote>(&entry.event)) {
      is_planted_ = is_planted_ || note->text.starts_with(observer_note);
    }
    seconds_ = std::max(seconds_, entry.seconds);
  }

  void take_design(const SessionEntry& entry, const Json& fields) {
    task_ = logged_text(fields, "task");
    Json design = Json::object();  // without the text, which is long
    for (const auto& [key, value] : fields.items())
      if (key != "text" && key != "block" && key != "closing") design[key] = value;
    table_.design = design.dump();
    if (task_.empty()) damaged(entry, "the design has no task");
    if (const auto longest = fields.find("longest"); longest != fields.end() && longest->is_number())
      longest_ = longest->get<double>();
    if (const auto practice = fields.find("practice"); practice != fields.end() && practice->is_number_unsigned())
      practice_ = practice->get<std::uint32_t>();
    if (const auto size = fields.find("block"); size != fields.end() && size->is_number_unsigned())
      block_size_ = size->get<std::uint32_t>();
    const auto questions = fields.find("questions");
    if (questions != fields.end() && questions->is_array())
      for (const Json& each : *questions)
        if (each.is_object()) questions_.emplace_back(logged_text(each, "name"), logged_text(each, "says"));
    if (!questions_.empty()) table_.instructions = questions_.front().second;
    table_.task_description = task_;
  }

  void take_stimulus(const SessionEntry& entry, const Json& fields) {
    const std::string name = logged_text(fields, "name");
    if (name.empty()) return damaged(entry, "a stimulus has no name");
    StimulusFacts& facts = stimuli_[name];
    facts.standard = logged_text(fields, "standard");
    const auto levels = fields.find("levels");
    if (levels == fields.end() || !levels->is_object()) return;
    for (const auto& [factor, level] : levels->items()) {
      const auto value = level.find("value");
      const bool is_number = value != level.end() && value->is_number();
      facts.levels[factor] = is_number ? number_text(value->get<double>()) : logged_text(level, "text");
      const auto known = std::ranges::find(factors_, factor, &FactorFacts::name);
      if (known == factors_.end()) factors_.push_back({factor, logged_text(level, "unit"), is_number});
    }
  }

  void take_shown(const SessionEntry& entry, const SessionShown& shown) {
    TrialFacts& trial = trials_[shown.number];
    const bool is_stimulus = shown.what == "stimulus";
    if (trial.shown_stimulus + trial.shown_standard == 0) trial.onset = entry.seconds;
    // A trial that was broken off, or taken back, is presented anew, and of an adaptive method may be about another level.
    if (shown.interval <= 1 && trial.answers.empty()) {
      trial.stimulus.clear(), trial.recording.clear();
      trial.shown_stimulus = trial.shown_standard = 0;
      standards_shown_.erase(shown.number);
    }
    if (is_stimulus) {
      if (task_ != "adjustment" && !trial.stimulus.empty() && trial.stimulus != shown.name)
        return damaged(entry, fmt::format("trial {} is about `{}` and about `{}`", shown.number, trial.stimulus, shown.name));
      trial.stimulus = shown.name, trial.interval = shown.interval;
      trial.recording = shown.recording;
    } else if (trial.stimulus.empty()) {
      trial.recording = shown.recording;
    }
    (is_stimulus ? trial.shown_stimulus : trial.shown_standard) += 1;
    if (!is_stimulus) standards_shown_[shown.number] = shown.name;
    trial.last_shown = entry.seconds;
  }

  void take_answer(const SessionEntry& entry, const SessionAnswer& answer) {
    const auto trial = trial_in(answer.about);
    if (!trial || task_ == "sorting") return;
    if (!trials_.contains(*trial)) return damaged(entry, fmt::format("trial {} was answered and not presented", *trial));
    trials_[*trial].answers[answer.question] = {answer.answer, entry.seconds};
    lines_[entry.number] = {*trial, answer.question};
  }

  void add_column(std::string name, std::string description, std::string units = {},
                  std::vector<std::pair<std::string, std::string>> levels = {}) {
    table_.columns.push_back({std::move(name), std::move(description), std::move(units), std::move(levels)});
  }

  void add_columns() {
    const bool sorts = task_ == "sorting";
    add_column("participant", "identifier of the participant");
    add_column("run", sorts ? "number of the sort, from 1" : "number of the block, from 1; 0 is practice");
    if (!sorts) {
      add_column("trial", "number of the trial in the session, from 1");
      add_column("trial_type", "what the trial is for", "", {{"practice", "before the first block"}, {"main", "of a block"}});
      add_column("onset", "time of the first presentation since the session began", "s");
    }
    add_column("stimulus", "name of the stimulus in the design");
    for (const FactorFacts& each : factors_)
      add_column(column_name(each.name), fmt::format("level of the factor {}", each.name), each.units);
    if (sorts) {
      add_column("groups", "how many groups the sort has");
      add_column("response", "the group that the stimulus was put into, from 1");
      add_column("label", "what the participant called the group");
    } else {
      const bool pairs = task_ == "two_interval" || task_ == "same_different" || task_ == "one_interval" || task_ == "adjustment";
      if (pairs) add_column("standard", "name of the standard that it is compared with");
      if (pairs) add_column("target", target_words());
      add_column("response", response_words(), task_ == "adjustment" ? adjusted_units() : "", response_levels());
      if (pairs && task_ != "adjustment")
        add_column("correct", correct_words(), "", {{"1", "yes"}, {"0", "no"}});
      add_column("response_time", "from the beginning of the last presentation to the response", "s");
      for (const auto& [name, says] : questions_)
        if (name != "response") add_column(column_name(name), "answer to: " + says);
      add_column("taken_back", "how many answers in this trial the participant took back");
      add_column("interrupted", "how often the session was broken off in this trial and went on");
    }
    add_column("excluded", "why the row should not be analysed, by the rules of the design");
    add_column("device", "name of the device's declaration");
    add_column("grade", "what the answers can be evidence of", "",
               {{"measured", "people on a plugged, trusted device"}, {"simulated", "anything else, the worst grade"}});
    if (!sorts) add_column("stim_file", "recording of the presentation, beside the log");
  }

  std::string target_words() const {
    if (task_ == "two_interval") return "interval with the stimulus, 1 or 2; the standard was in the other";
    if (task_ == "adjustment") return "not used";
    return task_ == "one_interval" ? "1 if the stimulus was presented, 0 if the standard was" : "1 if the two differed, else 0";
  }
  std::string adjusted_units() const { return factors_.size() == 1 ? factors_.front().units : ""; }
  std::string response_words() const {
    if (task_ == "magnitude_estimation") return "the participant's number, above 0";
    if (task_ == "adjustment") return "level at which the stimulus was like the standard, SI";
    if (task_ == "rating" || task_ == "confidence") return "the participant's rating, 0 to 100";
    if (task_ == "two_interval") return "interval that was chosen";
    return "the participant's answer";
  }
  std::vector<std::pair<std::string, std::string>> response_levels() const {
    if (task_ == "two_interval") return {{"1", "the first interval"}, {"2", "the second interval"}};
    if (task_ == "one_interval") return {{"yes", "it was there"}, {"no", "it was not there"}};
    if (task_ == "same_different") return {{"same", "the two were the same"}, {"different", "the two differed"}};
    return {};
  }
  std::string correct_words() const {
    return task_ == "two_interval" ? "whether the interval with the stimulus was chosen, and not that with the standard"
                                   : "whether the response is right";
  }

  std::string excluded() const {
    if (!longest_ || seconds_ <= *longest_) return {};
    return fmt::format("the session took {:.0f} minutes of at most {:.0f}", seconds_ / 60, *longest_ / 60);
  }

  std::uint32_t block_of(std::uint32_t trial) const {
    if (trial <= practice_) return 0;
    return block_size_ == 0 ? 1 : 1 + (trial - practice_ - 1) / block_size_;
  }

  void add_trials() {
    for (const auto& [number, trial] : trials_) {
      std::vector<std::string> row;
      const std::uint32_t block = block_of(number);
      const auto standard = standards_shown_.find(number);
      const auto answer = [&answers = trial.answers](const std::string& question) {
        const auto found = answers.find(question);
        return found == answers.end() ? std::string() : found->second.first;
      };
      const std::string response = answer("response");
      int target = 0;
      if (task_ == "two_interval") target = static_cast<int>(trial.interval);
      if (task_ == "one_interval") target = trial.shown_stimulus > 0 ? 1 : 0;
      if (task_ == "same_different") target = trial.shown_stimulus > 0 && trial.shown_standard > 0 ? 1 : 0;
      for (const TrialColumn& column : table_.columns) {
        const std::string& name = column.name;
        const auto factor = std::ranges::find(factors_, name, [](const FactorFacts& each) { return column_name(each.name); });
        if (name == "participant") row.push_back(table_.participant);
        else if (name == "run") row.push_back(std::to_string(block));
        else if (name == "trial") row.push_back(std::to_string(number));
        else if (name == "trial_type") row.push_back(block == 0 ? "practice" : "main");
        else if (name == "onset") row.push_back(number_text(trial.onset));
        else if (name == "stimulus") row.push_back(trial.stimulus);
        else if (name == "standard") row.push_back(standard == standards_shown_.end() ? "" : standard->second);
        else if (name == "target") row.push_back(task_ == "adjustment" ? "" : std::to_string(target));
        else if (name == "response") row.push_back(response);
        else if (name == "correct") row.push_back(response.empty() ? "" : is_correct(response, target) ? "1" : "0");
        else if (name == "response_time") row.push_back(time_of(trial));
        else if (name == "taken_back") row.push_back(std::to_string(trial.taken_back));
        else if (name == "interrupted") row.push_back(std::to_string(trial.resumed));
        else if (name == "excluded") row.push_back(excluded());
        else if (name == "device") row.push_back(table_.device);
        else if (name == "grade") row.push_back(table_.grade);
        else if (name == "stim_file") row.push_back(trial.recording);
        else if (factor != factors_.end()) row.push_back(level_of(trial.stimulus, standard == standards_shown_.end() ? "" : standard->second, factor->name));
        else row.push_back(question_named(trial, name));
      }
      table_.rows.push_back(std::move(row));
    }
  }

  /// The level of a factor in a trial: the stimulus's, or the standard's where nothing else was presented.
  std::string level_of(const std::string& stimulus, const std::string& standard, const std::string& factor) const {
    const auto facts = stimuli_.find(stimulus.empty() ? standard : stimulus);
    if (facts == stimuli_.end()) return {};
    const auto level = facts->second.levels.find(factor);
    return level == facts->second.levels.end() ? std::string() : level->second;
  }

  std::string question_named(const TrialFacts& trial, const std::string& column) const {
    for (const auto& [question, answer] : trial.answers)
      if (column_name(question) == column) return answer.first;
    return {};
  }

  bool is_correct(const std::string& response, int target) const {
    if (task_ == "two_interval") return response == std::to_string(target);
    if (task_ == "one_interval") return (response == "yes") == (target == 1);
    return (response == "different") == (target == 1);
  }

  /// Empty for a planted observer, who answers at once.
  std::string time_of(const TrialFacts& trial) const {
    const auto found = trial.answers.find("response");
    if (found == trial.answers.end() || is_planted_) return {};
    const double seconds = found->second.second - trial.last_shown;
    return number_text(std::max(0.0, std::round(seconds * 1000) / 1000));
  }

  void add_sorts() {
    for (std::size_t sort = 0; sort < sorts_.size(); ++sort)
      for (std::size_t group = 0; group < sorts_[sort].groups.size(); ++group)
        for (const std::string& stimulus : sorts_[sort].groups[group].patches) {
          std::vector<std::string> row = {table_.participant, std::to_string(sort + 1), stimulus};
          const auto facts = stimuli_.find(stimulus);
          for (const FactorFacts& factor : factors_)
            row.push_back(facts == stimuli_.end() || !facts->second.levels.contains(factor.name)
                              ? ""
                              : facts->second.levels.at(factor.name));
          row.insert(row.end(), {std::to_string(sorts_[sort].groups.size()), std::to_string(group + 1),
                                 sorts_[sort].groups[group].says, excluded(), table_.device, table_.grade});
          table_.rows.push_back(std::move(row));
        }
  }

  const SessionRecord& record_;
  const std::string& name_;
  TrialTable table_;
  std::string experiment_, task_;
  std::optional<double> longest_;
  std::uint32_t practice_ = 0, block_size_ = 0;
  double seconds_ = 0;
  std::vector<std::pair<std::string, std::string>> questions_;
  std::map<std::string, StimulusFacts> stimuli_;
  std::vector<FactorFacts> factors_;
  std::map<std::uint32_t, TrialFacts> trials_;
  std::map<std::uint32_t, std::string> standards_shown_;
  std::map<std::uint64_t, std::pair<std::uint32_t, std::string>> lines_;
  std::vector<SessionGroups> sorts_;
  std::optional<Error> problem_;
  bool is_planted_ = false;
};

}  // namespace

std::optional<std::size_t> TrialTable::column(std::string_view name) const {
  const auto found = std::ranges::find(columns, name, &TrialColumn::name);
  if (found == columns.end()) return std::nullopt;
  return static_cast<std::size_t>(found - columns.begin());
}

Result<TrialTable> trial_table(const SessionRecord& record, const std::string& name) {
  return TableReader(record, name).read();
}

}  // namespace wale
