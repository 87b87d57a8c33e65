// Energy that shows only later, elsewhere, or with the button: whether a law gives any follows from its formula.

#include "tests/grade/grading.hpp"

namespace wale::sought_energy_test {
namespace {

using grading::graded;

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

}  // namespace
}  // namespace wale::sought_energy_test
