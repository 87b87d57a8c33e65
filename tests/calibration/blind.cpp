// wale feel --blind: scores against closed forms and published tables, and the course of a session.

#include <gtest/gtest.h>

#include <cmath>
#include <sstream>

#include "calibration/feel/asking_person.hpp"
#include "tests/calibration/declared.hpp"
#include "wale/library.hpp"

namespace wale::calibrating {
namespace {

TEST(BlindScore, HasTheIntervalOfWilson) {
  // 9 of 10. Wilson 1927 in closed form with z = 1.959964: (p + z^2/2n -+ z sqrt(p q/n + z^2/4n^2)) / (1 + z^2/n).
  const BlindScore nine = blind_score(9, 10);
  EXPECT_DOUBLE_EQ(nine.proportion, 0.9);
  EXPECT_NEAR(nine.low, 0.5958, 1e-4);  // Brown, Cai and DasGupta 2001
  EXPECT_NEAR(nine.high, 0.9821, 1e-4);
  // All correct: n / (n + z^2) .. 1. None correct: 0 .. z^2 / (n + z^2).
  const double z2 = 1.959963984540054 * 1.959963984540054;
  EXPECT_NEAR(blind_score(12, 12).low, 12 / (12 + z2), 1e-12);
  EXPECT_EQ(blind_score(12, 12).high, 1);
  EXPECT_NEAR(blind_score(0, 12).high, z2 / (12 + z2), 1e-12);
  EXPECT_EQ(blind_score(0, 12).low, 0);
}

TEST(BlindScore, HasTheSensitivityOfForcedChoice) {
  // Macmillan and Creelman 2005, two-alternative forced choice: 76 % correct is d' = 1, 50 % is d' = 0.
  EXPECT_NEAR(blind_score(76, 100).sensitivity, 1, 0.002);
  EXPECT_NEAR(blind_score(6, 12).sensitivity, 0, 1e-12);
  EXPECT_NEAR(blind_score(9, 12).sensitivity, 0.9538725524, 1e-9);
  EXPECT_NEAR(blind_score(3, 12).sensitivity, -0.9538725524, 1e-9);
  // Twelve of twelve count as eleven and a half: sqrt(2) z(0.958333).
  EXPECT_NEAR(blind_score(12, 12).sensitivity, std::sqrt(2.0) * 1.7316643961, 1e-6);
  EXPECT_FALSE(blind_score(12, 12).sensitivity_high);
  EXPECT_FALSE(blind_score(0, 12).sensitivity_low);
  EXPECT_NEAR(proportion_right(1), 0.7602499389, 1e-9);
  EXPECT_NEAR(proportion_right(0), 0.5, 1e-12);
  EXPECT_NEAR(proportion_right(blind_score(9, 12).sensitivity), 0.75, 1e-9);
}

TEST(BlindScore, HasTheProbabilityOfTheScoreByChance) {
  EXPECT_NEAR(blind_score(10, 10).by_chance, 1 / 1024.0, 1e-12);
  EXPECT_NEAR(blind_score(9, 10).by_chance, 11 / 1024.0, 1e-12);
  EXPECT_NEAR(blind_score(8, 12).by_chance, (495 + 220 + 66 + 12 + 1) / 4096.0, 1e-12);
  EXPECT_NEAR(blind_score(0, 5).by_chance, 1, 1e-12);
}

/// Two textures and a simulated joystick.
struct TwoTextures {
  BlindMaterial a = material("perceptual { roughness 0.2 } physical { force = lateral(grating(x, period: 2 mm)) }");
  BlindMaterial b = material("perceptual { roughness 0.8 } physical { force = lateral(grating(x, period: 2 mm)) }");
  std::unique_ptr<SimulatedJoystick> joystick = Library().simulated_joystick();

  static BlindMaterial material(const std::string& text) {
    const Program program = Declared("material m { " + text + " }").program();
    return {program, program.default_parameters()};
  }
  BlindOptions options(int trials, std::uint64_t seed) const {
    return {.trials = trials, .seed = seed, .seconds = 0.1, .virtual_time = true};
  }
};

/// Always answers "the first", and notes everything that it is told.
class First final : public BlindPerson {
 public:
  void introduce(bool is_a) override { introduced_ += is_a ? 'A' : 'B'; }
  void begin(int, int interval) override { felt_ += std::to_string(interval); }
  Result<int> answer(int) override { return 1; }
  void learn(int, bool right) override { learnt_ += right ? 'r' : 'w'; }

