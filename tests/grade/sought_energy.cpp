// Energy that shows only later, elsewhere, or with the button: whether a law gives any follows from its formula.

#include <cmath>

#include "tests/grade/grading.hpp"

namespace wale::sought_energy_test {
namespace {

using grading::graded;
using grading::hand;

/// `law` in parts of the patch, of the time, or of the button's states.
std::string only(const std::string& when, const std::string& law) {
  return "force = (if " + when + " then 1 else 0) * (" + law + ")";
}

const std::string shaking = "vector(3 N * sin(2 pi * phase(5 Hz)), 0 N)";
const std::string swirling = "20 N/m * perpendicular(hand)";
const std::string urging = "-sticky(0.5 N)";
const std::string dragging = "sticky(0.7 N)";
const std::string flowing = "viscous(4 N s/m)";

TEST(SoughtEnergy, OfAShakingIsFoundWheneverAndWhereverItComes) {
  for (const char* when : {"time > 1.5 s", "time > 2 s", "time > 5 s", "time > 7 s", "button", "x > 60 mm",
                           "x > 50 mm and y > 50 mm", "length(hand - vector(-45 mm, 30 mm)) < 12 mm"})
    EXPECT_EQ(graded(only(when, shaking)).standing, Standing::active) << when;
  const std::string clock = "state t : time = 0 s in 0 s .. 1000 s\nnext t = t + dt\n";
  EXPECT_EQ(graded(clock + only("t > 2 s", shaking)).standing, Standing::active);
}

TEST(SoughtEnergy, OfACurlOrAnUrgingMemoryIsFoundWithTheButtonAndElsewhere) {
  EXPECT_EQ(graded(only("button", swirling)).standing, Standing::active);
  EXPECT_EQ(graded(only("not button", swirling)).standing, Standing::active);
  for (const char* when : {"button", "not button", "x > 55 mm", "time > 3 s"})
    EXPECT_EQ(graded(only(when, urging)).standing, Standing::active) << when;
}

TEST(SoughtEnergy, OfALawThatOnlyTakesIsNotInvented) {
  for (const char* when : {"button", "time < 4 s", "time > 4 s", "x > 20 mm"})
    for (const std::string& law : {dragging, flowing}) {
      const Grade grade = graded(only(when, law));
      EXPECT_FALSE(grade.energy.active()) << law << " if " << when << ": " << grade.energy.watt() << " W";
    }
}

TEST(SoughtEnergy, HasAFigureAlsoIfItComesLate) {
  // 2 N along a hand at 0.25 m/s: no more than 0.5 W.
  const Grade late = graded("force = vector(if time > 3 s then 2 N else 0 N, 0 N)");
  EXPECT_GT(late.energy.watt(), 0.05);
  EXPECT_LE(late.energy.watt(), 0.51);
}

TEST(SoughtEnergy, IsUnknownOfAClockThatRunsOn) {
  // What it does after 20 s was not looked at; the friction makes it depend on the hand, too.
  const std::string clock = "state t : time = 0 s in 0 s .. 1000 s\nnext t = t + dt\n";
  const Grade grade = graded(clock +
                             "force = sticky(0.5 N) + (if t > 20 s then vector(3 N * sin(2 pi * t * 5 Hz), 0 N) else "
                             "vector(0 N, 0 N))");
  EXPECT_EQ(grade.standing, Standing::unknown);
  EXPECT_GT(grade.later_newton, 0);
}

TEST(SoughtEnergy, TheButtonsStiffnessNeedsItsDamping) {
  const Grade always = graded("force = sticky(5 N, stiffness: 20000 N/m)");
  const Grade held = graded(only("button", "sticky(5 N, stiffness: 20000 N/m)"));
  EXPECT_NEAR(held.required_damping, always.required_damping, 0.05 * always.required_damping);
}

TEST(SoughtEnergy, OfAForceThatTheButtonSwitchesIsThatOfAStrokeToAndFro) {
  // The hand strokes 80 mm once a second: 2 N more on the way back are 0.16 W.
  const Grade turned = graded("force = vector(if button then -1 N else 1 N, 0 N)");
  EXPECT_EQ(turned.standing, Standing::active);
  EXPECT_NEAR(turned.energy.button_watt, 0.16, 0.005);
  EXPECT_EQ(graded("force = if button then 50 N/m * hand else -50 N/m * hand").standing, Standing::active);
  // A wall that lets go gives on the way out what it never took: at most 10 N over 60 mm.
  const Grade gate = graded("force = if button then vector(0 N, 0 N) else firm(300 N/m, face: 20 mm)");
  EXPECT_EQ(gate.standing, Standing::active);
  EXPECT_GT(gate.energy.button_watt, 0.2);
  EXPECT_LT(gate.energy.button_watt, 0.6);
}

TEST(SoughtEnergy, IsNoneWhereTheButtonSwitchesWhatOnlyTakes) {
  for (const char* force : {"if button then viscous(3 N s/m) else vector(0 N, 0 N)",
                            "spring(100 N/m) + (if button then viscous(3 N s/m) else viscous(1 N s/m))"})
    EXPECT_FALSE(graded(std::string("force = ") + force).energy.active()) << force;
}

/// What the compiler says of the energy that a material gives, with its mend; empty if nothing.
std::string said_of_energy(const std::string& physical) {
  compiling::Files files;
  SourceSet sources;
  Diagnostics diagnostics;
  const SourceId source = sources.add("test.wale", "wale 1\nmaterial m {\n  physical {\n" + physical + "\n  }\n}\n");
  if (!compile(sources, source, "", default_device, files, diagnostics)) throw std::runtime_error(physical);
  for (const auto& diagnostic : diagnostics.all())
    if (diagnostic.code == Code::undeclared_energy) return render_text(diagnostic, sources, false);
  return "";
}

// Only one of several forces gives energy, and the warning stands there, in whatever order they are written.
TEST(SoughtEnergy, IsReportedAtTheForceThatGivesIt) {
  const auto pointed_at = [](const std::string& said, const std::string& line) {
    const std::size_t shown = said.find(line), carets = said.find("^^^");
    return shown != std::string::npos && carets != std::string::npos &&
           said.find('\n', shown) == said.rfind('\n', carets);
  };
  int reported = 0;
  for (const std::string right : {"force back = -80 N/m * hand", "force drag = -1 N s/m * velocity",
                                  "force ribs = lateral(grating(x, period: 3 mm), amplitude: 1 N)",
                                  "force grip = sticky(0.3 N)"})
    for (const std::string wrong : {"force oil = 3 N s/m * velocity", "force lump = 0.4 kg * acceleration",
                                    "force turn = vector(-60 N/m * y, 60 N/m * x)"})
      for (const bool before : {false, true}) {
        const std::string said =
            said_of_energy(before ? wrong + "\n" + right : right + "\n" + wrong);
        if (said.empty()) continue;  // friction may take more than a light mass gives
        ++reported;
        EXPECT_TRUE(pointed_at(said, wrong)) << said;
      }
  EXPECT_GE(reported, 20);
}

std::string with_drag(const std::string& force, double drag) {
  return "force = " + force + " + viscous(" + std::to_string(drag) + " N s/m)";
}

// A force f along the motion gives f v - b v^2 at most, which is f^2 / (4 b) at v = f / (2 b) and no more at any speed.
// Below 0.01 W, the least that is declared, no finer pace is looked for.
TEST(SoughtEnergy, OfASourceIsLessTheMoreDragThereIs) {
  for (const double f : {0.3, 1.0, 2.0}) {
    double before = HUGE_VAL;
    for (const double b : {0.0, 3.0, 10.0, 20.0, 40.0}) {
      const std::string source = "vector(" + std::to_string(f) + " N * sin(2 pi * phase(3 Hz)), 0 N)";
      const double watt = graded(with_drag(source, b)).energy.watt();
      const double most = std::min(f * hand.speed(), b > 0 ? f * f / (4 * b) : HUGE_VAL);
      EXPECT_LE(watt, most * 1.01) << f << " N, " << b << " N s/m";
      EXPECT_LE(watt, std::max(before * 1.01, 0.01)) << f << " N, " << b << " N s/m";
      if (most > 0.05) EXPECT_GT(watt, 0.1 * most) << f << " N, " << b << " N s/m";
      before = watt;
    }
  }
}

// What a spring stores and returns is no energy of the source beside it.
TEST(SoughtEnergy, OfASourceIsThatWithoutTheSpringBesideIt) {
  const double alone = graded("force = " + shaking).energy.watt();
  for (const char* spring : {"spring(50 N/m)", "spring(150 N/m)", "-100 N/m * hand"})
    EXPECT_NEAR(graded("force = " + shaking + " + " + spring).energy.watt(), alone, 0.15 * alone) << spring;
  EXPECT_FALSE(graded("force = spring(200 N/m) + vector(1 mN * sin(2 pi * phase(3 Hz)), 0 N)").energy.active());
}

// On circles of radius r at speed v a swirl of c N/m gives c r v, and drag takes b v^2. A button of f N gives 2 r f on
// each stroke to and fro, of which drag takes b (2 pi r)^2 / 2 at 1 Hz; the largest of all r is f^2 / (b pi^2 / 2) / 4.
TEST(SoughtEnergy, OfASwirlAndOfAButtonIsLessWhatDragTakes) {
  EXPECT_NEAR(graded("force = 10 N/m * perpendicular(hand)").energy.watt(), 10 * 0.04 * hand.speed(), 0.01);
  for (const double b : {1.0, 3.0, 10.0, 40.0}) {
    const double swirled = graded(with_drag("10 N/m * perpendicular(hand)", b)).energy.watt();
    EXPECT_LE(swirled, 0.4 * 0.4 / (4 * b) * 1.02) << b;
    const std::string push = "(if button then vector(1 N, 0 N) else vector(0 N, 0 N))";
    const double pushed = graded(with_drag(push, b)).energy.watt();
    EXPECT_LE(pushed, 0.04 / b * 2) << b;
    EXPECT_LE(pushed, 0.081) << b;
    if (b <= 3) {
      EXPECT_GT(swirled, 0.4 * 0.4 / (4 * b) * 0.5) << b;
      EXPECT_GT(pushed, 0.008) << b;
    }
  }
}

// Forces towards a centre have no curl; only the device's limit along x and y makes one.
TEST(SoughtEnergy, OfCentralForcesIsThatOfTheLimitAlsoBesideATexture) {
  const std::string wall = "-700 N/m * max(0 mm, length(hand) - 25 mm) * hand / max(length(hand), 0.1 mm)";
  for (const std::string& rings : {std::string(), std::string(" + lateral(grating(length(hand), period: 5 mm), "
                                                              "amplitude: 0.7 N)")}) {
    const std::string said = said_of_energy("force = " + wall + rings);
    EXPECT_NE(said.find("limits its force along x and y separately"), std::string::npos) << rings << said;
    EXPECT_NE(said.find("limit 10 N"), std::string::npos) << rings << said;
  }
  EXPECT_NE(said_of_energy("force = 20 N/m * perpendicular(hand) + lateral(grating(length(hand), period: 5 mm), "
                           "amplitude: 0.7 N)")
                .find("has a curl"),
            std::string::npos);
}

}  // namespace
}  // namespace wale::sought_energy_test
