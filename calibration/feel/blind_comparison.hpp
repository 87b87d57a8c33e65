#pragma once

#include <atomic>
#include <cmath>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "compiler/compare/compare.hpp"
#include "wale/stage.hpp"

namespace wale {

/// One of the two materials.
struct BlindMaterial {
  Program program;
  std::vector<float> parameters;  ///< SI
};

/// Two intervals, A in one of them and B in the other, and the person's answer.
struct BlindTrial {
  bool a_first = false;
  int answer = 0;  ///< the interval in which the person believes A was: 1 or 2

  bool right() const { return (answer == 1) == a_first; }
};

struct BlindOptions {
  int trials = 12;
  std::uint64_t seed = 0;         ///< of the random order of each trial; both orders are equally likely
  double seconds = 3;             ///< of an interval
  double most_newton = HUGE_VAL;  ///< the largest force that the user allows
  bool virtual_time = false;
  const std::atomic<bool>* stop = nullptr;  ///< as in `RunOptions`
};

/// The person who feels. The calls say what comes next, and ask. Before an answer, no call depends on the order, except
/// `introduce`.
class BlindPerson {
 public:
  virtual ~BlindPerson() = default;
  /// Before the first trial: A or B comes next, and is named.
  virtual void introduce(bool is_a) = 0;
  /// Interval 1 or 2 of a trial comes next; trials are counted from 1.
  virtual void begin(int trial, int interval) = 0;
  /// The interval in which A was, 1 or 2. An error ends the session, and says why there is no answer.
  virtual Result<int> answer(int trial) = 0;
  virtual void learn(int trial, bool right) = 0;
};

struct BlindSession {
  std::vector<BlindTrial> trials;  ///< the answered ones
  std::optional<Error> ended;      ///< why it ended before the last trial; empty if it did not
};

/// Two-interval forced choice: which of two was A? The person feels A and B once by name, then pairs in random order,
/// on one device, until the trials are over, the person or `stop` ends the session, or the device is lost.
BlindSession feel_blind(Device& device, const BlindMaterial& a, const BlindMaterial& b, const BlindOptions& options,
                        BlindPerson& person);

/// The statistics of a number of right answers.
struct BlindScore {
  int right = 0, trials = 0;
  double proportion = 0;     ///< of right answers
  double low = 0, high = 1;  ///< its 95 % interval (Wilson 1927)
  /// d' = sqrt(2) z(proportion), as for all thresholds of forced choice (Macmillan and Creelman 2005, chapter 7). If
  /// all answers are right, half an answer counts as wrong, and the reverse (chapter 1).
  double sensitivity = 0;
  std::optional<double> sensitivity_low, sensitivity_high;  ///< of the interval's ends; empty for an open end
  double by_chance = 1;                                     ///< the probability of as many or more by guessing
};

/// `trials` is above 0, `right` in 0 .. `trials`.
BlindScore blind_score(int right, int trials);

/// The share of right answers at a sensitivity d': Phi(d' / sqrt(2)).
double proportion_right(double sensitivity);

/// A session, and the prediction of `compare`.
struct BlindReport {
  std::string a, b, device;
  std::uint64_t seed = 0;
  int asked = 0;  ///< trials
  BlindSession session;
  Comparison predicted;
};

std::string blind_text(const BlindReport& report);
std::string blind_json(const BlindReport& report);

}  // namespace wale