  std::string introduced_, felt_, learnt_;
};

TEST(BlindSession, DrawsTheOrderOfEachTrialIndependently) {
  TwoTextures setup;
  First person;
  const BlindSession session = feel_blind(*setup.joystick, setup.a, setup.b, setup.options(64, 7), person);
  ASSERT_EQ(session.trials.size(), 64u);
  EXPECT_FALSE(session.ended);
  EXPECT_EQ(person.introduced_, "AB");
  EXPECT_EQ(person.felt_.size(), 128u);
  int first = 0, alternations = 0;
  for (std::size_t i = 0; i < session.trials.size(); ++i) {
    const BlindTrial& trial = session.trials[i];
    EXPECT_EQ(trial.answer, 1);
    EXPECT_EQ(trial.right(), trial.a_first);
    EXPECT_EQ(person.learnt_[i], trial.a_first ? 'r' : 'w');
    first += trial.a_first;
    alternations += i > 0 && trial.a_first != session.trials[i - 1].a_first;
  }
  // Within four standard deviations of a fair coin's 32 (4) and 31.5 (4).
  EXPECT_NEAR(first, 32, 16);
  EXPECT_NEAR(alternations, 31.5, 16);
  // The seed determines the order.
  TwoTextures again;
  First same;
  const BlindSession second = feel_blind(*again.joystick, again.a, again.b, again.options(64, 7), same);
  TwoTextures other;
  First different;
  const BlindSession third = feel_blind(*other.joystick, other.a, other.b, other.options(64, 8), different);
  int differ = 0;
  for (std::size_t i = 0; i < 64; ++i) {
    EXPECT_EQ(second.trials[i].a_first, session.trials[i].a_first);
    differ += third.trials[i].a_first != session.trials[i].a_first;
  }
  EXPECT_GT(differ, 0);
}

TEST(BlindSession, ReadsAnswersAsLinesAndEndsWithThem) {
  TwoTextures setup;
  std::istringstream in("1\n 2 \nfirst\n\n2\r\n");
  std::ostringstream out;
  AskingPerson person(in, out, "velvet", "denim", 5, false);
  const BlindSession session = feel_blind(*setup.joystick, setup.a, setup.b, setup.options(5, 1), person);
  ASSERT_EQ(session.trials.size(), 3u);
  EXPECT_EQ(session.trials[0].answer, 1);
  EXPECT_EQ(session.trials[1].answer, 2);
  EXPECT_EQ(session.trials[2].answer, 2);
  ASSERT_TRUE(session.ended);
  EXPECT_EQ(session.ended->sentence, "the input ended");
  EXPECT_NE(out.str().find("A is velvet"), std::string::npos);
  // The text before an answer does not depend on the order, so it reveals nothing.
  const auto shown = [](std::uint64_t seed) {
    TwoTextures fresh;
    std::istringstream none("");
    std::ostringstream text;
    AskingPerson silent(none, text, "velvet", "denim", 5, false);
    feel_blind(*fresh.joystick, fresh.a, fresh.b, fresh.options(5, seed), silent);
    return text.str();
  };
  for (std::uint64_t seed = 2; seed < 10; ++seed) EXPECT_EQ(shown(1), shown(seed));
}

TEST(BlindSession, EndsWithTheDevice) {
  TwoTextures setup;
  First person;
  std::atomic<bool> stop{true};
  BlindOptions options = setup.options(5, 1);
  options.stop = &stop;
  EXPECT_EQ(feel_blind(*setup.joystick, setup.a, setup.b, options, person).ended->code, Code::stopped);
  options.stop = nullptr;
  options.seconds = -1;
  const BlindSession refused = feel_blind(*setup.joystick, setup.a, setup.b, options, person);
  EXPECT_TRUE(refused.trials.empty());
  EXPECT_TRUE(refused.ended);
}

}  // namespace
}  // namespace wale::calibrating
