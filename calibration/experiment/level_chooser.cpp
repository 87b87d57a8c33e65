#include "calibration/experiment/level_chooser.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "calibration/analysis/quest_plus.hpp"

namespace wale {
namespace {

class UpDown final : public LevelChooser {
 public:
  explicit UpDown(const UpDownRule& rule)
      : rule_(rule), at_(rule.levels - 1), step_(std::max<std::size_t>(1, rule.levels / 4)) {}

  std::size_t next() const override { return at_; }
  bool over() const override { return reversals_ >= rule_.reversals || taken_ >= rule_.trials; }

  void take(std::size_t, bool right) override {
    ++taken_;
    (right ? right_ : wrong_) += 1;
    (right ? wrong_ : right_) = 0;
    if (right && right_ >= rule_.down) move(-1);
    if (!right && wrong_ >= rule_.up) move(1);
  }

 private:
  void move(int direction) {
    right_ = wrong_ = 0;
    if (direction_ != 0 && direction != direction_) {
      ++reversals_;
      step_ = std::max<std::size_t>(1, step_ / 2);
    }
    direction_ = direction;
    at_ = direction < 0 ? at_ - std::min(at_, step_) : std::min(at_ + step_, rule_.levels - 1);
  }

  UpDownRule rule_;
  std::size_t at_, step_;
  int right_ = 0, wrong_ = 0, direction_ = 0, reversals_ = 0, taken_ = 0;
};

constexpr std::array slopes = {1.0, 2.0, 3.5, 5.0, 7.0};

/// QUEST+ of the analysis, over levels of a Weibull function.
class WeibullChooser final : public LevelChooser {
 public:
  explicit WeibullChooser(const QuestPlusRule& rule)
      : trials_(rule.trials),
        beliefs_({rule.levels}, {rule.levels, {slopes.begin(), slopes.end()}}, 2,
                 [&rule](std::size_t outcome, const std::vector<double>& level, const std::vector<double>& of) {
                   const double felt = 1 - std::exp(-std::pow(level[0] / of[0], of[1]));
                   const double right = rule.guess + (1 - rule.guess - rule.lapse) * felt;
                   return outcome == 0 ? right : 1 - right;
                 }) {}

  std::size_t next() const override { return beliefs_.next_number(1e-9); }
  bool over() const override { return beliefs_.answers() >= static_cast<std::size_t>(trials_); }
  void take(std::size_t level, bool right) override { beliefs_.update(level, right ? 0 : 1); }

 private:
  int trials_;
  analysis::QuestPlus beliefs_;  // each level may be the threshold, with each slope
};

}  // namespace

std::unique_ptr<LevelChooser> up_down(const UpDownRule& rule) { return std::make_unique<UpDown>(rule); }
std::unique_ptr<LevelChooser> quest_plus(const QuestPlusRule& rule) { return std::make_unique<WeibullChooser>(rule); }

std::unique_ptr<LevelChooser> chooser_of(const CheckedExperiment& experiment, const std::vector<double>& levels) {
  if (experiment.method == TrialMethod::up_down || levels.front() <= 0)
    return up_down({levels.size(), experiment.up, experiment.down, experiment.reversals, experiment.trials});
  // Without a forced choice, guesses are rare and not known beforehand.
  constexpr double rare = 0.1;
  return quest_plus({levels, experiment.task == TrialTask::two_interval ? 0.5 : rare, 0.02, experiment.trials});
}

}  // namespace wale
