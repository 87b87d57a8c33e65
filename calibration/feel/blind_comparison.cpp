#include "calibration/feel/blind_comparison.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "calibration/feel/felt_device.hpp"

namespace wale {
namespace {

constexpr double two_sided_95 = 0.975;

/// Runs one material for some seconds.
class ListeningInterval {
 public:
  ListeningInterval(Device& device, const BlindOptions& options)
      : stage_(device, felt_stage_options(options.most_newton)), options_(options) {}

  Result<> feel(const BlindMaterial& material) {
    if (patch_.exists()) (void)patch_.remove();
    Result<Patch> patch = stage_.add(material.program);
    if (!patch) return patch.error();
    patch_ = *patch;
    const auto& parameters = material.program.description().parameters;
    for (std::size_t i = 0; i < material.parameters.size(); ++i)
      if (const auto set = patch_.set(parameters[i].name, material.parameters[i]); !set) return set.error();
    const auto result = stage_.run(
        {.seconds = options_.seconds, .virtual_time = options_.virtual_time, .progress = {}, .stop = options_.stop});
    if (!result) return result.error();
    if (options_.stop && *options_.stop) return Error{Code::stopped, "interrupted"};
    const auto& run = *result;
    const double felt = static_cast<double>(run.ticks_run + run.ticks_missed) * run.record.seconds_per_tick;
    constexpr double enough = 0.5;  // share of an interval: a shorter one counts as a lost device
    if (felt < enough * options_.seconds)
      return Error{Code::lost_device, fmt::format("the device stopped after {:.1f} s", felt)};
    return {};
  }

 private:
  Stage stage_;
  Patch patch_;
  const BlindOptions& options_;
};

}  // namespace

BlindSession feel_blind(Device& device, const BlindMaterial& a, const BlindMaterial& b, const BlindOptions& options,
                        BlindPerson& person) {
  BlindSession session;
  ListeningInterval interval(device, options);
  for (const bool is_a : {true, false}) {
    person.introduce(is_a);
    if (auto felt = interval.feel(is_a ? a : b); !felt) {
      session.ended = std::move(felt.error());
      return session;
    }
  }
  std::mt19937_64 random(options.seed);
  for (int trial = 1; trial <= options.trials; ++trial) {
    const bool a_first = random() >> 63 != 0;
    for (const int which : {1, 2}) {
      person.begin(trial, which);
      if (auto felt = interval.feel((which == 1) == a_first ? a : b); !felt) {
        session.ended = std::move(felt.error());
        return session;
      }
    }
    const Result<int> answer = person.answer(trial);
    if (!answer) {
      session.ended = answer.error();
      return session;
    }
    session.trials.push_back({a_first, *answer});
    person.learn(trial, session.trials.back().right());
  }
  return session;
}

double proportion_right(double sensitivity) { return 0.5 * std::erfc(-0.5 * sensitivity); }

BlindScore blind_score(int right, int trials) {
  BlindScore score{.right = right, .trials = trials};
  const double n = trials, p = right / n, z = normal_quantile(two_sided_95);
  score.proportion = p;
  // E. B. Wilson 1927, Probable inference, J. Am. Stat. Assoc. 22:209.
  const double centre = (p + z * z / (2 * n)) / (1 + z * z / n);
  const double half = z / (1 + z * z / n) * std::sqrt(p * (1 - p) / n + z * z / (4 * n * n));
  score.low = right == 0 ? 0 : centre - half;
  score.high = right == trials ? 1 : centre + half;
  score.sensitivity = sensitivity(Task::forced_choice, std::clamp(p, 0.5 / n, 1 - 0.5 / n)) + 0.0;  // turns -0 into 0
  if (score.low > 0) score.sensitivity_low = sensitivity(Task::forced_choice, score.low);
  if (score.high < 1) score.sensitivity_high = sensitivity(Task::forced_choice, score.high);
  double likely = 0;
  for (int k = right; k <= trials; ++k)
    likely += std::exp(std::lgamma(n + 1) - std::lgamma(k + 1.0) - std::lgamma(n - k + 1) - n * std::log(2.0));
  score.by_chance = std::min(likely, 1.0);
  return score;
}

}  // namespace wale
