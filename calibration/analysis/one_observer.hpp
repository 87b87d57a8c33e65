#pragma once

#include <cmath>
#include <cstddef>
#include <optional>
#include <vector>

#include "calibration/analysis/sensitivity_law.hpp"

namespace wale::analysis {

/// How far from the sizes a threshold is looked for, as a logarithm.
inline constexpr double beyond_sizes = 4;

/// The share of right answers of two intervals, else of "yes" or "different", without lapses.
double chance_of(Decision decision, double d_prime, double criterion);
/// Whether the task's answers depend on a criterion.
inline bool has_criterion(Decision decision) { return decision != Decision::interval_choice; }

/// A threshold's logarithm and a criterion, and the likelihood there.
struct Own {
  double log = 0, criterion = 0, log_likelihood = -HUGE_VAL;
};

/// The likelihood of one observer's answers, given exponent and lapse rate.
class OneObserver {
 public:
  OneObserver(const ObserverAnswers& answers, Decision decision);

  const ObserverAnswers& answers() const { return answers_; }
  double low() const { return low_; }
  double high() const { return high_; }

  double log_likelihood(double log_threshold, double exponent, double lapse, double criterion) const;

  /// With the best criterion.
  double at(double log_threshold, double exponent, double lapse, double* best_criterion = nullptr) const;

  /// The most likely threshold and criterion: by scoring from `near`, else from the best of a grid.
  Own best(double exponent, double lapse, const Own* near = nullptr) const;

  /// The likelihoods of thresholds at the places of a grid, with the best criterion for each.
  void along(const std::vector<double>& grid, double exponent, double lapse, std::vector<double>& result) const;

  /// The likelihood if nothing is felt.
  double nothing_felt(double lapse) const;

 private:
  /// Fisher's scoring: the slope of the likelihood over its expected curvature, by steps that gain. Nothing if it leaves
  /// the range of thresholds or does not come to rest.
  std::optional<Own> scored(const Own& from, double exponent, double lapse, bool criterion_only = false) const;

  double noise_term(double lapse, double criterion) const;

  ObserverAnswers answers_;
  Decision decision_;
  std::vector<double> logs_;
  double low_ = 0, high_ = 0;
};

}  // namespace wale::analysis
