// Random materials give the same force in the machine as in the slow evaluator of tests/reference/, which has no terms,
// graphs, folding or sharing.

#include <gtest/gtest.h>

#include <bit>
#include <cmath>

#include "compiler/parse/parse.hpp"
#include "tests/compiler/compiling.hpp"
#include "tests/compiler/random_material.hpp"
#include "tests/reference/evaluator.hpp"

namespace wale::compiling::expressions_test {
namespace {

constexpr int materials = 2000, hands_each = 12;

/// Uniform in -1 .. 1.
double uniform(std::mt19937& random) { return random() / 2147483648.0 - 1; }

SyntaxTree parsed(const std::string& text) {
  SourceSet sources;
  Diagnostics diagnostics;
  return parse(sources, sources.add("test.wale", text), diagnostics);
}

TEST(RandomMaterials, MachineAndReferenceAgree) {
  std::mt19937 random(1995);
  long compared = 0, undecided = 0, vague = 0;
  for (std::uint32_t seed = 0; seed < materials; ++seed) {
    RandomMaterial material(seed);
    material.write();
    const std::string text = material.text(false);
    const SyntaxTree tree = parsed(text);
    const Program program = Compiled(text).only();

    for (int each = 0; each < hands_each; ++each) {
      const auto in = [&](double size) { return static_cast<float>(size * uniform(random)); };
      Hand hand;
      hand.position = {in(0.07), in(0.07)};
      hand.velocity = {in(0.5), in(0.5)};
      hand.acceleration = {in(8), in(8)};
      hand.time = 5 + in(5);
      hand.button = in(1) > 0;
      std::vector<float> parameters = program.default_parameters();
      std::map<std::string, double> values;
      for (std::size_t i = 0; i < parameters.size(); ++i) {
        if (each > 0) parameters[i] *= static_cast<float>(1 + 0.4 * uniform(random));
        const auto& declared = program.description().parameters[i];
        parameters[i] = std::min(std::max(parameters[i], declared.low), declared.high);
        values[declared.name] = parameters[i];
      }
      reference::Quantity expected;
      try {
        expected = reference::force(tree,
                                    {.x = hand.position.x,
                                     .y = hand.position.y,
                                     .vx = hand.velocity.x,
                                     .vy = hand.velocity.y,
                                     .ax = hand.acceleration.x,
                                     .ay = hand.acceleration.y,
                                     .time = hand.time,
                                     .button = hand.button},
                                    values);
      } catch (const reference::Undecided&) {
        ++undecided;
        continue;
      }
      // `error` is a bound on the sum of all roundings. Above 0.01 N it is too wide for a comparison.
      if (std::max(expected.error[0], expected.error[1]) > 0.01) {
        ++vague;
        continue;
      }
      ++compared;
      Bank bank(program, parameters, program.default_size());
      const Force force = tick(bank, hand);
      for (int axis = 0; axis < 2; ++axis)
        ASSERT_NEAR(force[axis], expected.value[axis], expected.error[axis] + 1e-12)
            << "seed " << seed << ", axis " << axis << ", hand " << hand.position.x << " " << hand.position.y << ", "
            << hand.velocity.x << " " << hand.velocity.y << "\n"
            << text;
    }
  }
  RecordProperty("compared", std::to_string(compared));
  EXPECT_GT(compared, materials * hands_each / 2) << undecided << " undecided, " << vague << " vague";
}

/// The force's bits at a few hands.
std::vector<std::uint32_t> bits(const Program& program) {
  std::mt19937 random(7);
  Bank bank(program);
  std::vector<std::uint32_t> all;
  for (int i = 0; i < 8; ++i) {
    const Force force =
        tick(bank, {{static_cast<float>(0.07 * uniform(random)), static_cast<float>(0.07 * uniform(random))},
                    {static_cast<float>(uniform(random)), static_cast<float>(uniform(random))}});
    all.insert(all.end(), {std::bit_cast<std::uint32_t>(force.x), std::bit_cast<std::uint32_t>(force.y)});
  }
  return all;
}

TEST(RandomMaterials, AChangeOfRateChangesNoBit) {
  for (std::uint32_t seed = 0; seed < 500; ++seed) {
    RandomMaterial material(seed);
    material.write();
    ASSERT_EQ(bits(Compiled(material.text(false)).only()), bits(Compiled(material.text(true)).only()))
        << material.text(false);
  }
}

TEST(Rates, AGratingOfConstantsIsTheGratingOfParameters) {
  const auto grating = [](const std::string& word) {
    return compiled("    " + word + " wale = 2.7 mm\n    " + word + " share = 0.4\n    " + word + " soft = 0.11\n    " +
                    word +
                    " push = 1.7 N\n    force = lateral(grating(x + 0.3 * y, period: wale, duty: share, smooth: soft), "
                    "amplitude: push)");
  };
  EXPECT_EQ(bits(grating("let")), bits(grating("param")));
}

TEST(Rates, ATableMayBeReadWhereNothingMoves) {
  Files files;
  files.contents["push.csv"] = "place (mm),push (N)\n0,0\n1,1\n2,3\n3,2\n";
  const Program program = compiled(
      "    param at = 2 mm in 0 mm .. 3 mm\n    let push = table(\"push.csv\")\n"
      "    force = vector(push(1 mm) + push(at), push(3 mm) + 1 N/m * x)",
      "", "", files);
  Bank bank(program);
  const Force force = tick(bank, {{0.01f, -0.02f}, {0, 0}});
  EXPECT_NEAR(force.x, 1 + 3, 1e-4);
  EXPECT_NEAR(force.y, 2 + 0.01, 1e-4);
  const std::vector<float> elsewhere{0.001f};
  Bank other(program, elsewhere, program.default_size());
  EXPECT_NEAR(tick(other, {{0.01f, -0.02f}, {0, 0}}).x, 1 + 1, 1e-4);
}

TEST(Rates, ASolvedAmplitudeIsComputedInSetup) {
  const auto asked = compiled("    force = lateral(grating(x, period: 2 mm))", "", "roughness 0.6");
  const auto given = compiled(
      "    param push = 1.934 N in 0 N .. 5 N\n    force = lateral(grating(x, period: 2 mm), amplitude: push)");
  EXPECT_EQ(asked.description().tick.size(), given.description().tick.size());
}

TEST(Arguments, AreEvaluatedWhereTheyAreWritten) {
  // Inside the function, `k` is its parameter; outside, it is the material's `k`.
  const Program program = compiled("    let k = 2 N/m\n    force = scaled(3, 1 N/m) * hand + k * hand",
                                   "function scaled(k, unit) = k * unit");
  Bank bank(program);
  EXPECT_FLOAT_EQ(tick(bank, {{0.01f, -0.02f}, {0, 0}}).x, 0.05f);
  EXPECT_FLOAT_EQ(tick(bank, {{0.01f, -0.02f}, {0, 0}}).y, -0.1f);
}

}  // namespace
}  // namespace wale::compiling::expressions_test
