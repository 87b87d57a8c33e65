// Virtual studies of the roughness design: planted observers feel its executed programs, and the analysis finds them
// out.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <functional>
#include <iterator>
#include <map>

#include "calibration/analysis/magnitude.hpp"
#include "calibration/experiment/planted_observer.hpp"
#include "calibration/experiment/presenter.hpp"
#include "tests/experiments/texts.hpp"
#include "wale/simulated.hpp"

namespace wale::experiments_test {
namespace {

std::string text_of(const std::string& path) {
  std::ifstream file(std::string(WALE_SOURCE_DIR) + path);
  return {std::istreambuf_iterator<char>(file), {}};
}

/// A device whose motors give no more than so many N, as a clipped waveform is.
class ClippedDevice final : public Device {
 public:
  ClippedDevice(std::unique_ptr<Device> device, float most) : device_(std::move(device)), most_(most) {}

  const DeviceProfile& profile() const noexcept override { return device_->profile(); }
  void elapse(long periods) noexcept override { device_->elapse(periods); }
  Reading sample() noexcept override { return device_->sample(); }
  Force command(Force force) noexcept override {
    return device_->command({std::clamp(force.x, -most_, most_), std::clamp(force.y, -most_, most_)});
  }

 private:
  std::unique_ptr<Device> device_;
  float most_;
};

/// The thirty gratings of chapter 5: what each did to the hand, when it was executed once.
struct RoughnessDesign {
  Design design{text_of("/calibration/experiments/minsky1995_chapter5.wale")};
  std::map<std::string, std::string> amplitudes;  // N, by the stimulus's name
  std::vector<FeltSize> felt;

