// The reader, against programs whose feel is known in closed form. README.md describes the classes and the report.

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <limits>
#include <map>

#include "tests/compiler/compiling.hpp"
#include "tests/truth/families.hpp"
#include "tests/truth/scores.hpp"

namespace wale::truth {
namespace {

constexpr std::size_t programs_per_class = 8;

struct Floor {
  std::size_t programs = 0;  ///< right in every cue
  std::size_t cues = 0;      ///< right, of all programs together
};

/// How much of the first `programs_per_class` programs of each class is read rightly. A better reader raises these
/// numbers; no change may lower them.
const std::map<std::string, Floor>& floors() {
  static const std::map<std::string, Floor> table{
      {"sine", {8, 238}},
      {"long sine", {8, 240}},
      {"square", {8, 240}},
      {"triangle", {8, 236}},
      {"sawtooth", {8, 240}},
      {"narrow ridge", {8, 240}},
      {"missing fundamental", {8, 240}},
      {"smooth bumps", {8, 238}},
      {"grating", {8, 240}},
      {"finer than 2 counts", {8, 240}},
      {"collinear", {8, 236}},
      {"incommensurate", {8, 239}},
      {"fine on coarse", {8, 230}},
      {"whole ratio", {7, 238}},
      {"few periods of two", {7, 222}},
      {"crossed", {8, 221}},
      {"three waves", {8, 232}},
      {"hill", {8, 200}},
      {"grains", {8, 200}},
      {"chirp", {8, 200}},
      {"wavering", {8, 216}},
      {"spring", {8, 238}},
      {"saturated spring", {8, 224}},
      {"groove", {8, 240}},
      {"constant", {8, 240}},
      {"wall", {8, 232}},
      {"edge", {8, 232}},
      {"step near the rim", {8, 232}},
      {"viscosity", {8, 240}},
      {"friction", {8, 232}},
      {"sticky", {8, 232}},
      {"breakaway", {8, 240}},
      {"mass", {8, 240}},
      {"drag and mass", {8, 232}},
      {"sway", {8, 240}},
      {"slow sway", {8, 240}},
      {"vibration", {8, 240}},
      {"dying swing", {8, 240}},
      {"beat", {8, 224}},
      {"heartbeat", {8, 232}},
      {"sway and vibration", {8, 240}},
      {"two vibrations", {8, 240}},
      {"two sways", {8, 240}},
      {"sway with corners", {8, 240}},
      {"drag beside a sway", {8, 240}},
      {"friction beside a swing", {8, 240}},
      {"travelling wave", {8, 192}},
      {"mass one way", {8, 240}},
      {"mass in a part", {8, 240}},
      {"friction across a viscosity", {8, 232}},
      {"tiring spring", {8, 240}},
      {"hysteresis", {8, 228}},
      {"texture on trend", {7, 216}},
      {"long wave on spring", {8, 232}},
      {"texture and wall", {8, 232}},
      {"texture in motion", {8, 240}},
      {"texture in time", {8, 240}},
      {"spring in motion", {8, 232}},
      {"everything", {8, 228}},
      {"spring by axis", {8, 240}},
      {"viscosity by axis", {8, 240}},
      {"friction by axis", {8, 232}},
      {"mass by axis", {8, 240}},
      {"wall beside forces", {8, 233}},
      {"wall near the rim", {8, 240}},
      {"wall with a preload", {8, 240}},
      {"crisp wall", {8, 240}},
      {"displaced spring", {8, 240}},
      {"push beside", {8, 239}},
      {"two walls", {8, 240}},
      {"box", {8, 240}},
      {"round wall", {8, 240}},
      {"wall beside slow waves", {8, 240}},
      {"wall beside slow and fine", {6, 228}},
      {"step beside", {8, 248}},
      {"few steps", {8, 248}},
      {"staircase", {8, 232}},
      {"resistance at a limit", {8, 231}},
      {"short swing", {8, 240}},
      {"hill beside a trend", {8, 224}},
      {"hill beside a wall", {8, 232}},
      {"hill beside a step", {7, 229}},
      {"jumping wall on texture", {8, 248}},
      {"two jumping walls", {8, 248}},
      {"nested walls", {8, 248}},
      {"bent wall", {7, 235}},
      {"bent wall on texture", {7, 233}},
      {"half spring", {0, 186}},
      {"soft step", {6, 239}},
      {"limited wall", {8, 248}},
      {"swing in a part", {8, 256}},
      {"dead band", {8, 240}},
      {"stiffening spring", {8, 248}},
      {"softening spring", {8, 256}},
  };
  return table;
}

// ---- the generator ----

/// The force of a formula near a place, as 32-bit arithmetic may round the place.
struct Range {
  glm::dvec2 low{std::numeric_limits<double>::infinity()}, high{-std::numeric_limits<double>::infinity()};
};

Range force_near(const Case& made, const Sample& hand) {
  constexpr double rounding = 4e-8;       // m: some last bits of 0.1 m
  constexpr double time_rounding = 2e-7;  // of the time: likewise
  constexpr double strongest = 10;        // N: of the device, along each axis
  Range range;
  for (const double right : {-1.0, -0.25, 0.0, 0.25, 1.0})
    for (const double up : {-1.0, -0.25, 0.0, 0.25, 1.0})
      for (const double later : {-1.0, 0.0, 1.0}) {
        Sample moved = hand;
        moved.position += rounding * glm::dvec2{right, up};
        moved.time *= 1 + time_rounding * later;
        const glm::dvec2 force = glm::clamp(made.force(moved), -strongest, strongest);
        range.low = glm::min(range.low, force), range.high = glm::max(range.high, force);
      }
  return range;
}

Hand hand_of(const Sample& sample) {
  Hand hand;
  hand.position = sample.position, hand.velocity = sample.velocity, hand.acceleration = sample.acceleration;
  hand.time = sample.time;
  return hand;
}

/// A hand somewhere, as the machine knows it: in 32-bit floats.
Sample any_hand(Chance& chance, glm::dvec2 half) {
  const auto pair = [&](double most) {
    return glm::dvec2(glm::vec2(chance.between(-most, most), chance.between(-most, most)));
  };
  Sample hand;
  hand.position = glm::dvec2(glm::vec2(glm::dvec2{chance.between(-half.x, half.x), chance.between(-half.y, half.y)}));
  hand.velocity = pair(0.4), hand.acceleration = pair(4);
  hand.time = chance.between(0, 1);
  return hand;
}

TEST(Truth, TheProgramsPushAsTheirClosedFormsSay) {
  std::size_t checked = 0;
  for (const Family& family : families())
    for (std::size_t i = 0; i < 6; ++i) {
      const Case made = generated(family, i);
      if (!made.force) continue;
      Bank bank(compiling::Compiled(made.source).only());
      Chance chance("places", i);
      for (int place = 0; place < 50; ++place) {
        const Sample hand = any_hand(chance, made.half);
        const glm::dvec2 force = tick(bank, hand_of(hand));
        const Range range = force_near(made, hand);
        const double tolerance = made.force_tolerance + 2e-6 * glm::length(force);
        for (int axis = 0; axis < 2; ++axis) {
          ASSERT_GE(force[axis], range.low[axis] - tolerance) << made.name << '\n' << made.source;
          ASSERT_LE(force[axis], range.high[axis] + tolerance) << made.name << '\n' << made.source;
        }
        ++checked;
      }
    }
  EXPECT_GT(checked, 5000u);
}

/// The amplitude that is expected of one wave of 1 N along x.
double amplitude_of(const Waveform& form) {
  Composition made;
  made.push_wave({form, 2.5e-3, 0, 0.1, 1});
  return made.finished().truth[Cue::amplitude].value;
}

// What is above the 99th percentile p of |f|: of a sine arccos(p) / (pi / 2), of a line 1 - p, of a ridge its duty of
// that.
TEST(Truth, AmplitudesAreThe99thPercentilesOfTheirWaves) {
  EXPECT_NEAR(amplitude_of(sine()), 0.999877, 1e-4);
  EXPECT_NEAR(amplitude_of(square()), 1, 1e-9);
  EXPECT_NEAR(amplitude_of(triangle()), 0.99, 1e-3);
  EXPECT_NEAR(amplitude_of(sawtooth()), 0.99, 1e-3);
  EXPECT_NEAR(amplitude_of(ridge(0.05)), 0.951057, 3e-3);  // cos(0.2 * pi / 2)
}

TEST(Truth, CarriersShareTheAmplitudeByTheirMeanSquares) {
  Composition made;
  made.push_wave({sine(), 2.5e-3, 0, 0, 0.6});
  made.push_wave({sine(), 25e-3, 1, 0, 0.8});
  const Truth truth = made.finished().truth;
  EXPECT_NEAR(truth[Cue::roughness].value / truth[Cue::amplitude].value, 0.6, 0.01);
  EXPECT_NEAR(truth[Cue::bumpiness].value / truth[Cue::amplitude].value, 0.8, 0.01);
  EXPECT_EQ(truth[Cue::period].value, 25e-3);
  EXPECT_EQ(truth[Cue::orientation].kind, Expected::Kind::open);
}

TEST(Truth, AClassIsTheSameEachTime) {
  for (const Family& family : families()) {
    EXPECT_EQ(generated(family, 3).source, generated(family, 3).source);
    EXPECT_NE(generated(family, 3).source, generated(family, 4).source) << family.name;
  }
}

TEST(Truth, AWrongReadingIsFound) {
  Truth truth;
  truth[Cue::period] = valued(2.5e-3), truth[Cue::amplitude] = valued(1), truth[Cue::friction] = some;
  truth.waves = {{2.5e-3, 0}};
  Reading reading;
  reading[Cue::period] = 2.54e-3, reading[Cue::amplitude] = 1.02, reading[Cue::friction] = 0.2;
  reading.waves = {{2.5e-3, 3.14}};
  EXPECT_TRUE(judge(truth, reading).right());
  const auto wrong = [&](Cue cue, std::optional<double> value) {
    Reading other = reading;
    other[cue] = value;
    return !judge(truth, other).right();
  };
  EXPECT_TRUE(wrong(Cue::period, 7.5e-3));
  EXPECT_TRUE(wrong(Cue::period, std::nullopt));
  EXPECT_TRUE(wrong(Cue::amplitude, 1.04));
  EXPECT_TRUE(wrong(Cue::friction, std::nullopt));
  EXPECT_TRUE(wrong(Cue::viscosity, 0.06));
  EXPECT_FALSE(wrong(Cue::viscosity, 0.04));
  EXPECT_TRUE(wrong(Cue::sway_rate, 1.0));
  reading.waves.push_back({5e-3, 0});
  EXPECT_FALSE(judge(truth, reading).right());
}

// ---- the reader ----

TEST(Truth, NoClassIsReadWorseThanBefore) {
  std::string better;
  for (const Family& family : families()) {
    const Score score = score_of(family, programs_per_class);
    const auto found = floors().find(family.name);
    EXPECT_NE(found, floors().end()) << family.name;
    const Floor floor = found == floors().end() ? Floor{} : found->second;
    EXPECT_GE(score.right, floor.programs) << family.name;
    EXPECT_GE(score.right_cues(), floor.cues) << family.name;
    if (score.right > floor.programs || score.right_cues() > floor.cues)
      better += fmt::format("      {{\"{}\", {{{}, {}}}}},\n", family.name, score.right, score.right_cues());
  }
  if (!better.empty()) fmt::print("These are read better than before; raise their floors:\n{}", better);
  EXPECT_EQ(floors().size(), families().size()) << "a floor of no class";
}

// Not run by ctest: WALE_TRUTH=2000 build/tests/test_truth --gtest_filter=Truth.Report
TEST(Truth, Report) {
  const char* programs = std::getenv("WALE_TRUTH");
  const char* chosen = std::getenv("WALE_TRUTH_SHOW");
  if (!programs && !chosen) GTEST_SKIP() << "WALE_TRUTH=2000 reads so many programs";
  const std::string shown = chosen ? chosen : "";
  const std::size_t classes = families().size();
  const std::size_t count = ((programs ? std::strtoul(programs, nullptr, 10) : 2000) + classes - 1) / classes;
  std::vector<Score> scores;
  for (const Family& family : families()) {
    if (!programs && !shown.starts_with(family.name)) continue;
    const Score& score = scores.emplace_back(score_of(family, count));
    for (const Fault& fault : score.faults)
      if (fault.name == shown || score.family == shown || shown == "all")
        fmt::print("// {}\n{}\n{}\n", fault.name, fault.faults, fault.source);
  }
  fmt::print("{}\n{}\n{}", table_of(scores), worst_of(scores), bars_of(scores));
}

}  // namespace
}  // namespace wale::truth
