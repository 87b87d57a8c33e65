// The compiler does no more work than a text deserves. Work is counted and not timed: the operations that the compiler
// charges, and, since a stage might forget to charge, the memory that it allocates.

#include <gtest/gtest.h>

#include <algorithm>

#include "tests/compiler/compiling.hpp"
#include "tests/compiler/growing.hpp"
#include "tests/usb/allocations.hpp"

namespace wale::growing::work_test {
namespace {

struct Outcome {
  bool good = false;
  std::string error;  ///< the code of the first one
  std::size_t operations = 0;
  long allocations = 0;
};

/// Compiles the last material of a text.
Outcome outcome_of(const std::string& text) {
  compiling::Files files;
  files.contents["relation.csv"] = "x (mm), force (N)\n0, 0\n1, 1\n2, 0\n";
  const long before = test::allocations;
  SourceSet sources;
  Diagnostics diagnostics;
  const SourceId source = sources.add("growing.wale", text);
  const CheckedModule module = check_source(sources, source, files, diagnostics);
  Outcome outcome;
  outcome.operations = diagnostics.budget().taken();
  if (!diagnostics.has_errors() && !module.materials.empty()) {
    outcome.good =
        compile_material(module, module.materials.back().name, default_device, sources, source, files, diagnostics)
            .has_value();
    outcome.operations += diagnostics.budget().taken();
  }
  outcome.allocations = test::allocations - before;
  for (const auto& each : diagnostics.all())
    if (outcome.error.empty() && severity_of(each.code) == Severity::error) outcome.error = code_name(each.code);
  return outcome;
}

std::string of_material(const Part& part) {
  return materials()[0].grow(0, part.declarations, "",
                             part.statements + "force = vector(1 N * " + part.value + ", 0 N)\n");
}

/// An operation allocates at most a few times; and a text may be at the limit twice, when it is read and when its
/// material is compiled.
void expect_bounded(const std::string& name, int n, const std::string& text) {
  const Outcome outcome = outcome_of(text);
  const double most = 2.0 * static_cast<double>(Budget::for_any_text + Budget::for_each_byte * text.size());
  EXPECT_LE(static_cast<double>(outcome.operations), most) << name << " " << n;
  EXPECT_LE(static_cast<double>(outcome.allocations), most) << name << " " << n;
}

TEST(Work, OfEachConstructIsBounded) {
  for (const int n : {12, 50, 200}) {
    for (const auto& each : texts()) expect_bounded(each.name, n, each.grow(n));
    for (const auto& each : expressions()) expect_bounded(each.name, n, of_material(each.grow("p", n, "x / 1 mm")));
    for (const auto& each : materials()) {
      expect_bounded(each.name, n, each.grow(n, "", "", "force = spring(1 N/m)\n"));
      expect_bounded(each.name, n, each.grow(n, "", "roughness 0.5", "force = lateral(sin(k * x / 1 mm))\n"));
    }
  }
}

/// One construct inside another; `build/tests/bench_growth` tries them all.
TEST(Work, OfSomePairsIsBounded) {
  const auto all = expressions();
  for (std::size_t i = 0; i < all.size(); ++i) {
    const Expressions &outer = all[i], &inner = all[(7 * i + 5) % all.size()];
    const Part within = inner.grow("q", 16, "x / 1 mm");
    Part whole = outer.grow("p", 16, within.value);
    whole.declarations.insert(0, within.declarations);
    whole.statements.insert(0, within.statements);
    expect_bounded(std::string(outer.name) + " of " + inner.name, 16, of_material(whole));
  }
}

// Seen on the way here: these ran for minutes, or would have run for years.

std::string blends_of_blends(int levels) { return materials()[1].grow(levels, "", "", "force = spring(1 N/m)\n"); }

TEST(Work, OfBlendsOfBlendsIsRefusedBeforeItIsDone) {
  ASSERT_STREQ(materials()[1].name, "blends of one material");
  for (const int levels : {14, 20, 40, 60}) {
    const Outcome outcome = outcome_of(blends_of_blends(levels));
    EXPECT_EQ(outcome.error, "W0603") << levels;
    EXPECT_LT(outcome.operations, 1u << 20) << levels;
    EXPECT_LT(outcome.allocations, 1 << 20) << levels;
  }
}

/// Each parameter of `between` that one of the two gives a value has the parts of both.
TEST(Work, OfMixturesOfMixturesIsRefusedBeforeItIsDone) {
  std::string text =
      "wale 1\nmaterial m0 { physical {\nparam j = 1 in 0 .. 9\nparam k = 1 in 0 .. 9\nforce = spring(j * k * 1 N/m)\n"
      "} }\nmaterial m1 = between(m0(j: 2, k: 3), m0, 0.5)\n";
  for (int i = 1; i < 40; ++i) text += fmt::format("material m{} = between(m{}, m{}, 0.5)\n", i + 1, i, i);
  const Outcome outcome = outcome_of(text);
  EXPECT_EQ(outcome.error, "W0603");
  EXPECT_LT(outcome.operations, 2u << 20);
  EXPECT_LT(outcome.allocations, 1 << 21);
}

TEST(Work, OfSmallBlendsOfBlendsIsDone) {
  const Outcome outcome = outcome_of(blends_of_blends(6));
  EXPECT_TRUE(outcome.good) << outcome.error;
}

/// A flat blend is linear work, and no special case of a blend of blends.
TEST(Work, OfNineHundredComponentsIsDone) {
  std::string text = "wale 1\nmaterial m { physical { force = spring(1 N/m) } }\nmaterial b = 0.001 m";
  for (int i = 0; i < 900; ++i) text += " + 0.001 m";
  const Outcome outcome = outcome_of(text + "\n");
  EXPECT_TRUE(outcome.good) << outcome.error;
}

TEST(Work, OfASharedSumIsThatOfTheSum) {
  for (const auto& each : texts())
    if (const std::string name = each.name; name == "a sum of forces with itself" || name == "a law of squares") {
      const Outcome few = outcome_of(each.grow(10)), many = outcome_of(each.grow(60));
      EXPECT_LT(many.operations, 20 * few.operations) << each.name;
    }
}

/// No material that somebody would write comes near.
TEST(Work, OfTwelveTexturesIsAFortieth) {
  std::string lines;
  for (int i = 0; i < 12; ++i) {
    const std::string n = std::to_string(i);
    lines += "param p" + n + " = 2 mm in 1 mm .. 5 mm\nheight h" + n + " = grating(x, period: p" + n + ")\nforce f" +
             n + " = lateral(h" + n + ", amplitude: 0.1 N)\n";
  }
  const Outcome outcome = outcome_of(material("m", "", lines).insert(0, "wale 1\n"));
  EXPECT_TRUE(outcome.good) << outcome.error;
  EXPECT_LT(outcome.operations, Budget::for_any_text / 40);
}

}  // namespace
}  // namespace wale::growing::work_test
