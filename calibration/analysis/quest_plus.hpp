#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <vector>

namespace wale::analysis {

/// Values that a stimulus or a model's parameter may take, one vector for each of its dimensions.
using Grid = std::vector<std::vector<double>>;

/// QUEST+ (Watson 2017, J Vision 17(3):10): presents the stimulus whose answer is expected to leave the least entropy in
/// the posterior distribution of a model's parameters. Deterministic: of equal stimuli the first is chosen. Stimuli and
/// parameters are points of grids, whose last dimension runs fastest. A value: to go on after an interruption is to
/// update a new one with the same answers.
class QuestPlus {
 public:
  /// The chance of an outcome, 0 .. 1; over the outcomes the chances of a stimulus and parameters add up to 1.
  using Model = std::function<double(std::size_t outcome, const std::vector<double>& stimulus,
                                     const std::vector<double>& parameters)>;

  /// `prior` has a weight for each point of the parameters, not all zero; empty for equal ones.
  QuestPlus(const Grid& stimuli, const Grid& parameters, std::size_t outcomes, const Model& model,
            std::vector<double> prior = {});

  /// The stimulus to present next, and its number among the stimuli.
  const std::vector<double>& next() const { return stimuli_[next_number()]; }
  /// Of stimuli whose entropies differ by no more than `indifference`, in nats, the first is chosen: above rounding, the
  /// choice is the same on every machine.
  std::size_t next_number(double indifference = 0) const;
  /// The entropy that is expected after a presentation of a stimulus, in nats.
  double expected_entropy(std::size_t stimulus) const;

  /// Takes an answer to the stimulus with that number.
  void update(std::size_t stimulus, std::size_t outcome);

  std::size_t stimulus_count() const { return stimuli_.size(); }
  const std::vector<double>& stimulus(std::size_t number) const { return stimuli_[number]; }
  const std::vector<double>& posterior() const { return posterior_; }
  double entropy() const;
  /// The parameters with the greatest posterior; of equal ones the first.
  const std::vector<double>& mode() const;
  std::vector<double> mean() const;
  /// The standard deviation of each parameter.
  std::vector<double> deviation() const;
  std::size_t answers() const { return answers_; }

 private:
  double chance(std::size_t outcome, std::size_t stimulus, std::size_t point) const {
    return chances_[(outcome * stimuli_.size() + stimulus) * points_.size() + point];
  }

  std::vector<std::vector<double>> stimuli_, points_;
  std::size_t outcomes_ = 0, answers_ = 0;
  std::vector<double> chances_;    // by outcome, stimulus, point
  std::vector<double> self_;       // sum of p log p of the chances: by outcome, stimulus, point
  std::vector<double> posterior_;
};

/// All points of a grid, its last dimension fastest. An empty dimension has no points.
std::vector<std::vector<double>> points_of(const Grid& grid);

/// Weibull's function of a stimulus in dB, as in Watson's examples: the chance of a right answer for parameters
/// threshold (dB), slope, guess rate, lapse rate.
double weibull_in_decibels(double stimulus, double threshold, double slope, double guess, double lapse);

}  // namespace wale::analysis
