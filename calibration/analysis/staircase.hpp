#pragma once

#include <cstddef>
#include <optional>
#include <vector>

namespace wale::analysis {

/// A transformed up-down method (Levitt 1971): the size goes down after `down` right answers in a row and up after `up`
/// wrong ones. With `up` 1 it stays about the size at which 0.5^(1/down) of the answers are right: 70.7 % for 2, 79.4 %
/// for 3.
struct StaircaseRule {
  double start = 1;
  int down = 2, up = 1;                    ///< from 1 on
  std::vector<double> factors = {2, 1.25};  ///< the size is divided or multiplied by the next one after each reversal,
                                            ///< the last one for the rest; above 1
  double least = 0, most = 0;              ///< limits of the size; 0: none
  std::size_t reversals = 8;               ///< the run ends after so many
  std::size_t discarded = 2;               ///< of them, before the estimate begins
  std::size_t most_trials = 200;
};

/// A run by such a rule. A value: to go on after an interruption is to give a new one the same answers.
class Staircase {
 public:
  explicit Staircase(StaircaseRule rule) : rule_(std::move(rule)), size_(rule_.start) {}

  double size() const { return size_; }  ///< to present next
  void update(bool right);
  bool finished() const { return reversals_.size() >= rule_.reversals || trials_ >= rule_.most_trials; }
  /// The sizes at which the direction changed.
  const std::vector<double>& reversals() const { return reversals_; }
  std::size_t trials() const { return trials_; }
  /// The geometric mean of an even number of the last reversals, without the discarded ones; nothing before there are
  /// two.
  std::optional<double> estimate() const;
  /// The share of right answers at the size that a run converges to; with `up` 1.
  static double converges_to(int down);

 private:
  void move(int direction);

  StaircaseRule rule_;
  double size_;
  int right_ = 0, wrong_ = 0, direction_ = 0;
  std::size_t trials_ = 0;
  std::vector<double> reversals_;
};

}  // namespace wale::analysis
