#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "calibration/experiment/level_chooser.hpp"
#include "calibration/experiment/response.hpp"
#include "calibration/experiment/trial_order.hpp"
#include "wale/session_log.hpp"

namespace wale {

/// One sort of an experiment: how its stimuli lie in piles.
struct Sort {
  std::uint32_t number = 0;           ///< from 1
  std::optional<int> groups;          ///< how many there have to be; empty: any number
  std::vector<std::string> labels;    ///< three digits for each stimulus, new in each sort
  std::map<std::size_t, int> piles;   ///< of stimuli that were put into one, from 1
  std::map<int, std::string> says;    ///< what is written on piles
};

/// Where a session of an experiment stands: a function of the experiment, the seed and the lines of its log. To go on
/// after an interruption, all lines are taken again.
class TrialSession {
 public:
  /// `experiment` must outlive it.
  TrialSession(const CheckedExperiment& experiment, std::uint32_t seed);

  /// A line of the log: answers, answers taken back, and groups count.
  void take(const SessionEntry& entry);

  /// The first trial with an open question; none if all are answered. Of an adaptive method it depends on the answers.
  std::optional<Trial> next_trial();
  /// The questions of that trial that have no answer yet.
  std::vector<Asked> open_questions(const Trial& trial) const;
  /// The questions after the last trial that have no answer yet.
  std::vector<Asked> open_closing() const;
  /// The sort that is under way or comes next; none if all are done, or the experiment has none.
  std::optional<Sort> next_sort() const;

  /// How many trials are answered, and how many there will be, as far as that is known.
  std::size_t answered() const { return answered_; }
  std::size_t known_trials() const { return trials_.size(); }

  /// Whether the participant has agreed to what the experiment asks consent for.
  bool has_consent() const;

  /// The lines of the answers to the latest trial that has any, to take them back; empty if none has.
  std::vector<std::uint64_t> latest_answers() const;
  /// The lines of all answers of a block; 0: of practice.
  std::vector<std::uint64_t> answers_of_block(std::uint32_t block) const;
  /// The block of the trial that comes next, from 1; 0: practice, or nothing has been answered.
  std::uint32_t block();

 private:
  struct Given {
    std::uint64_t line = 0;
    std::string answer;
  };
  struct Track {
    std::vector<std::size_t> stimuli;  ///< rising
    std::unique_ptr<LevelChooser> chooser;
  };

  void begin_tracks();
  bool is_answered(std::uint32_t trial) const;
  void forget_from(std::uint32_t trial);
  std::optional<Trial> choose();

  const CheckedExperiment& experiment_;
  std::uint32_t seed_;
  std::vector<Asked> questions_, closing_;
  std::vector<Trial> trials_;  ///< those that are known
  std::size_t fixed_ = 0;      ///< of them, those that no answer chooses
  std::size_t counted_ = 0;    ///< of them, those whose answers the tracks know
  std::vector<Track> tracks_;
  std::vector<std::size_t> track_of_;  ///< of each trial that was chosen
  std::map<std::uint32_t, std::map<std::string, Given>> given_;  ///< by trial and question
  std::map<std::string, Given> given_after_;                     ///< to the closing questions
  std::map<std::uint64_t, std::pair<std::uint32_t, std::string>> lines_;  ///< trial (0: closing) and question of each
  std::size_t answered_ = 0;   ///< trials before this one are answered
  std::uint32_t sorts_done_ = 0;
  struct SortedAnswer {
    std::uint64_t line;
    bool is_label;
    std::string about, answer;
  };
  std::vector<SortedAnswer> sorted_;  ///< of the sort under way
};

/// Whether the answer to a trial is right: the interval with the stimulus was chosen, its presence was told, or the same
/// pair was told from different ones. Empty for tasks without right answers.
std::optional<bool> is_right(const CheckedExperiment& experiment, const Trial& trial, const std::string& response);

}  // namespace wale