  /// `change` makes another device of the simulated one, which gives at most `most` N.
  explicit RoughnessDesign(
      const std::function<void(DeviceProfile&)>& change = [](DeviceProfile&) {}, float most = HUGE_VALF) {
    const auto table =
        analysis::read_table("stimuli", text_of("/calibration/experiments/minsky1995_chapter5_stimuli.csv"));
    for (std::size_t row = 0; row < table->rows(); ++row) amplitudes.emplace(table->cell(row, 0), table->cell(row, 1));
    const auto ready = design.ready();
    DevicePresenter presenter(
        [&](const Program& program) -> Result<FeltDevice> {
          DeviceProfile profile = program.description().device;
          change(profile);
          std::unique_ptr<Device> joystick =
              std::make_unique<SimulatedJoystick>(profile, HandModel{0.55, 6.5, 135}, Lateral{0.04, 1});
          return FeltDevice{std::make_unique<ClippedDevice>(std::move(joystick), most), nullptr, "simulated", "lateral",
                            true};
        },
        {.seconds = 3, .virtual_time = true, .folder = {}, .recordings = {}});
    for (const Program& each : ready.stimuli) felt.push_back(*presenter.present(each, ""));
  }
};

const RoughnessDesign& roughness_design() {
  static const RoughnessDesign design;
  return design;
}

/// Fifteen observers, whose exponents differ, in all three runs.
analysis::Trials study(std::uint32_t seed, PlantedLaw law, double exponent, double spread,
                       const RoughnessDesign& of = roughness_design()) {
  const CheckedExperiment& experiment = of.design.experiment();
  const Asked asked = questions_of_trial(experiment).front();
  std::string text = "participant,run,trial,amplitude,response\n";
  for (std::uint32_t person = 0; person < 15; ++person) {
    const std::uint32_t own = seed * 100 + person;
    law.exponent = std::max(0.0, exponent + spread * Draws(own, 99).normal(0));
    law.modulus = 10 * std::exp(0.5 * Draws(own, 99).normal(1));  // a number scale of one's own
    PlantedObserver observer(experiment, law, own);
    for (const Trial& trial : trial_order(experiment, own)) {
      observer.begin(trial, 0, 1, 1);
      observer.felt({false, trial.stimulus}, of.felt[trial.stimulus]);
      const auto answer = observer.say({.kind = Question::Kind::trial, .says = {}, .asked = &asked, .trial = &trial});
      if (trial.block == 0) continue;
      text += fmt::format("P{},{},{},{},{}\n", person, trial.block, trial.number,
                          of.amplitudes.at(experiment.stimuli[trial.stimulus].name), *answer);
    }
  }
  const auto table = analysis::read_table("study", text);
  const auto trials = analysis::read_trials(*table, {.sizes = {{"amplitude", "", "N"}}});
  EXPECT_TRUE(trials) << trials.error().sentence;
  return *trials;
}

/// In how many of 200 studies the intervals hold the planted exponent and spread.
void expect_coverage(double exponent) {
  constexpr double spread = 0.15;
  int covered = 0, spread_covered = 0;
  for (std::uint32_t seed = 1; seed <= 200; ++seed) {
    const auto fit = analysis::analyse_magnitudes(
        study(seed, {.threshold = 0, .noise = 0.2, .feels_actuator = true}, exponent, spread),
        {.size = {}, .alternatives = false});
    ASSERT_TRUE(fit) << seed << ": " << fit.error().sentence;
    covered += fit->exponent.low() <= exponent && exponent <= fit->exponent.high();
    spread_covered += fit->spread_interval && fit->spread_interval->holds(spread);
  }
  EXPECT_GE(covered, 181) << exponent;
  EXPECT_GE(spread_covered, 181) << exponent;
}

TEST(VirtualStudies, IntervalsCoverWhatWasPlanted) {
  for (const double exponent : {0.55, 0.76, 1.2}) expect_coverage(exponent);
}

/// Of those who feel the force between hand and handle, the truth is the regression of noise-free observers. With a law
/// that is a power, their slopes are in proportion to their exponents, so that the mean of any number of them is that of
/// one with the mean exponent.
TEST(VirtualStudies, IntervalsOfInteractionCoverItsOwnTruth) {
  constexpr double exponent = 0.76;
  const double truth = analysis::regress_means(study(1, {.threshold = 0, .noise = 0}, exponent, 0), "amplitude", false)
                           ->regression.coefficients[1]
                           .value;
  int covered = 0;
  double mean = 0;
  for (std::uint32_t seed = 1; seed <= 200; ++seed) {
    const auto fit = analysis::analyse_magnitudes(study(seed, {.threshold = 0, .noise = 0.2}, exponent, 0.15),
                                                  {.size = {}, .intervals_of_spread = false, .alternatives = false});
    ASSERT_TRUE(fit) << seed << ": " << fit.error().sentence;
    covered += fit->exponent.low() <= truth && truth <= fit->exponent.high();
    mean += fit->exponent.value / 200;
  }
  EXPECT_GE(covered, 181);
  EXPECT_NEAR(mean, truth, 0.01);
  // What the handle's mass and friction do to the exponent of the commanded force.
  RecordProperty("bias_against_the_planted_exponent", fmt::format("{:.4f}", mean - exponent));
  EXPECT_GT(std::abs(truth - exponent), 0.01);
}

/// Those who feel the force between hand and handle contradict the actuator's: the same exponent, and another slope
/// over the commanded level.
TEST(VirtualStudies, TheHandleIsHeardOf) {
  const PlantedLaw law{.threshold = 0, .noise = 0};
  PlantedLaw actuator = law;
  actuator.feels_actuator = true;
  const auto slope = [](const analysis::Trials& trials) {
    return analysis::regress_means(trials, "amplitude", false)->regression.coefficients[1].value;
  };
  const double by_actuator = slope(study(1, actuator, 0.76, 0)), by_interaction = slope(study(1, law, 0.76, 0));
  EXPECT_NEAR(by_actuator, 0.76, 0.02);
  EXPECT_GT(std::abs(by_interaction - by_actuator), 0.01);
}

/// The exponent of fifteen observers who feel the force between hand and handle.
analysis::Coefficient interaction_exponent(const RoughnessDesign& of) {
  const PlantedLaw law{.threshold = 0, .noise = 0.1};
  return analysis::analyse_magnitudes(study(5, law, 0.76, 0.02, of),
                                      {.size = {}, .intervals_of_spread = false, .alternatives = false})
      ->exponent;
}

/// The crossed design, executed: those whose roughness depends on the period are found out, and others are not. Without
/// the period there is no such alternative to compare.
TEST(VirtualStudies, TheCrossedDesignFindsOutWhoFeelsPeriods) {
  const Design design(text_of("/calibration/experiments/crossed.wale"));
  const CheckedExperiment& experiment = design.experiment();
  const auto ready = design.ready();
  DevicePresenter presenter(
      [&](const Program& program) -> Result<FeltDevice> {
        return FeltDevice{std::make_unique<SimulatedJoystick>(program.description().device, HandModel{0.55, 6.5, 135}, Lateral{0.04, 1}),
                          nullptr, "simulated", "lateral", true};
      },
      {.seconds = 2, .virtual_time = true, .folder = {}, .recordings = {}});
  std::vector<FeltSize> felt;
  for (const Program& each : ready.stimuli) felt.push_back(*presenter.present(each, ""));
  const Asked asked = questions_of_trial(experiment).front();
  const auto level = [&](const Trial& trial, const char* name) {
    const auto factor = std::ranges::find(experiment.factors, name, &ExperimentFactor::name) - experiment.factors.begin();
    return *experiment.factors[static_cast<std::size_t>(factor)].levels[*experiment.stimuli[trial.stimulus].levels[static_cast<std::size_t>(factor)]].value;
  };
  const auto p_of_period = [&](double by_period, bool with_period) {
    std::string text = "participant,run,trial,amplitude,period,response\n";
    for (std::uint32_t person = 0; person < 8; ++person) {
      PlantedLaw law{.threshold = 0, .noise = 0.15, .feels_actuator = true};
      law.period = by_period;
      law.exponent = 0.76 + 0.1 * Draws(person, 99).normal(0);
      PlantedObserver observer(experiment, law, person);
      for (const Trial& trial : trial_order(experiment, person)) {
        observer.begin(trial, 0, 1, 1);
        observer.felt({false, trial.stimulus}, felt[trial.stimulus]);
        const auto answer = observer.say({.kind = Question::Kind::trial, .says = {}, .asked = &asked, .trial = &trial});
        if (trial.block == 0) continue;
        text += fmt::format("P{},{},{},{},{},{}\n", person, trial.block, trial.number, level(trial, "amplitude"),
                            level(trial, "period"), *answer);
      }
    }
    analysis::TrialColumns columns{.sizes = {{"amplitude", "", "N"}}};
    if (with_period) columns.sizes.push_back({"period", "", "m"});
    const auto table = analysis::read_table("crossed", text);
    const auto trials = analysis::read_trials(*table, columns);
    EXPECT_TRUE(trials) << trials.error().sentence;
    const auto fit = analysis::analyse_magnitudes(*trials, {.size = "amplitude", .intervals_of_spread = false});
    EXPECT_TRUE(fit) << fit.error().sentence;
    std::optional<double> p;
    for (const analysis::Alternative& each : fit->alternatives)
      if (each.name.find("period") != std::string::npos && (!p || each.comparison.p < *p)) p = each.comparison.p;
    return p;
  };
  EXPECT_LT(p_of_period(0.5, true).value_or(1), 1e-6);
  EXPECT_GT(p_of_period(0, true).value_or(0), 1e-3);
  EXPECT_FALSE(p_of_period(0.5, false)) << "without the period, nothing is said of it";
}

/// A handle with three times the friction gives another map, by more than the map's interval.
TEST(VirtualStudies, TripledFrictionShows) {
  const analysis::Coefficient whole = interaction_exponent(roughness_design());
  const analysis::Coefficient changed =
      interaction_exponent(RoughnessDesign([](DeviceProfile& profile) { profile.friction *= 3; }));
  EXPECT_TRUE(changed.value < whole.low() || changed.value > whole.high())
      << changed.value << " is within " << whole.low() << " to " << whole.high();
}

/// So does a waveform that is clipped at 1 N, the same for all stimuli.
TEST(VirtualStudies, AClippedWaveformShows) {
  const analysis::Coefficient whole = interaction_exponent(roughness_design());
  const analysis::Coefficient clipped = interaction_exponent(RoughnessDesign([](DeviceProfile&) {}, 1));
  EXPECT_LT(clipped.value, whole.low()) << "larger stimuli are clipped more";
}

/// A delay of 10 ms makes no other map, and cannot: the force comes later over the same gratings, so its size stays
/// what it was within 2 %, and planted observers feel sizes. What a delay does change, the phase between motion and
/// force, no law of theirs knows.
TEST(VirtualStudies, ADelayLeavesTheSizesAsTheyAre) {
  const RoughnessDesign delayed([](DeviceProfile& profile) { profile.delay_x = profile.delay_y += 0.01; });
  for (std::size_t i = 0; i < delayed.felt.size(); ++i)
    EXPECT_NEAR(delayed.felt[i].interaction.size / roughness_design().felt[i].interaction.size, 1, 0.02) << i;
  const analysis::Coefficient whole = interaction_exponent(roughness_design()), late = interaction_exponent(delayed);
  EXPECT_TRUE(whole.low() < late.value && late.value < whole.high()) << late.value;
}

/// Observers whose answers bend with a threshold, or go along with the answer before, are found out.
TEST(VirtualStudies, AlternativesFindOutOtherLaws) {
  const auto p_of = [](const PlantedLaw& law, const std::string& name) {
    const auto fit =
        analysis::analyse_magnitudes(study(3, law, 0.76, 0.05), {.size = {}, .intervals_of_spread = false});
    for (const analysis::Alternative& each : fit->alternatives)
      if (each.name.starts_with(name)) return each.comparison.p;
    return -1.0;
  };
  const PlantedLaw plain{.threshold = 0, .noise = 0.2, .feels_actuator = true};
  PlantedLaw bent = plain, carrying = plain;
  bent.threshold = 0.1, carrying.carry_over = 0.3;
  EXPECT_LT(p_of(bent, "quadratic"), 1e-6);
  EXPECT_LT(p_of(carrying, "with carry-over"), 1e-6);
  EXPECT_GT(p_of(plain, "with carry-over"), 0.01);
}

}  // namespace
}  // namespace wale::experiments_test
