#pragma once

#include <map>
#include <optional>
#include <string>
#include <string_view>

#include "calibration/experiment/participant.hpp"

namespace wale {

/// What a planted observer is like. None of it comes from a map.
struct PlantedLaw {
  double exponent = 0.76;   ///< of the felt force
  double threshold = 0.05;  ///< N: less is not felt
  double modulus = 10;      ///< the number for a felt force of 1 N
  double waveform = 0;      ///< exponent of the force's frequency over 30 Hz: above 0, sharp ridges feel rougher
  double period = 0;        ///< exponent of the distance between ridges over 2.5 mm
  double carry_over = 0;    ///< exponent of the magnitude of the trial before over the present one
  double noise = 0.1;       ///< standard deviation of the natural logarithm of a magnitude
  double lapse = 0;         ///< probability of an answer by chance, where there are right ones
  bool feels_actuator = false;  ///< the actuator's force alone, not that between hand and handle
};

/// Reads `exponent=0.55,noise=0.2`, the part of `--observer planted:…` behind the colon; an empty text is the defaults.
/// Names are those of `PlantedLaw`, with `carry` for the carry-over and `feels=actuator` or `feels=interaction`. Error:
/// `malformed_value`.
Result<PlantedLaw> read_planted_law(std::string_view text);

/// A simulated participant whose answers come from the force at the handle. Each answer is a function of the seed, the
/// trial and what was felt, so that a trial that is redone after an interruption has the same answer.
class PlantedObserver final : public Participant {
 public:
  /// `experiment` must outlive it.
  PlantedObserver(const CheckedExperiment& experiment, const PlantedLaw& law, std::uint32_t seed)
      : experiment_(experiment), law_(law), seed_(seed) {}

  void begin(const Trial& trial, std::size_t of, int interval, int intervals) override;
  void felt(const Presented& presented, const FeltSize& felt) override;
  Result<std::string> say(const Question& question) override;
  void refuse(const std::string& why) override;
  void tell(const std::string&) override {}

  /// The magnitude without noise and carry-over; 0 for what is not felt.
  double magnitude(const FeltSize& felt) const;

 private:
  double noisy(double magnitude, const Trial& trial, int interval) const;
  std::string answer(const Question& question);
  std::string adjust();
  std::string sort(const Sort& sort);

  const CheckedExperiment& experiment_;
  PlantedLaw law_;
  std::uint32_t seed_;
  std::vector<double> intervals_;     ///< magnitudes of the present trial
  double standard_ = 0;               ///< magnitude of the latest standard; 0 before there was one
  std::optional<double> before_;      ///< of the trial before
  std::uint32_t trial_ = 0;
  int moves_ = 0;                     ///< in the present adjustment
  bool turned_ = false;
  int direction_ = 0;
  std::map<std::size_t, double> known_;  ///< magnitudes of stimuli, for sorts
  bool stuck_ = false;
};

}  // namespace wale
