// Planted observers: their answers come from the force at the handle.
#include <fmt/format.h>

#include <cmath>

#include "calibration/experiment/planted_observer.hpp"
#include "calibration/experiment/presenter.hpp"
#include "calibration/experiment/trial_table.hpp"
#include "tests/experiments/texts.hpp"
#include "tests/temporary_folder.hpp"
#include "wale/simulated.hpp"

namespace wale::experiments_test {
namespace {

TEST(PlantedLaws, AreReadAndRefused) {
  const auto law = read_planted_law("exponent=0.55,threshold=0.1,feels=actuator,carry=0.2");
  ASSERT_TRUE(law);
  EXPECT_EQ(law->exponent, 0.55);
  EXPECT_EQ(law->threshold, 0.1);
  EXPECT_EQ(law->carry_over, 0.2);
  EXPECT_TRUE(law->feels_actuator);
  EXPECT_TRUE(read_planted_law(""));
  for (const char* wrong : {"exponent", "exponent=", "exponent=x", "exponent=-1", "exponnt=1", "noise=nan", "feels=all", ",",
                            "noise=1e9", "noise=0.1 "})
    EXPECT_EQ(read_planted_law(wrong).error().code, Code::malformed_value) << wrong;
  EXPECT_EQ(read_planted_law("exponnt=1").error().mend, "did you mean `exponent`?");
}

TEST(PlantedObservers, FollowTheirLaw) {
  const Design made(design("stimulus smooth\ntask rating"));
  PlantedLaw law{.exponent = 0.5, .threshold = 0.1, .modulus = 10};
  const FeltSize felt{{0.5, 0.4, 60}, {1.1, 0.8, 60}, 0.15, true};
  EXPECT_NEAR(PlantedObserver(made.experiment(), law, 1).magnitude(felt), 10 * std::sqrt(0.4), 1e-12);
  law.feels_actuator = true;
  EXPECT_NEAR(PlantedObserver(made.experiment(), law, 1).magnitude(felt), 10, 1e-12);
  law.waveform = 1;  // 60 Hz is twice the usual frequency
  EXPECT_NEAR(PlantedObserver(made.experiment(), law, 1).magnitude(felt), 20, 1e-12);
  law.waveform = 0, law.period = 1;  // 0.15 m/s at 60 Hz: 2.5 mm
  EXPECT_NEAR(PlantedObserver(made.experiment(), law, 1).magnitude(felt), 10, 1e-9);
  law.threshold = 2;
  EXPECT_EQ(PlantedObserver(made.experiment(), law, 1).magnitude(felt), 0);
}

/// A sine of 1 N at 40 Hz over a slow push of 3 N at 0.5 Hz: the texture alone is measured.
TEST(FeltSizes, AreThoseOfTheTexture) {
  Record record{.seconds_per_tick = 0.001, .vibrates = false, .ticks = {}};
  for (int i = 0; i < 4000; ++i) {
    const double t = i * 0.001, slow = 3 * std::sin(2 * 3.14159265 * 0.5 * t), fast = std::sin(2 * 3.14159265 * 40 * t);
    TickRecord tick;
    tick.time = t, tick.inside = true;
    tick.force.x = static_cast<float>(slow + fast), tick.interaction.x = static_cast<float>(slow + 0.5 * fast);
    tick.velocity.x = 0.1f;
    record.ticks.push_back(tick);
  }
  const FeltSize felt = felt_size(record);
  EXPECT_NEAR(felt.actuator.size, 1, 0.06);
  EXPECT_NEAR(felt.interaction.size, 0.5, 0.06);
  EXPECT_NEAR(felt.actuator.frequency, 40, 2);
  EXPECT_NEAR(felt.speed, 0.1, 1e-6);
  EXPECT_EQ(felt_size(Record{}).actuator.size, 0);
}

/// A presentation that is shorter than the measurement's settling is felt too.
TEST(FeltSizes, OfShortPresentationsAreMeasured) {
  for (const int ticks : {300, 500, 600}) {
    Record record{.seconds_per_tick = 0.001, .vibrates = false, .ticks = {}};
    for (int i = 0; i < ticks; ++i) {
      TickRecord tick;
      tick.time = i * 0.001, tick.inside = true;
      tick.force.x = tick.interaction.x = static_cast<float>(std::sin(2 * 3.14159265 * 40 * i * 0.001));
      record.ticks.push_back(tick);
    }
    EXPECT_NEAR(felt_size(record).actuator.size, 1, 0.1) << ticks << " ms";
  }
}

/// An observer with noise says "yes" to a standard in about 16 % of the catch trials, and nearly always to twice it.
TEST(PlantedObservers, SayNoToTheStandard) {
  const Design made(design("stimulus bench(amplitude: 0.8 N * ratio)\nstandard bench(amplitude: 0.8 N)\n"
                           "factor ratio 1.2, 2\ntask one_interval"));
  PlantedObserver observer(made.experiment(), {.exponent = 1, .threshold = 0, .noise = 0.1}, 3);
  const Asked asked = questions_of_trial(made.experiment()).front();
  const auto says_yes = [&](std::uint32_t number, bool is_standard, double force) {
    const Trial trial{number, 1, 0, {{is_standard, 0}}, is_standard ? 0 : 1};
    observer.begin(trial, 0, 1, 1);
    observer.felt({is_standard, 0}, FeltSize{{force, force, 30}, {force, force, 30}, 0.1, true});
    return *observer.say({.kind = Question::Kind::trial, .says = {}, .asked = &asked, .trial = &trial}) == "yes";
  };
  int alarms = 0, hits = 0;
  for (std::uint32_t number = 1; number <= 1000; ++number) alarms += says_yes(number, true, 0.8) ? 1 : 0;
  for (std::uint32_t number = 1001; number <= 2000; ++number) hits += says_yes(number, false, 1.6) ? 1 : 0;
  EXPECT_NEAR(alarms, 159, 35);  // 1 - Phi(1), three standard deviations
  EXPECT_GT(hits, 990);
}

/// What numbers mean is said also where the design has a question of its own.
TEST(Questions, SayTheEndsOfAScaleAndTheModulus) {
  const Design rated(design("stimulus smooth\ntask rating, \"smooth\", \"rough\"\nask \"How is it?\""));
  EXPECT_EQ(questions_of_trial(rated.experiment()).front().says, "How is it? 0 is smooth, 100 is rough.");
  const Design numbered(design("stimulus smooth\ntask magnitude_estimation, modulus 10\nask \"How rough?\""));
  EXPECT_EQ(questions_of_trial(numbered.experiment()).front().says,
            "How rough? The first one is 10; give others numbers in proportion.");
}

/// Seven amplitudes, executed on the simulated joystick: an observer without noise and threshold who feels the actuator
/// gives back the exponent that was planted, and one who feels the interaction force another, which is the handle's
/// doing: the two disagree.
TEST(PlantedObservers, FeelExecutedPrograms) {
  const TemporaryFolder folder;
  const Design made(design("stimulus bench(amplitude: a)\nfactor a 0.2 N .. 2 N, steps 7\ntask magnitude_estimation\npresent 3 s"));
  const auto ready = made.ready();
  const auto slope_of = [&](bool actuator, const std::string& path) {
    const PlantedLaw law{.exponent = 0.55, .threshold = 0, .noise = 0, .feels_actuator = actuator};
    PlantedObserver observer(*ready.experiment, law, 7);
    DevicePresenter presenter(
        [](const Program& program) -> Result<FeltDevice> {
          return FeltDevice{std::make_unique<SimulatedJoystick>(program.description().device, HandModel{0.55, 6.5, 135},
                                                                Lateral{0.04, 1}),
                            nullptr, "simulated", "lateral", true};
        },
        {.seconds = 3, .virtual_time = true, .folder = folder.path().string(), .recordings = "recordings" + path});
    auto log = SessionLog::create(folder / path, {.participant = "P1", .seed = 7, .device = "sandpaper", .file = {},
                                                  .versions = {}, .experiment = "test", .grade = "simulated"});
    EXPECT_TRUE(log_design(*log, ready, 7));
    TrialSession session(*ready.experiment, 7);
    const auto end = run_experiment(ready, session, *log, presenter, observer);
    EXPECT_TRUE(end && !end->stopped) << (end ? "" : end.error().sentence);
    const auto table = trial_table(*open_session_log(folder / path), path);
    double n = 0, sx = 0, sy = 0, sxx = 0, sxy = 0;
    for (const auto& row : table->rows) {
      const double x = std::log(std::stod(row[*table->column("a")])), y = std::log(std::stod(row[*table->column("response")]));
      n += 1, sx += x, sy += y, sxx += x * x, sxy += x * y;
      EXPECT_EQ(row[*table->column("grade")], "simulated");
      EXPECT_TRUE(std::filesystem::exists(folder.path() / row[*table->column("stim_file")]));
    }
    EXPECT_EQ(n, 7);
    return (n * sxy - sx * sy) / (n * sxx - sx * sx);
  };
  EXPECT_NEAR(slope_of(true, "actuator"), 0.55, 0.02);
  const double felt = slope_of(false, "interaction");
  EXPECT_GT(felt, 0.2);
  EXPECT_LT(felt, 0.9);
  EXPECT_GT(std::abs(felt - 0.55), 0.005);
}

/// The answer to a trial depends on the trial and the seed alone, so a trial that is redone has the same answer.
TEST(PlantedObservers, AnswerARedoneTrialAlike) {
  const Design made(design("stimulus smooth\ntask magnitude_estimation"));
  const Asked asked = questions_of_trial(made.experiment()).front();
  const Trial trial{5, 1, 0, {{false, 0}}, 0};
  const auto answer = [&](std::uint32_t seed, int before) {
    PlantedObserver observer(made.experiment(), {}, seed);
    for (int i = 0; i < before; ++i) (void)observer.say({.kind = Question::Kind::rest});
    observer.begin(trial, 9, 1, 1);
    observer.felt({false, 0}, FeltSize{{1, 1, 30}, {1, 1, 30}, 0.1, true});
    return *observer.say({.kind = Question::Kind::trial, .says = {}, .asked = &asked, .trial = &trial});
  };
  EXPECT_EQ(answer(1, 0), answer(1, 3));
  EXPECT_NE(answer(1, 0), answer(2, 0));
}

}  // namespace
}  // namespace wale::experiments_test
