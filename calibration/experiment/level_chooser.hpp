#pragma once

#include <cstddef>
#include <memory>
#include <vector>

#include "compiler/expression/checked_experiment.hpp"

namespace wale {

/// Chooses the levels of one adaptive track. What it chooses is a function of the answers so far.
class LevelChooser {
 public:
  virtual ~LevelChooser() = default;
  /// Index of the level to present next. Call it only while the track is not over.
  virtual std::size_t next() const = 0;
  /// The answer to a presentation of that level.
  virtual void take(std::size_t level, bool right) = 0;
  virtual bool over() const = 0;
};

/// A transformed staircase (Levitt 1971): after `down` right answers in a row one step down, after `up` wrong ones one
/// step up. It begins at the highest level with steps of a quarter of all levels, which are halved at each reversal
/// until they are one level. It is over after so many reversals or trials.
struct UpDownRule {
  std::size_t levels = 3;
  int up = 1, down = 3, reversals = 8, trials = 60;
};
std::unique_ptr<LevelChooser> up_down(const UpDownRule& rule);

/// QUEST+ (Watson 2017): the level with the least expected entropy of the threshold and the slope of a Weibull function
/// p = guess + (1 - guess - lapse) (1 - exp(-(level / threshold)^slope)). Each level may be the threshold; slopes are
/// 1, 2, 3.5, 5 and 7, all equally likely at first.
struct QuestPlusRule {
  std::vector<double> levels;  ///< above 0, rising
  double guess = 0.5, lapse = 0.02;
  int trials = 60;
};
std::unique_ptr<LevelChooser> quest_plus(const QuestPlusRule& rule);

/// The chooser of an experiment's method for the given rising levels, SI.
std::unique_ptr<LevelChooser> chooser_of(const CheckedExperiment& experiment, const std::vector<double>& levels);

}  // namespace wale
