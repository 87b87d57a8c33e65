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

/// One of the two that are felt.
struct BlindMaterial {
  Program program;
  std::vector<float> parameters;  ///< SI
};

/// Two intervals, A in one of them and B in the other, and what the person said.
struct BlindTrial {
  bool a_first = false;
  int answer = 0;  ///< the interval that A was felt in, by the person: 1 or 2

  bool right() const { return (answer == 1) == a_first; }
};

struct BlindOptions {
  int trials = 12;
  std::uint64_t seed = 0;         ///< of the order: each trial's is drawn for itself, both orders as likely
  double seconds = 3;             ///< of an interval
  double most_newton = HUGE_VAL;  ///< the largest force that the user allows
  bool virtual_time = false;
  const std::atomic<bool>* stop = nullptr;  ///< as in `RunOptions`
};

/// Who feels: is told when something is about to be felt, and asked. Nothing that it is told before an answer depends
/// on the order.
class BlindPerson {
 public:
  virtual ~BlindPerson() = default;
  /// A or B by name, to get to know them, before the first trial.
  virtual void introduce(bool is_a) = 0;
  /// Interval 1 or 2 of a trial, counted from 1.
  virtual void begin(int trial, int interval) = 0;
  /// In which interval A was, 1 or 2; nothing ends it.
  virtual std::optional<int> answer(int trial) = 0;
  virtual void learn(int trial, bool right) = 0;
};

struct BlindSession {
  std::vector<BlindTrial> trials;  ///< those that were answered
  std::string ended;               ///< why before the last: what the device or the person did; empty where it did not
};

/// Two-interval forced choice: which of two was A? A and B are felt once by name, then in pairs in random order, on the
/// one device, until the trials are over, the person or `stop` ends it, or the device gives up.
BlindSession feel_blind(Device& device, const BlindMaterial& a, const BlindMaterial& b, const BlindOptions& options,
                        BlindPerson& person);

/// What so many right answers say.
struct BlindScore {
  int right = 0, trials = 0;
  double proportion = 0;     ///< of right answers
  double low = 0, high = 1;  ///< its 95 % interval (Wilson 1927)
  /// sqrt(2) z(proportion), as thresholds of forced choice are normalised (Macmillan and Creelman 2005, chapter 7). All
  /// right counts as half an answer wrong, and none as half a one right (the same, chapter 1).
  double sensitivity = 0;
  std::optional<double> sensitivity_low, sensitivity_high;  ///< by the interval's ends; nothing where there is no end
  double by_chance = 1;                                     ///< how likely as many or more are when guessing
};

/// `trials` above 0, `right` of them from 0 on.
BlindScore blind_score(int right, int trials);

/// The share of right answers of a person to whom they are so far apart: Phi(d' / sqrt(2)).
double proportion_right(double sensitivity);

/// A session, and what `compare` predicts of the two.
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
