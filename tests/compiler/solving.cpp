// Laws solved for their carriers, against closed forms.

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>

#include "compiler/expression/check_expression.hpp"
#include "compiler/solve/isolate.hpp"
#include "tests/compiler/compiling.hpp"

namespace wale::compiling::solving_test {
namespace {

/// An equation of numbers and one unknown.
struct Equation {
  Terms terms;
  TermId unknown = terms.add({.kind = TermKind::carrier});

  TermId number(double value) { return terms.literal(value); }

  /// The unknown, when `left` is `value`; not-a-number where it cannot be solved for.
  double solved(TermId left, double value) {
    const auto term = isolate(terms, left, number(value), unknown);
    return term ? constant_value(terms, *term).value_or(std::nan("")) : std::nan("");
  }
};

TEST(Isolate, UndoesEachOperation) {
  Equation e;
  const TermId x = e.unknown;
  const auto apply = [&](Operation operation, TermId a, TermId b) { return e.terms.apply(operation, a, b); };
  EXPECT_DOUBLE_EQ(e.solved(x, 7), 7);
  EXPECT_DOUBLE_EQ(e.solved(apply(Operation::add, x, e.number(2)), 7), 5);
  EXPECT_DOUBLE_EQ(e.solved(apply(Operation::add, e.number(2), x), 7), 5);
  EXPECT_DOUBLE_EQ(e.solved(apply(Operation::subtract, x, e.number(2)), 7), 9);
  EXPECT_DOUBLE_EQ(e.solved(apply(Operation::subtract, e.number(2), x), 7), -5);
  EXPECT_DOUBLE_EQ(e.solved(apply(Operation::multiply, x, e.number(2)), 7), 3.5);
  EXPECT_DOUBLE_EQ(e.solved(apply(Operation::multiply, e.number(2), x), 7), 3.5);
  EXPECT_DOUBLE_EQ(e.solved(apply(Operation::divide, x, e.number(2)), 7), 14);
  EXPECT_DOUBLE_EQ(e.solved(apply(Operation::divide, e.number(14), x), 7), 2);
  EXPECT_DOUBLE_EQ(e.solved(e.terms.apply(Operation::negate, x), 7), -7);
  EXPECT_DOUBLE_EQ(e.solved(e.terms.apply(Operation::exp2, x), 8), 3);
  EXPECT_DOUBLE_EQ(e.solved(e.terms.apply(Operation::log2, x), 3), 8);
  EXPECT_DOUBLE_EQ(e.solved(e.terms.apply(Operation::square_root, x), 3), 9);
}

TEST(Isolate, FindsTheUnknownOnEitherSideAndDeepInside) {
  Equation e;
  // 3 * log2(2 * x + 1) - 4 = 5
  const TermId inner =
      e.terms.apply(Operation::add, e.terms.apply(Operation::multiply, e.number(2), e.unknown), e.number(1));
  const TermId left = e.terms.apply(
      Operation::subtract, e.terms.apply(Operation::multiply, e.number(3), e.terms.apply(Operation::log2, inner)),
      e.number(4));
  EXPECT_DOUBLE_EQ(e.solved(left, 5), 3.5);
  const auto turned = isolate(e.terms, e.number(5), left, e.unknown);
  ASSERT_TRUE(turned);
  EXPECT_DOUBLE_EQ(*constant_value(e.terms, *turned), 3.5);
}

TEST(Isolate, GivesUpWhereItMust) {
  Equation e;
  const TermId x = e.unknown;
  EXPECT_TRUE(std::isnan(e.solved(e.number(3), 7))) << "no unknown";
  EXPECT_TRUE(std::isnan(e.solved(e.terms.apply(Operation::multiply, x, x), 9))) << "two of them";
  EXPECT_TRUE(std::isnan(e.solved(e.terms.apply(Operation::sine, x), 0.5))) << "many solutions";
  EXPECT_TRUE(std::isnan(e.solved(e.terms.apply(Operation::minimum, x, e.number(3)), 2))) << "no inverse";
}

TEST(Isolate, IsLinearInTheSizeOfTheLaw) {
  // There are 2^200 paths to the constant, so following each would never end.
  Equation e;
  TermId shared = e.number(0.5);
  for (int i = 0; i < 200; ++i)
    shared = e.terms.apply(Operation::multiply, e.number(0.5), e.terms.apply(Operation::add, shared, shared));
  EXPECT_DOUBLE_EQ(e.solved(e.terms.apply(Operation::add, e.unknown, shared), 2), 1.5);
}

/// The amplitude that a law gives for a level, when level 1 is 4 N.
double amplitude_by(const std::string& law, double level) {
  const std::string declarations = fmt::format(
      "percept grit {{ one lateral amplitude 4 N on sandpaper }}\n"
      "map grit from amplitude {{\n  law {}\n  valid amplitude 0.01 N .. 4 N\n  scatter 0.05\n"
      "  evidence slope measured, anchor measured, handle measured\n  on sandpaper\n  source \"a test\"\n}}\n",
      law);
  const Program program =
      compiled("    force = lateral(grating(x, period: 2 mm))", declarations, fmt::format("grit {}", level));
  return amplitude(Bank(program), 0);
}

TEST(SolvedAmplitude, IsTheClosedForm) {
  // A level is the magnitude as a fraction of the magnitude at 4 N.
  EXPECT_NEAR(amplitude_by("magnitude = amplitude / 1 N", 0.5), 4 * 0.5, 1e-6);
  EXPECT_NEAR(amplitude_by("magnitude = 3 * (amplitude / 1 N)^0.5", 0.5), 4 * 0.25, 1e-5);
  EXPECT_NEAR(amplitude_by("magnitude = 2 * (amplitude / 1 N)^1.7", 0.5), 4 * std::pow(0.5, 1 / 1.7), 1e-5);
  EXPECT_NEAR(amplitude_by("log10(magnitude) = 0.8 * log10(amplitude / 1 N) + 0.3", 0.25), 4 * std::pow(0.25, 1 / 0.8),
              1e-5);
  EXPECT_NEAR(amplitude_by("magnitude = log(1 + amplitude / 2 N)", 0.5), 2 * (std::exp(0.5 * std::log(3.0)) - 1), 1e-5);
  EXPECT_NEAR(amplitude_by("sqrt(magnitude) = amplitude / 2 N", 0.25), 2, 1e-6);
  EXPECT_NEAR(amplitude_by("1 / magnitude = 3 N / amplitude", 0.3), 1.2, 1e-6);
  EXPECT_NEAR(amplitude_by("exp(magnitude) = 1 + amplitude / 1 N", 0.5), std::sqrt(5.0) - 1, 1e-5);
}

TEST(SolvedAmplitude, OfMinskysMap) {
  const Program program = compiled("    force = lateral(grating(x, period: 2 mm))", "", "roughness 0.6");
  EXPECT_NEAR(amplitude(Bank(program), 0), 194 * 10.0 / 512 * std::pow(0.6, 1 / 0.759593), 1e-5);
  // A level that is set at run time is solved by the same law.
  const auto index = program.parameter("roughness");
  ASSERT_TRUE(index);
  auto parameters = program.default_parameters();
  parameters[*index] = 0.3f;
  EXPECT_NEAR(amplitude(Bank(program, parameters, program.default_size()), 0),
              194 * 10.0 / 512 * std::pow(0.3, 1 / 0.759593), 1e-5);
}

TEST(SolvedAmplitude, ReadsBackAsItsLevel) {
  const Program program = compiled("    force = lateral(grating(x, period: 2 mm))", "", "roughness 0.6");
  EXPECT_NEAR(predict(Bank(program), 0, amplitude(Bank(program), 0)).level, 0.6, 1e-6);
  // log10 R = 0.759593 log10(99.02) - 0.513365 at 1.934 N, 99.02 program units
  EXPECT_NEAR(predict(Bank(program), 0, 1.934f).magnitude, std::pow(10, 0.759593 * std::log10(1.934 * 51.2) - 0.513365),
              1e-4);
}

TEST(SolvedAmplitude, OfAPerceptAloneIsTheDevicesOwnRealisation) {
  const Program program = Compiled("wale 1\nmaterial m { perceptual { roughness 0.6 } }\n").only();
  ASSERT_EQ(program.description().percepts.size(), 1u);
  EXPECT_NEAR(amplitude(Bank(program), 0), 1.934, 0.0005);
}

/// Whether a material compiles with this percept and the amplitude of `level` by Minsky's map. Other errors than W0403
/// fail the test.
bool agree(const std::string& percept, double level) {
  const double amplitude = 194 * 10.0 / 512 * std::pow(level, 1 / 0.759593);
  try {
    compiled(fmt::format("    force = lateral(grating(x, period: 2 mm), amplitude: {:.6f} N)", amplitude), "", percept);
    return true;
  } catch (const std::runtime_error& error) {
    EXPECT_NE(std::string(error.what()).find("error[W0403]"), std::string::npos) << error.what();
    return false;
  }
}

TEST(GivenAmplitude, AgreesWithinTheScatterOfTheMap) {
  // The scatter is 0.0519 in log10.
  for (const double level : {0.5, 0.6, 0.8}) {
    const std::string percept = fmt::format("roughness {}", level);
    EXPECT_TRUE(agree(percept, level));
    EXPECT_TRUE(agree(percept, level * std::pow(10, 0.051)));
    EXPECT_TRUE(agree(percept, level * std::pow(10, -0.051)));
    EXPECT_FALSE(agree(percept, level * std::pow(10, 0.053)));
    EXPECT_FALSE(agree(percept, level * std::pow(10, -0.053)));
  }
}

TEST(GivenAmplitude, AgreesWithinTheThreshold) {
  // For small forces the threshold is 0.1 N at d' = 1, which is wider than the scatter of the map.
  const auto level_of = [](double newton) { return std::pow(newton / (194 * 10.0 / 512), 0.759593); };
  const double newton = 194 * 10.0 / 512 * std::pow(0.2, 1 / 0.759593);
  EXPECT_TRUE(agree("roughness 0.2", level_of(newton + 0.095)));
  EXPECT_FALSE(agree("roughness 0.2", level_of(newton + 0.105)));
  EXPECT_TRUE(agree("roughness 0.2", level_of(newton - 0.095)));
  EXPECT_FALSE(agree("roughness 0.2", level_of(newton - 0.105)));
}

TEST(GivenAmplitude, AgreesWithinATolerance) {
  for (const std::string percept : {"roughness 0.6 ± 0.15", "roughness 0.6 +- 0.15", "roughness 60 % ± 15 %"}) {
    EXPECT_TRUE(agree(percept, 0.749)) << percept;
    EXPECT_TRUE(agree(percept, 0.451)) << percept;
    EXPECT_FALSE(agree(percept, 0.751)) << percept;
    EXPECT_FALSE(agree(percept, 0.449)) << percept;
  }
  // A tolerance widens the scatter and never narrows it: the scatter alone allows up to 0.676.
  EXPECT_TRUE(agree("roughness 0.6 ± 0.01", 0.67));
  EXPECT_TRUE(agree("roughness 0.6 ± 0.1", 0.69));
  EXPECT_FALSE(agree("roughness 0.6", 0.69));
  EXPECT_FALSE(agree("roughness 0.6 ± 0.1", 0.71));
  EXPECT_FALSE(agree("roughness 0.6 ± 0.1", 0.49));
}

TEST(SolvedAmplitude, DoesNotDependOnTheTolerance) {
  const auto at = [](const std::string& percept) {
    Bank bank(compiled("    force = lateral(grating(x, period: 2 mm))", "", percept));
    return amplitude(bank, 0);
  };
  EXPECT_EQ(at("roughness 0.6"), at("roughness 0.6 ± 0.2"));
}

}  // namespace
}  // namespace wale::compiling::solving_test
