#include "calibration/experiment/trial_session.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <utility>

namespace wale {
namespace {

constexpr const char* pile_question = "pile";
constexpr const char* label_question = "label";

/// The whole number that a text is; empty for any other text.
template <class Whole>
std::optional<Whole> whole_in(const std::string& text) {
  Whole value{};
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (text.empty() || error != std::errc() || end != text.data() + text.size()) return std::nullopt;
  return value;
}

}  // namespace

std::optional<bool> is_right(const CheckedExperiment& experiment, const Trial& trial, const std::string& response) {
  switch (experiment.task) {
    case TrialTask::two_interval: return response == std::to_string(trial.target);
    case TrialTask::one_interval: return (response == "yes") == (trial.target == 1);
    case TrialTask::same_different: return (response == "different") == (trial.target == 1);
    default: return std::nullopt;
  }
}

TrialSession::TrialSession(const CheckedExperiment& experiment, std::uint32_t seed)
    : experiment_(experiment),
      seed_(seed),
      questions_(questions_of_trial(experiment)),
      closing_(closing_questions(experiment)),
      trials_(trial_order(experiment, seed)),
      fixed_(trials_.size()) {
  begin_tracks();
}

void TrialSession::begin_tracks() {
  tracks_.clear();
  track_of_.clear();
  counted_ = fixed_;
  if (!is_adaptive(experiment_)) return;
  for (int repetition = 0; repetition < experiment_.repetitions; ++repetition)
    for (auto& stimuli : tracks_of(experiment_)) {
      std::vector<double> levels;
      for (const std::size_t each : stimuli) {
        const auto& factor = experiment_.factors[*experiment_.over];
        levels.push_back(factor.levels[*experiment_.stimuli[each].levels[*experiment_.over]].value.value_or(0));
      }
      tracks_.push_back({std::move(stimuli), chooser_of(experiment_, levels)});
    }
}

void TrialSession::take(const SessionEntry& entry) {
  if (const auto* answer = std::get_if<SessionAnswer>(&entry.event)) {
    const bool labels = answer->question == label_question;
    if (experiment_.task == TrialTask::sorting && (labels || answer->question == pile_question)) {
      sorted_.push_back({entry.number, labels, answer->about, answer->answer});
      return;
    }
    const auto trial = answer->about == "session" ? std::optional<std::uint32_t>(0) : whole_in<std::uint32_t>(answer->about);
    if (!trial) return;
    lines_[entry.number] = {*trial, answer->question};
    (*trial == 0 ? given_after_ : given_[*trial])[answer->question] = {entry.number, answer->answer};
  } else if (const auto* back = std::get_if<SessionTakenBack>(&entry.event)) {
    for (const std::uint64_t line : back->answers) {
      std::erase_if(sorted_, [&](const SortedAnswer& each) { return each.line == line; });
      const auto found = lines_.find(line);
      if (found == lines_.end()) continue;
      const auto [trial, question] = found->second;
      auto& given = trial == 0 ? given_after_ : given_[trial];
      if (const auto at = given.find(question); at != given.end() && at->second.line == line) given.erase(at);
      lines_.erase(found);
      if (trial != 0) forget_from(trial);
    }
  } else if (std::holds_alternative<SessionGroups>(entry.event)) {
    ++sorts_done_;
    sorted_.clear();
  }
}

bool TrialSession::is_answered(std::uint32_t trial) const {
  const auto found = given_.find(trial);
  return found != given_.end() && std::ranges::all_of(questions_, [&](const Asked& each) {
           return found->second.contains(each.name);
         });
}

/// The answers of that trial have changed: what was chosen after it is chosen again.
void TrialSession::forget_from(std::uint32_t trial) {
  answered_ = std::min<std::size_t>(answered_, trial - 1);
  if (!is_adaptive(experiment_) || trial <= fixed_) return;
  if (trials_.size() > trial) trials_.resize(trial);
  begin_tracks();
  trials_.resize(fixed_);
}

/// The next trial of an adaptive method; the tracks know all answers before it.
std::optional<Trial> TrialSession::choose() {
  std::vector<std::size_t> open;
  for (std::size_t i = 0; i < tracks_.size(); ++i)
    if (!tracks_[i].chooser->over()) open.push_back(i);
  if (open.empty()) return std::nullopt;
  const auto number = static_cast<std::uint32_t>(trials_.size() + 1);
  // Tracks of one repetition are mixed, and repetitions follow one another.
  const std::size_t per_repetition = tracks_.size() / static_cast<std::size_t>(experiment_.repetitions);
  const std::size_t repetition = open.front() / per_repetition;
  std::erase_if(open, [&](std::size_t each) { return each / per_repetition != repetition; });
  const Draws draws(seed_, static_cast<std::uint32_t>(Drawn::track));
  const std::size_t track = experiment_.random ? open[draws.bits(number) % open.size()] : open.front();
  track_of_.push_back(track);
  return trial_about(experiment_, seed_, tracks_[track].stimuli[tracks_[track].chooser->next()], number,
                     static_cast<std::uint32_t>(repetition + 1));
}

std::optional<Trial> TrialSession::next_trial() {
  for (;;) {
    while (answered_ < trials_.size() && is_answered(trials_[answered_].number)) ++answered_;
    if (answered_ < trials_.size()) return trials_[answered_];
    if (!is_adaptive(experiment_)) return std::nullopt;
    for (; counted_ < trials_.size(); ++counted_) {
      const Trial& trial = trials_[counted_];
      Track& track = tracks_[track_of_[counted_ - fixed_]];
      const auto level = std::ranges::find(track.stimuli, trial.stimulus) - track.stimuli.begin();
      const bool right = is_right(experiment_, trial, given_[trial.number]["response"].answer).value_or(false);
      // In a catch trial the stimulus was not there, so its answer says nothing about the level.
      const bool had_target = experiment_.task == TrialTask::two_interval || trial.target == 1;
      if (had_target) track.chooser->take(static_cast<std::size_t>(level), right);
    }
    const auto chosen = choose();
    if (!chosen) return std::nullopt;
    trials_.push_back(*chosen);
  }
}

std::vector<Asked> TrialSession::open_questions(const Trial& trial) const {
  std::vector<Asked> open = questions_;
  if (const auto found = given_.find(trial.number); found != given_.end())
    std::erase_if(open, [&](const Asked& each) { return found->second.contains(each.name); });
  return open;
}

std::vector<Asked> TrialSession::open_closing() const {
  std::vector<Asked> open = closing_;
  std::erase_if(open, [&](const Asked& each) { return given_after_.contains(each.name); });
  return open;
}

bool TrialSession::has_consent() const {
  const auto found = given_after_.find("consent");
  return found != given_after_.end() && found->second.answer == "yes";
}

std::optional<Sort> TrialSession::next_sort() const {
  if (experiment_.task != TrialTask::sorting) return std::nullopt;
  const std::size_t count = experiment_.groups.empty() ? 1 : experiment_.groups.size();
  const std::size_t all = count * static_cast<std::size_t>(experiment_.repetitions);
  if (sorts_done_ >= all) return std::nullopt;
  Sort sort;
  sort.number = sorts_done_ + 1;
  if (!experiment_.groups.empty()) sort.groups = experiment_.groups[sorts_done_ % count];
  const Draws draws(seed_, static_cast<std::uint32_t>(Drawn::labels));
  const auto numbers = draws.order(900, sort.number);  // 100 to 999, each once
  for (std::size_t i = 0; i < experiment_.stimuli.size(); ++i)
    sort.labels.push_back(i < numbers.size() ? std::to_string(100 + numbers[i]) : std::to_string(1000 + i));
  for (const SortedAnswer& each : sorted_) {
    if (each.is_label) {
      if (const auto pile = whole_in<int>(each.about)) sort.says[*pile] = each.answer;
      continue;
    }
    const auto stimulus = std::ranges::find(experiment_.stimuli, each.about, &ExperimentStimulus::name);
    const auto pile = whole_in<int>(each.answer);
    if (stimulus == experiment_.stimuli.end() || !pile) continue;
    const auto index = static_cast<std::size_t>(stimulus - experiment_.stimuli.begin());
    if (*pile == 0) sort.piles.erase(index);
    else sort.piles[index] = *pile;
  }
  return sort;
}

std::vector<std::uint64_t> TrialSession::latest_answers() const {
  std::vector<std::uint64_t> lines;
  for (auto trial = given_.rbegin(); trial != given_.rend() && lines.empty(); ++trial)
    for (const auto& [question, given] : trial->second) lines.push_back(given.line);
  std::ranges::sort(lines);
  return lines;
}

std::vector<std::uint64_t> TrialSession::answers_of_block(std::uint32_t block) const {
  std::vector<std::uint64_t> lines;
  for (const Trial& trial : trials_)
    if (const auto found = given_.find(trial.number); trial.block == block && found != given_.end())
      for (const auto& [question, given] : found->second) lines.push_back(given.line);
  std::ranges::sort(lines);
  return lines;
}

std::uint32_t TrialSession::block() {
  const auto trial = next_trial();
  return trial ? trial->block : trials_.empty() ? 0 : trials_.back().block;
}

}  // namespace wale
