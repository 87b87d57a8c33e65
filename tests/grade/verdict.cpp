// The verdict in words by the damping that a device is assumed to have: of Colgate and Schenkel's damping, K T / 2 for
// a spring, the handle's own and the hand's.

#include <gtest/gtest.h>

#include "compiler/describe/describe_grade.hpp"
#include "tests/grade/grading.hpp"

namespace wale::verdict_test {
namespace {

std::string first_line(const Grade& grade, const DeviceProfile& device) {
  const std::string text = grade_text(grade, device);
  return text.substr(0, text.find('\n'));
}

/// The first line of the stability of a spring of `stiffness` N/m on the default device, whose 1 N s/m are assumed.
std::string line_of_spring(double stiffness) {
  const Program program = compiling::compiled("force = spring(" + std::to_string(stiffness) + " N/m)");
  const Grade grade = wale::grade(Bank(program), grading::hand);
  return first_line(grade, program.description().device);
}

TEST(Verdict, IsByTheAssumedDamping) {
  // 900 N/m at 900 Hz need 0.5 N s/m, 4500 N/m need 2.5, 18 000 N/m need 10.
  EXPECT_EQ(line_of_spring(900),
            "  unknown      needs a damping of 0.5 N s/m or more; by the assumed 1 N s/m: passive by itself");
  EXPECT_EQ(
      line_of_spring(4500),
      "  unknown      needs a damping of 2.5 N s/m or more; by the assumed 1 N s/m: not passive by itself, stable "
      "in the hand");
  EXPECT_EQ(line_of_spring(18000),
            "  unknown      needs a damping of 10 N s/m or more; by the assumed 1 N s/m: not passive by itself, and a "
            "hand does not make it so");
}

TEST(Verdict, IsNotGivenWithoutAFigureOrForActiveMaterials) {
  Grade grade;
  grade.standing = Standing::unknown;
  grade.required_damping = 2;
  DeviceProfile device{.name = "stick"};
  EXPECT_EQ(first_line(grade, device),
            "  unknown      needs a damping of 2 N s/m or more; the damping of `stick` is not known");
  grade.standing = Standing::active;
  grade.device_damping = device.damping = 1;
  EXPECT_EQ(first_line(grade, device),
            "  active       needs a damping of 2 N s/m or more; the damping of `stick` is assumed (1)");
  grade.standing = Standing::passive;
  grade.required_damping = 0;
  EXPECT_EQ(first_line(grade, device), "  passive      needs no damping");
  grade.standing = Standing::stable_in_the_hand;
  grade.required_damping = 2, grade.damping_known = true, grade.hand_damping = 6.5;
  EXPECT_EQ(
      first_line(grade, device),
      "  stable in the hand needs a damping of 2 N s/m or more; `stick` has 1, which leaves a margin of -1, and a "
      "hand adds 6.5");
}

TEST(Verdict, OfDryFrictionIsCalm) {
  for (const char* drag : {"0.5 N", "2 N"}) {
    const Program program = compiling::compiled(std::string("force = sticky(") + drag + ")");
    const Grade grade = wale::grade(Bank(program), grading::hand);
    EXPECT_NEAR(grade.required_damping, 600.0 / 900 / 2, 0.01) << "the bristle's stiffness";
    EXPECT_EQ(grade.assumed_standing(), Standing::passive);
    EXPECT_FALSE(grade.energy.active());
  }
}

}  // namespace
}  // namespace wale::verdict_test
