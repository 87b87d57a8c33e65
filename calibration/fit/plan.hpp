#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "compiler/expression/checked_experiment.hpp"
#include "wale/result.hpp"

namespace wale {

/// What people are taken to be like, and how well a study is to know it. All of it is the experimenter's assumption.
struct PlanRequest {
  double precision = 0;       ///< the half width of the 95 % interval: of an exponent, or of a threshold's logarithm
  double share = 0.8;         ///< of studies that are to be so precise, above 0, below 1
  std::size_t studies = 200;  ///< that are simulated for each number of people
  std::size_t most = 100;     ///< people
  std::uint64_t seed = 1;
  double exponent = 0.76, spread = 0.2;  ///< of the observers' exponents: mean and standard deviation
  double noise = 0.15;                   ///< standard deviation of log10 of single answers
  double numbers = 0.3;                  ///< standard deviation of log10 of the observers' use of numbers
  std::optional<double> threshold;       ///< in the factor's unit, or of a ratio over 1; none: the middle of the levels
  double threshold_spread = 0.3;         ///< standard deviation of its natural logarithm between observers
  double growth = 1;     ///< exponent of d' over the difference: 1 is in proportion
  double lapse = 0.02;   ///< how far answers about thresholds stay from 0 and 1
  double criterion = 1;  ///< of "yes", in units of d': "yes" to nothing in 16 % of the trials
  std::string over;                      ///< the factor; empty: the first with numbers, or that of the method
  std::vector<double> sizes;  ///< of the stimuli in their order, for designs without factors; otherwise empty
};

/// What simulated studies with so many people gave.
struct PlanStep {
  std::size_t people = 0;
  double half_width = 0;  ///< that the asked share of the studies stays below
  double precise = 0;     ///< share of the studies whose interval is narrow enough
  double covered = 0;     ///< share of the studies whose interval holds the truth
};

struct Plan {
  std::string sought;                 ///< "exponent of amplitude", "threshold of ratio"
  std::size_t trials = 0;             ///< of one person and standard, without practice; of adaptive methods the most
  std::vector<PlanStep> steps;        ///< in the order of their people
  std::optional<std::size_t> people;  ///< the fewest that are enough; none within `most`
};

/// Finds how many people a design needs, by simulation. The same seed gives the same plan on every machine.
///
/// Errors (W0801): tasks that seek neither an exponent nor a threshold; an unknown factor; sizes at or below zero;
/// (W0802) designs with which no study determines what is sought.
Result<Plan> plan_experiment(const CheckedExperiment& experiment, const PlanRequest& request);

}  // namespace wale
