#include "calibration/experiment/level_chooser.hpp"

#include <algorithm>
#include <array>
#include <cmath>

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

class QuestPlus final : public LevelChooser {
 public:
  explicit QuestPlus(const QuestPlusRule& rule)
      : trials_(rule.trials),
        levels_(rule.levels.size()),
        belief_(levels_ * slopes.size(), 1.0 / static_cast<double>(levels_ * slopes.size())) {
    for (const double level : rule.levels)
      for (const double threshold : rule.levels)
        for (const double slope : slopes)
          right_.push_back(rule.guess + (1 - rule.guess - rule.lapse) *
                                            (1 - std::exp(-std::pow(level / threshold, slope))));
  }

  std::size_t next() const override {
    std::size_t best = 0;
    double least = HUGE_VAL;
    for (std::size_t level = 0; level < levels_; ++level) {
      const double entropy = expected_entropy(level);
      // Smaller differences are rounding: the first of equals is taken on every machine.
      if (entropy < least - 1e-9) least = entropy, best = level;
    }
    return best;
  }
  bool over() const override { return taken_ >= trials_; }

  void take(std::size_t level, bool right) override {
    ++taken_;
    double sum = 0;
    for (std::size_t i = 0; i < belief_.size(); ++i) {
      const double p = right_[level * belief_.size() + i];
      sum += belief_[i] *= right ? p : 1 - p;
    }
    for (double& each : belief_) each /= sum;
  }

 private:
  double expected_entropy(std::size_t level) const {
    double entropy = 0;
    for (const bool right : {true, false}) {
      double sum = 0, logs = 0;
      for (std::size_t i = 0; i < belief_.size(); ++i) {
        const double p = right_[level * belief_.size() + i];
        const double joint = belief_[i] * (right ? p : 1 - p);
        sum += joint;
        if (joint > 0) logs += joint * std::log(joint);
      }
      if (sum > 0) entropy -= logs - sum * std::log(sum);
    }
    return entropy;
  }

  int trials_, taken_ = 0;
  std::size_t levels_;
  std::vector<double> belief_;  // of each threshold with each slope
  std::vector<double> right_;   // probability of a right answer at each level, for each of them
};

}  // namespace

std::unique_ptr<LevelChooser> up_down(const UpDownRule& rule) { return std::make_unique<UpDown>(rule); }
std::unique_ptr<LevelChooser> quest_plus(const QuestPlusRule& rule) { return std::make_unique<QuestPlus>(rule); }

std::unique_ptr<LevelChooser> chooser_of(const CheckedExperiment& experiment, const std::vector<double>& levels) {
  if (experiment.method == TrialMethod::up_down || levels.front() <= 0)
    return up_down({levels.size(), experiment.up, experiment.down, experiment.reversals, experiment.trials});
  // Without a forced choice, guesses are rare and not known beforehand.
  constexpr double rare = 0.1;
  return quest_plus({levels, experiment.task == TrialTask::two_interval ? 0.5 : rare, 0.02, experiment.trials});
}

}  // namespace wale
