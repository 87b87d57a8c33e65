#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <optional>
#include <utility>
#include <vector>

#include "calibration/analysis/one_observer.hpp"

namespace wale::analysis {

/// The range of exponents of d'.
inline constexpr double least_exponent = 0.2, most_exponent = 10;

/// Lapse rates from 0 to the most as a coordinate without ends: a squared sine, so that the rate 0 can be reached.
inline double lapse_at(double coordinate, double most) { return most * std::pow(std::sin(coordinate), 2); }
inline double lapse_coordinate(double lapse, double most) { return std::asin(std::sqrt(lapse / most)); }

/// What all observers have in common.
struct Shared {
  double exponent = 1, lapse = 0, log_likelihood = -HUGE_VAL;
};

/// Observers whose thresholds' logarithms are spread normally. To estimate exponent and lapse rate with a threshold for
/// each observer instead would make the exponent too large, and much so with the few answers of an adaptive track
/// (Neyman and Scott 1948): thresholds are integrated over.
class Population {
 public:
  /// exponent's logarithm, lapse rate, mean and logarithm of the spread of the thresholds' logarithms
  using Place = std::array<double, 4>;

  /// The observers must outlive it.
  Population(std::vector<const OneObserver*> observers, const SensitivityOptions& options);
  Shared best();
  /// Of each chosen observer, in their order.
  std::vector<double> log_likelihoods(const Place& at);
  const Place& place() const { return place_; }
  /// The same with an exponent and a lapse rate, and the mean and spread that suit these best. Call it after `best`.
  std::vector<double> log_likelihoods_with(const Shared& shared);
  /// Where the profile of the mean's likelihood has lost so much, below and above the best place: for each mean with the
  /// exponent, lapse rate and spread that suit it best. Infinite where it never loses as much. Call it after `best`.
  Interval ends_of_mean(double loss);

 private:
  double sum(const Place& at);
  /// The place with the greatest likelihood from a start, with `fixed` for the mean if it is there.
  std::pair<Place, double> climbed(const Place& start, std::optional<double> fixed, double tolerance);
  double end_of_mean(double loss, double direction);

  SensitivityOptions options_;
  std::vector<const OneObserver*> observers_;
  std::vector<double> grid_;
  void along_choices(double exponent, double lapse);

  std::vector<std::vector<double>> along_;  ///< of each observer at the grid, for `known_`; over the most of them
  std::vector<double> most_;                ///< of each observer: the greatest logarithm of those
  std::vector<double> sizes_;               ///< logarithms of all sizes, rising
  struct Counts {
    std::size_t size;
    double right, wrong;
  };
  std::vector<std::vector<Counts>> counts_;  ///< of each observer
  std::array<double, 2> known_ = {HUGE_VAL, HUGE_VAL};
  Place place_{};
  double best_ = -HUGE_VAL;
};

}  // namespace wale::analysis
