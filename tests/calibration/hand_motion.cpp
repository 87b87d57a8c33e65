// Motions of a simulated hand, as people type them, against the figures of the hand `normal` and plane geometry; and
// runs with them.

#include "calibration/feel/hand_motion.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <numbers>

#include "calibration/feel/felt_report.hpp"
#include "calibration/feel/rehearsal.hpp"
#include "compiler/describe/describe.hpp"
#include "schema/without_place.hpp"
#include "tests/calibration/declared.hpp"

namespace wale::hand_motion_test {
namespace {

using calibrating::Declared;

const Declared& known() {
  static const Declared declared("");
  return declared;
}

const HandDeclaration& person() { return *known().declarations().hands.find("normal"); }

Motion motion(const std::string& typed) { return *motion_of(typed, person(), known().declarations()); }

TEST(HandMotion, ShiftsTurnsAndPresses) {
  const double quarter = 0.25 / person().lateral_frequency, reach = person().lateral_amplitude;
  EXPECT_NEAR(at(motion("lateral"), quarter).position.x, reach, 1e-12);
  EXPECT_NEAR(at(motion("lateral along y"), quarter).position.y, reach, 1e-12);
  EXPECT_NEAR(at(motion("lateral along y"), quarter).position.x, 0, 1e-12);
  const TracePoint oblique = at(motion("lateral along 30 deg at 20 mm, -5 mm"), quarter);
  EXPECT_NEAR(oblique.position.x, 0.02 + reach * std::cos(std::numbers::pi / 6), 1e-9);
  EXPECT_NEAR(oblique.position.y, -0.005 + reach / 2, 1e-9);
  EXPECT_EQ(motion("lateral at 20 mm, -5 mm along 30deg").index(), motion("lateral").index());
  const double deep = 0.5 / person().press_frequency;
  EXPECT_NEAR(at(motion("press along 180 deg"), deep).position.x, -person().press_depth, 1e-12);
  EXPECT_NEAR(at(motion("press"), 2 * deep).position.x, 0, 1e-12);
  EXPECT_NEAR(at(motion("circular at 0 mm, 10 mm"), 0).position.x, person().circular_radius, 1e-12);
  EXPECT_NEAR(at(motion("circular at 0 mm, 10 mm"), 0).position.y, 0.01, 1e-9);
  EXPECT_NEAR(at(motion("rest at 3 mm, 4 mm"), 7).position.y, 0.004, 1e-9);
}

TEST(HandMotion, RefusesWhatNobodyCanMean) {
  const auto error = [](const std::string& typed) {
    const auto found = motion_of(typed, person(), known().declarations());
    return found ? std::string("none") : in_words_without_place(found.error());
  };
  EXPECT_NE(error("lateral along z").find("expected `x`, `y` or an angle"), std::string::npos);
  EXPECT_NE(error("lateral along 30").find("expected `x`, `y` or an angle"), std::string::npos);
  EXPECT_NE(error("lateral along x along y").find("expected one `along`"), std::string::npos);
  EXPECT_NE(error("circular along y").find("has no direction"), std::string::npos);
  EXPECT_NE(error("pres along y").find("did you mean `press`"), std::string::npos);
  EXPECT_NE(error("lateral at 20 mm"), "none");
  EXPECT_NE(error("lateral at 20 N, 3 N"), "none");
}

/// The report of so many seconds of a hand on a simulated device, whose person lets so much through (N).
FeltReport felt(const Program& program, const std::string& hand, double seconds, double most = HUGE_VAL) {
  SimulatedJoystick joystick(program.description().device, {person().mass, person().damping, person().stiffness},
                             motion(hand));
  Stage stage(joystick, {.max_force = most});
  Patch patch = *stage.add(program);
  const auto run = stage.run({.seconds = seconds, .virtual_time = true});
  return felt_report(*patch.bank(), *run, program.description().device,
                     {"simulated", hand, true, std::nullopt, 1, most});
}

TEST(HandMotion, AHandAlongYCrossesWhatLiesAcrossY) {
  Declared declared(
      "material m { perceptual { roughness 0.6 } physical { force = lateral(grating(y, period: 2.5 mm)) } }\n");
  const Program program = declared.program();
  EXPECT_EQ(felt(program, "lateral", 5).felt.crossings, 0);
  EXPECT_TRUE(std::isinf(felt(program, "lateral", 5).needed_seconds.value()));
  const FeltReport report = felt(program, "lateral along y", 5);
  EXPECT_GT(report.felt.crossings, 50);
  EXPECT_FALSE(report.needed_seconds);
  EXPECT_NEAR(report.levels.at(0).back->level, 0.6, 0.01);
  EXPECT_NE(felt_text(report).find("delivered    1.934 of 1.934 N (100 %)\n  roughness    0.60, as its map reads that "
                                   "force (asked: 0.60)"),
            std::string::npos)
      << felt_text(report);
  EXPECT_EQ(felt_text(report).find("read back"), std::string::npos);
}

TEST(FeltReports, SayWhatTheActuatorsDoNotFollow) {
  const Program program =
      Declared("material m { perceptual { roughness 0.6 } physical { force = lateral(grating(y, period: 2.5 mm)) } }\n")
          .program();
  SimulatedJoystick joystick(program.description().device, {person().mass, person().damping, person().stiffness},
                             motion("lateral along y"));
  Stage stage(joystick);
  Patch patch = *stage.add(program);
  const auto run = stage.run({.seconds = 5, .virtual_time = true});
  const auto report = [&](double x, double y) {
    DeviceProfile device = program.description().device;
    device.bandwidth_x = x, device.bandwidth_y = y;
    return felt_report(*patch.bank(), *run, device, {"simulated", "lateral along y", true, std::nullopt, 1, HUGE_VAL});
  };
  const FeltReport prompt = report(0, 0), slow = report(20, 20), across = report(20, 0);
  // The largest percent is felt where the hand turns round; most of the way it is too fast for them.
  EXPECT_LT(slow.levels.at(0).back->level, 0.56);
  EXPECT_LT(slow.felt.force_rubbing.rms, 0.5 * prompt.felt.force_rubbing.rms);
  EXPECT_EQ(slow.felt.crossings, prompt.felt.crossings);
  const auto says = [](const FeltReport& of, const char* what) { return felt_text(of).find(what) != std::string::npos; };
  EXPECT_TRUE(says(slow, " %); its actuators follow to 20 Hz\n")) << felt_text(slow);
  EXPECT_TRUE(says(slow, "1.934 N that the actuator was told")) << felt_text(slow);
  EXPECT_TRUE(says(report(30, 20), "follow to 30 Hz along x and 20 Hz along y\n"));
  for (const FeltReport& each : {prompt, across}) {  // nothing pushes along x
    EXPECT_NEAR(each.levels.at(0).back->level, 0.6, 0.01);
    EXPECT_FALSE(says(each, "follow to")) << felt_text(each);
  }
}

TEST(FeltPercepts, AreThoseThatDescribeReads) {
  Declared plain("material m { physical { force = vector(1 N * sin(2 pi * x / 4 mm), 0 N) } }\n");
  const Program program = plain.program();
  FeltReport report = felt(program, "lateral", 5);
  tell_read_percepts(report, Bank(program), plain.declarations());
  EXPECT_NE(felt_text(report).find("none is asked for; `wale describe` reads roughness 0.36"), std::string::npos)
      << felt_text(report);

  Declared wide(
      "material m { perceptual { roughness 0.5 } physical { force = lateral(grating(x, period: 14 mm)) } }\n");
  const Program coarse = wide.program();
  report = felt(coarse, "lateral", 20);
  EXPECT_TRUE(report.levels.at(0).back) << "enough crossings";
  tell_read_percepts(report, Bank(coarse), wide.declarations());
  EXPECT_NE(felt_text(report).find("no level: outside what was measured (period 14 mm, measured to 10)"),
            std::string::npos)
      << felt_text(report);
}

// A limit of 0.3 N bounds a texture of 0.78 N: the hand crosses it as often as without, and gets all of the 0.3 N.
TEST(FeltPercepts, AreJudgedAgainstWhatThePersonLetsThrough) {
  Declared declared(
      "material m { perceptual { roughness 0.3 } physical { force = lateral(grating(x, period: 4 mm)) } }\n");
  const Program program = declared.program();
  const FeltReport whole = felt(program, "lateral", 10), limited = felt(program, "lateral", 10, 0.3);
  ASSERT_GT(whole.aimed.at(0), 0.7);
  EXPECT_NEAR(static_cast<double>(limited.felt.crossings), static_cast<double>(whole.felt.crossings),
              0.1 * static_cast<double>(whole.felt.crossings));
  ASSERT_TRUE(limited.levels.at(0).back);
  EXPECT_LT(limited.levels[0].back->level, whole.levels.at(0).back->level);
  EXPECT_NEAR(limited.let_through.at(0), 0.3, 1e-6);
  EXPECT_NE(felt_text(limited).find(" of 0.3 N that --max-force lets through (99 %); it aims at 0.7765 N\n"),
            std::string::npos)
      << felt_text(limited);
  EXPECT_NE(felt_json(limited).find("\"max_force_newton\": 0.3"), std::string::npos) << felt_json(limited);
  EXPECT_EQ(felt_text(whole).find("--max-force"), std::string::npos);
}

/// The report of a run of 8 s, with what `describe` reads.
FeltReport told(const std::string& text, const std::string& hand) {
  Declared declared("material m { " + text + " }\n");
  const Program program = declared.program();
  FeltReport report = felt(program, hand, 8);
  tell_read_percepts(report, Bank(program), declared.declarations());
  return report;
}

/// The levels of `describe`, by percept.
std::map<std::string, double> described(const std::string& text) {
  Declared declared("material m { " + text + " }\n");
  std::map<std::string, double> levels;
  for (const DescribedPercept& each : describe(Bank(declared.program()), declared.declarations()).percepts)
    levels[each.name] = each.level;
  return levels;
}

// Two waves of one fixed amplitude: only the fine one is roughness, and the coarse one is bumpiness. By Parseval the
// fine one has the share a^2 / (a^2 + b^2) of the mean square of the force, whose amplitudes are 0.25 / 4 and 5 / 20.
TEST(FeltPercepts, HaveTheShareOfTheReliefThatDescribeReads) {
  for (const char* waves : {"0.25 * sin(2 pi * x / 4 mm) + 5 * sin(2 pi * x / 20 mm)",
                            "sin(2 pi * x / 3 mm) + 7 * sin(2 pi * x / 21 mm)"}) {
    const std::string text = "physical { force = lateral(" + std::string(waves) + ", amplitude: 2 N) }";
    const FeltReport report = told(text, "lateral");
    const auto levels = described(text);
    ASSERT_EQ(report.levels.at(0).name, "roughness");
    ASSERT_TRUE(report.levels[0].back) << felt_text(report);
    EXPECT_NEAR(report.levels[0].back->level, levels.at("roughness"), 0.01) << felt_text(report);
    ASSERT_EQ(report.read.size(), 1u) << felt_text(report);
    EXPECT_EQ(report.read[0].name, "bumpiness");
    EXPECT_NEAR(report.read[0].level, levels.at("bumpiness"), 1e-6);
    EXPECT_NE(felt_text(report).find("`wale describe` reads bumpiness"), std::string::npos);
  }
  const FeltReport fine = told("physical { force = lateral(0.25 * sin(2 pi * x / 4 mm) + 5 * sin(2 pi * x / 20 mm), "
                               "amplitude: 2 N) }", "lateral");
  EXPECT_NEAR(fine.levels.at(0).size, 2 * 0.0625 / std::hypot(0.0625, 0.25), 0.02);
}

// A hand that goes along x meets nothing of the ribs across y, and the device gives all that there is.
TEST(FeltPercepts, AreComparedWithWhatTheHandsWayShows) {
  for (const char* heights : {"grating(x, period: 3 mm) + grating(y, period: 3 mm)",
                              "sin(2 pi * x / 4 mm) + sin(2 pi * y / 2.5 mm)"}) {
    const std::string text = "perceptual { roughness 0.5 } physical { force = lateral(" + std::string(heights) + ") }";
    const FeltReport straight = told(text, "lateral"), round = told(text, "circular");
    const std::string said = felt_text(straight);
    EXPECT_NE(said.find(" N on the hand's way (100 %); over the whole patch it is 1.5"), std::string::npos) << said;
    ASSERT_TRUE(straight.levels.at(0).back) << said;
    EXPECT_NEAR(straight.levels[0].back->level, 0.5, 0.01) << said;
    EXPECT_EQ(felt_text(round).find("hand's way"), std::string::npos) << felt_text(round);
  }
}

TEST(FeltPercepts, OfRidgesWithOneSteepFlankAreRead) {
  for (const char* steep : {"0.33", "0.2", "0.1"}) {
    const std::string text =
        "perceptual { roughness 0.5 } physical { let s = " + std::string(steep) +
        "\n let t = modulo(x, 3 mm) / 3 mm\n height h = if t < 1 - s then 0.5 - 0.5 * cos(pi * t / (1 - s)) else 0.5 + "
        "0.5 * cos(pi * (t - 1 + s) / s)\n force = lateral(h) }";
    const FeltReport report = told(text, "lateral");
    EXPECT_GT(report.felt.crossings, 300) << steep;
    ASSERT_TRUE(report.levels.at(0).back) << felt_text(report);
    EXPECT_NEAR(report.levels[0].back->level, described(text).at("roughness"), 0.02) << felt_text(report);
  }
}

// A limit or a factor is no other force, and what the program aims at is what it pushes with.
TEST(FeltPercepts, AreReadThroughALimitAndAFactor) {
  const FeltReport scaled =
      told("perceptual { roughness 0.5 } physical { force = 2 * lateral(grating(x, period: 2.5 mm)) }", "lateral");
  ASSERT_TRUE(scaled.levels.at(0).back) << felt_text(scaled);
  EXPECT_NE(felt_text(scaled).find("delivered    3.04"), std::string::npos) << felt_text(scaled);
  EXPECT_NE(felt_text(scaled).find("aims at      amplitude 3.04"), std::string::npos) << felt_text(scaled);
  const std::string wall = "perceptual { softness 0.8 } physical { force = firm() limit 2 N }";
  const FeltReport limited = told(wall, "press at 20 mm, 0 mm");
  ASSERT_TRUE(limited.levels.at(0).back) << felt_text(limited);
  EXPECT_NEAR(limited.levels[0].back->level, described(wall).at("hardness"), 0.02) << felt_text(limited);
}

// A hand goes over the same ribs whatever a factor makes of their force: on each period it crosses two flanks, and as
// many as without the factor.
TEST(FeltPercepts, TexturesAreCrossedAsOftenBehindAFactor) {
  const auto text = [](const std::string& factor, const char* asked, const char* size) {
    return asked + std::string("physical { force = ") + factor + "lateral(grating(x, period: 3 mm)" + size + ") }";
  };
  const char* asked = "perceptual { roughness 0.6 } ";
  const double plain = static_cast<double>(told(text("", asked, ""), "lateral").felt.crossings);
  ASSERT_GT(plain, 300);
  for (const char* factor : {"0.5 * ", "0.2 * ", "2 * "}) {
    const FeltReport report = told(text(factor, asked, ""), "lateral");
    EXPECT_NEAR(static_cast<double>(report.felt.crossings), plain, 0.1 * plain) << factor;
    ASSERT_TRUE(report.levels.at(0).back) << felt_text(report);
  }
  const FeltReport written = told(text("0.3 * ", "", ", amplitude: 4 N"), "lateral");
  EXPECT_NEAR(static_cast<double>(written.felt.crossings), plain, 0.1 * plain);
  const FeltReport limited = told("physical { force = lateral(grating(x, period: 3 mm), amplitude: 6 N) limit 1 N }", "lateral");
  EXPECT_NEAR(static_cast<double>(limited.felt.crossings), plain, 0.1 * plain);
}

// The swings of a force that has other parts than the texture are not the texture's, so no number of them is told.
TEST(FeltPercepts, CrossingsAreNotToldBesideOtherForces) {
  const std::string ribs = "force ribs = lateral(grating(x, period: 3 mm), amplitude: 1 N)\n ";
  const std::string wave = "force = vector(1 N * sin(2 pi * x / 4 mm), 0 N)";
  for (const std::string& physics :
       {ribs + "force drag = sticky(1 N)", ribs + "force drag = viscous(3 N s/m)", ribs + "force wall = firm(500 N/m)",
        ribs + "force back = spring(80 N/m)", wave + " - 3 N s/m * velocity", wave + " - 80 N/m * hand",
        wave + " + vector(0 N, 1 N)"}) {
    const FeltReport report = told("physical { " + physics + " }", "lateral");
    EXPECT_NE(felt_text(report).find("texture      crossings not counted: other forces push too; "), std::string::npos)
        << physics << '\n' << felt_text(report);
    EXPECT_NE(felt_json(report).find("\"crossings\": null"), std::string::npos) << physics;
  }
  for (const std::string& physics :
       {wave, std::string("force a = lateral(grating(x, period: 3 mm), amplitude: 1 N)\n force b = lateral(grating(x, "
                          "period: 12 mm), amplitude: 1 N)")}) {
    const FeltReport report = told("physical { " + physics + " }", "lateral");
    EXPECT_GT(report.felt.crossings, 100) << physics;
    EXPECT_EQ(felt_text(report).find("not counted"), std::string::npos) << felt_text(report);
  }
}

// The device cuts the force, and all that is left of it comes to the handle.
TEST(FeltPercepts, AreDeliveredWholeWhereTheDeviceCutsThem) {
  for (const char* amplitude : {"12 N", "40 N"}) {
    const FeltReport report = told("physical { force = lateral(grating(x, period: 4 mm), amplitude: " +
                                       std::string(amplitude) + ") }", "lateral");
    EXPECT_NE(felt_text(report).find("delivered    10 of 10 N (100 %)\n"), std::string::npos) << felt_text(report);
    ASSERT_TRUE(report.levels.at(0).back);
    // Minsky 1995, figure 19: the level goes with the amplitude to the power 0.76, and 3.79 N is level 1.
    EXPECT_NEAR(report.levels[0].back->level, std::pow(10 / 3.79, 0.76), 0.03);
  }
}

// What `describe` does not read has no level, and what it reads is told, also beside percepts that were asked for.
TEST(FeltPercepts, AreNoOthersThanThoseOfDescribe) {
  const FeltReport damper = told("physical { force = crisp(5 N s/m) }", "lateral");
  EXPECT_TRUE(damper.levels.empty()) << felt_text(damper);
  EXPECT_TRUE(described("physical { force = crisp(5 N s/m) }").empty());
  const FeltReport both =
      told("physical { force a = firm(800 N/m, face: 25 mm) limit 7 N\n force b = viscous(3 N s/m) }", "lateral");
  EXPECT_NE(felt_text(both).find("besides      `wale describe` reads hardness 0.84"), std::string::npos) << felt_text(both);
  EXPECT_NE(felt_json(damper).find("\"predicted_amplitude_newton\": null"), std::string::npos);
}

// Advice helps: a hand that crosses the ridges already, or that no direction serves better, gets none.
TEST(FeltPercepts, AreCrossedByTheMotionThatIsProposed) {
  Declared declared(
      "material m { perceptual { roughness 0.6 } physical { force = lateral(grating(y, period: 2.5 mm)) } }\n");
  const Program program = declared.program();
  const auto advised = [&](const std::string& hand) {
    FeltReport report = felt(program, hand, 1);
    report.needed_seconds = HUGE_VAL;
    tell_read_percepts(report, Bank(program), declared.declarations());
    return report.crossing_motion;
  };
  for (const char* hand : {"lateral", "lateral along 10 deg", "rest"}) EXPECT_EQ(advised(hand), "lateral along y");
  for (const char* hand : {"lateral along y", "lateral along 60 deg at 5 mm, 0 mm", "circular"})
    EXPECT_EQ(advised(hand), "");
}

TEST(FeltPercepts, SayAtLeastWhereTheFrictionIsCut) {
  Declared declared("material m { physical { force = sticky(20 N) } }\n");
  const Program program = declared.program();
  FeltReport report = felt(program, "lateral", 2);
  tell_read_percepts(report, Bank(program), declared.declarations());
  EXPECT_NE(felt_text(report).find("  stickiness   at least "), std::string::npos) << felt_text(report);
}

// A push in the first moments only is the largest, though the figures leave them out.
TEST(FeltPercepts, TheLargestForceIsThatOfAllTicks) {
  Declared early("material m { physical { active 2 W\n force = vector(if time < 0.2 s then 3 N else 0.5 N, 0 N) } }\n");
  const FeltReport report = felt(early.program(), "lateral", 5);
  EXPECT_LT(report.felt.force.maximum, 0.6);
  EXPECT_NEAR(report.largest, 3, 0.05);
  EXPECT_LT(report.largest_at, 0.2);
  EXPECT_NE(felt_text(report).find("  largest      "), std::string::npos) << felt_text(report);
}

// A wall of 500 N/m at 20 mm, and a hand of 135 N/m that aims for 40 mm: it stops where 500 d = 135 (20 mm - d).
TEST(HandMotion, AHandPressesIntoAWall) {
  Declared declared("material m { physical { force = firm(500 N/m) + crisp(4 N s/m) } }\n");
  const FeltReport report = felt(declared.program(), "press", 6);
  const double depth = 135 * 0.02 / (500 + 135), static_force = 500 * depth;
  EXPECT_NEAR(report.felt.force.maximum, static_force, 0.15 * static_force) << "it presses slowly";
  EXPECT_EQ(felt(declared.program(), "press along y", 6).felt.force.maximum, 0);
}

// Dry friction of 1 N holds a hand that leans on it with less: a hand of 135 N/m that aims 3 mm to the side bends the
// bristle of 600 N/m by 135 / (135 + 600) of that and comes back, where a drag without memory would let it go all the
// way.
TEST(HandMotion, AHandLeansOnStickinessWithoutSliding) {
  Declared declared("material m { perceptual { stickiness 1 } }\n");
  const Program program = declared.program();
  SimulatedJoystick joystick(program.description().device, {person().mass, person().damping, person().stiffness},
                             Press{0.003, 0.25, {}, {1, 0}});
  Stage stage(joystick);
  Patch patch = *stage.add(program);
  const auto run = stage.run({.seconds = 20, .virtual_time = true});
  double farthest = 0;
  for (const TickRecord& tick : run->record.ticks) farthest = std::max<double>(farthest, tick.position.x);
  EXPECT_NEAR(farthest, 0.003 * 135 / 735, 2e-4) << "less by the handle's own friction";
  EXPECT_NEAR(run->record.ticks.back().position.x, 0, 3e-4);
}

// Each percept by itself, under a hand that shows it.
TEST(HandMotion, PerceptsOtherThanTexturesAreReadBack) {
  struct Shown {
    const char* percept;
    double level;
    const char* hand;
  };
  const Shown all[] = {{"stickiness", 0.5, "lateral"}, {"stickiness", 0.9, "lateral along y"},
                       {"viscosity", 0.6, "lateral"},  {"springiness", 0.5, "lateral"},
                       {"hardness", 0.4, "press"},     {"hardness", 0.8, "press"},
                       {"heaviness", 0.7, "lateral"},  {"vibration", 0.5, "rest"}};
  for (const Shown& each : all) {
    Declared declared("material m { perceptual { " + std::string(each.percept) + " " + std::to_string(each.level) +
                      " } }\n");
    const FeltReport report = felt(declared.program(), each.hand, 6);
    ASSERT_EQ(report.levels.size(), 1u) << each.percept;
    ASSERT_TRUE(report.levels[0].back) << each.percept << ": " << in_words(report.levels[0].back.error());
    EXPECT_NEAR(report.levels[0].back->level, each.level, 0.1 * each.level) << each.percept << '\n'
                                                                            << felt_text(report);
    EXPECT_NEAR(report.asked[0], each.level, 1e-6);
  }
}

TEST(HandMotion, AHandThatCannotShowAPerceptSaysWhichOneDoes) {
  Declared wall("material m { perceptual { hardness 0.5 } }\n");
  const std::string none = felt_text(felt(wall.program(), "press along 180 deg", 6));
  EXPECT_NE(none.find("the hand hardly pressed into its wall"), std::string::npos) << none;
  EXPECT_NE(none.find("--hand \"press along 0 deg at 20 mm, 0 mm\""), std::string::npos) << none;
  EXPECT_TRUE(felt(wall.program(), "press along 0 deg at 20 mm, 0 mm", 6).levels.at(0).back);
  Declared sticky("material m { perceptual { stickiness 0.5 } }\n");
  const std::string resting = felt_text(felt(sticky.program(), "rest", 6));
  EXPECT_NE(resting.find("the hand hardly slid over it"), std::string::npos) << resting;
  EXPECT_NE(resting.find("`lateral`"), std::string::npos) << resting;
}

TEST(HandMotion, ARunIsAsLongAsItsReadBackNeeds) {
  Declared declared(
      "material m { perceptual { bumpiness 0.5 } physical { force = bumps(grating(x, period: 25 mm, smooth: 0.25)) } "
      "}\n"
      "material ribs { perceptual { roughness 0.5 } physical { force = lateral(grating(x, period: 2.5 mm)) } }\n");
  const Program program = declared.program("m");
  const FeltReport usual = felt(program, "lateral", 2);
  ASSERT_LT(usual.felt.crossings, least_crossings);
  ASSERT_GT(usual.felt.crossings, 0);
  const double needed = usual.needed_seconds.value();
  EXPECT_FALSE(felt(program, "lateral", needed).needed_seconds);
  EXPECT_NE(felt_text(usual).find("cross it 50 times: --seconds"), std::string::npos) << felt_text(usual);

  const auto seconds = [](const Program& of) {
    const FeltDevice device{
        std::make_unique<SimulatedJoystick>(
            of.description().device, HandModel{person().mass, person().damping, person().stiffness}, motion("lateral")),
        nullptr, "simulated", "lateral", true};
    return seconds_needed(device, {of, of.default_parameters()}, 2, HUGE_VAL, false);
  };
  EXPECT_EQ(seconds(program), needed);
  EXPECT_EQ(seconds(declared.program("ribs")), 2);
}

}  // namespace
}  // namespace wale::hand_motion_test
