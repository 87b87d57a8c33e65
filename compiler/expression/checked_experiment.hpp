#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "compiler/text/source.hpp"

namespace wale {

struct CheckedMaterial;

/// What a participant does in a trial.
enum class TrialTask {
  magnitude_estimation,  ///< gives a number above 0 in proportion to the percept
  rating,                ///< gives 0 to 100 between two ends
  confidence,            ///< says from 0 to 100 how sure they are
  description,           ///< says in words what it feels like
  two_interval,          ///< feels the stimulus and the standard in either order, and says which had more
  one_interval,          ///< feels one of them, and says whether it was the stimulus
  same_different,        ///< feels a pair, and says whether they were the same
  adjustment,            ///< changes the stimulus until it is like the standard
  sorting,               ///< puts all stimuli into groups
};
inline constexpr const char* trial_task_names[] = {"magnitude_estimation", "rating",       "confidence",
                                                   "description",          "two_interval", "one_interval",
                                                   "same_different",       "adjustment",   "sorting"};

/// How the next stimulus of a task with right and wrong answers is chosen.
enum class TrialMethod {
  constant_stimuli,  ///< each stimulus so many times
  up_down,           ///< a transformed staircase (Levitt 1971) along one factor
  quest_plus,        ///< by the least expected entropy (Watson 2017) along one factor
};
inline constexpr const char* trial_method_names[] = {"constant_stimuli", "up_down", "quest_plus"};

/// What kind of answer a question has.
enum class AnswerKind { number, rating, text, yes_no };
inline constexpr const char* answer_kind_names[] = {"number", "rating", "text", "yes_no"};

/// `question sure rating "How sure are you, from 0 to 100?"`.
struct ExperimentQuestion {
  std::string name;
  AnswerKind kind = AnswerKind::text;
  std::string says;
};

/// One level of a factor: a quantity, or a material.
struct ExperimentLevel {
  std::string text;             ///< as written, "0.2 N", or as computed between two ends
  std::optional<double> value;  ///< SI; none for a material
};

/// `factor amplitude 0.2 N, 0.8 N, 2 N`.
struct ExperimentFactor {
  std::string name;
  std::vector<ExperimentLevel> levels;
  std::string unit;  ///< the SI unit of its values, "kg m/s^2" as "N"; empty for plain numbers and materials
  Span span;
};

/// One thing to feel: a material with its parameters bound to one level of each factor that it names.
struct ExperimentStimulus {
  std::string name;     ///< unique in the experiment
  std::string made_of;  ///< "bench(amplitude: 0.2 N, period: 1.2 mm)"
  std::vector<std::optional<std::size_t>> levels;  ///< of each factor of the experiment, in their order
  std::shared_ptr<const CheckedMaterial> material;
  std::optional<std::size_t> standard;  ///< what it is compared with: an index into `CheckedExperiment::standards`
  Span span;
};

/// What happens to a session that was broken off, by how long ago that was, s. Each includes the shorter ones; later
/// than the last, the session cannot go on.
struct InterruptedSession {
  double resume = 0;            ///< goes on with the trial that was broken off
  double repeat_practice = 0;   ///< repeats the practice before that
  double restart_block = 0;     ///< repeats the block that was broken off
};

/// `experiment NAME { … }`: what is presented to people, in which order, and what they are asked.
struct CheckedExperiment {
  std::string name, documentation;
  Span span;       ///< of the name
  Span statement;  ///< of the whole declaration
  std::vector<ExperimentFactor> factors;
  std::vector<ExperimentStimulus> stimuli, standards;
  TrialTask task = TrialTask::magnitude_estimation;
  std::optional<double> modulus;             ///< of magnitude estimation, the number of the first stimulus; none: free
  std::string lowest, highest;               ///< what 0 and 100 of a rating mean
  std::vector<int> groups;                   ///< how many groups each sort has; empty: as many as the participant likes
  TrialMethod method = TrialMethod::constant_stimuli;
  std::optional<std::size_t> over;           ///< the factor that an adaptive method or an adjustment moves along
  int up = 1, down = 3;                      ///< of `up_down`: wrong and right answers in a row until a step
  int reversals = 8;                         ///< of `up_down`: a track ends after so many
  int trials = 60;                           ///< of an adaptive track, at most
  double catches = 0.5;                      ///< share of trials in which the standard alone is presented
  std::string ask;                           ///< the question of each trial; empty: the task's own
  std::vector<ExperimentQuestion> questions; ///< after each trial
  std::vector<ExperimentQuestion> closing;   ///< after the last one
  bool random = true;                        ///< each block in a random order of its own, otherwise as written
  int practice = 0;                          ///< trials before the first block
  std::vector<std::size_t> practised;        ///< stimuli that are always among these
  int repetitions = 1;                       ///< blocks, each with every stimulus once
  double pause = 0;                          ///< s, of a break; 0: none
  double pause_after = 0;                    ///< s of trials until a break; 0: a break after each block
  double seconds = 3;                        ///< of a presentation
  std::optional<double> longest;             ///< s; longer sessions are marked as excluded
  std::vector<std::string> instructions;     ///< pages
  std::string consent;                       ///< what the participant agrees to; may be empty
  bool masking_required = false;
  std::string masking;                       ///< a sound file; may be empty
  std::string grip;                          ///< how the handle is held; may be empty
  std::string motion = "free";               ///< "free", "lateral", "circular"
  InterruptedSession interrupted{600, 3600, 86400};
};

}  // namespace wale
