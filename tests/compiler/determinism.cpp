// The same text gives the same bytes, and the size of a program is linear in the size of its text.

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "tests/compiler/compiling.hpp"
#include "tests/compiler/random_material.hpp"
#include "wale/patch_program.hpp"

namespace wale::compiling::determinism_test {
namespace {

TEST(Determinism, SameTextSameBytes) {
  for (std::uint32_t seed = 0; seed < 50; ++seed) {
    RandomMaterial material(seed);
    material.write();
    const std::string text = material.text(false);
    EXPECT_EQ(write_patch_program(Compiled(text).only().description()),
              write_patch_program(Compiled(text).only().description()))
        << text;
  }
}

TEST(Determinism, OtherMaterialsOfTheFileChangeNothing) {
  const std::string one = "material a { physical { force = lateral(grating(x, period: 2 mm), amplitude: 1 N) } }\n";
  const std::string other =
      "material b { perceptual { roughness 0.4 } physical { force = lateral(grating(y, period: 3 mm)) } }\n";
  const auto alone = Compiled("wale 1\n" + one), both = Compiled("wale 1\n" + other + one);
  PatchProgram first = alone.programs.at("a").description(), second = both.programs.at("a").description();
  EXPECT_EQ(first.place_of(CodeSection::tick, 0, 0), (SourceLine{"test.wale", 2}));
  EXPECT_EQ(second.place_of(CodeSection::tick, 0, 0), (SourceLine{"test.wale", 3}));
  first.places = second.places = {};  // lines differ
  EXPECT_EQ(write_patch_program(first), write_patch_program(second));
}

TEST(Sharing, AChainOfLetsIsLinear) {
  // Expanded, the last `let` would have 2^10000 terms. Each `let` is two instructions and shares those before it.
  constexpr int links = 10000;
  std::string body = "    let a0 = x / 1 m\n";
  for (int i = 1; i <= links; ++i) body += fmt::format("    let a{} = 0.25 * a{} + a{} / 4\n", i, i - 1, i - 1);
  const Program program = compiled(body + fmt::format("    force = vector(a{} * 1 N, 0 N)", links));
  EXPECT_LE(program.description().tick.size(), 3u * links + 10);
  EXPECT_GE(program.description().tick.size(), 2u * links);
}

TEST(Sharing, AChainOfSumsOfOneIsLinear) {
  // Each link depends on the hand and is one operation of the tick. Twenty links multiply by 2^20.
  const auto chain = [](int links) {
    std::string body = "    let a0 = x\n";
    for (int i = 1; i <= links; ++i) body += fmt::format("    let a{} = a{} + a{}\n", i, i - 1, i - 1);
    return compiled(body + fmt::format("    force = vector(a{} * 1e-6 N/m, 0 N)", links));
  };
  EXPECT_LE(chain(10000).description().tick.size(), 10010u);
  Bank bank(chain(20));
  EXPECT_FLOAT_EQ(tick(bank, {{0.05f, 0}, {0, 0}}).x, 0.05f * 1048576 * 1e-6f);
}

TEST(Sharing, AChainThroughFunctionsIsLinear) {
  constexpr int links = 10000;
  std::string body = "    let a0 = x / 1 m\n";
  for (int i = 1; i <= links; ++i)
    body += fmt::format("    let a{} = {}(a{}, a{})\n", i, i % 2 == 0 ? "half" : "bent", i - 1, i - 1);
  const Program program = compiled(body + fmt::format("    force = vector(a{} * 1 N, 0 N)", links),
                                   "function half(a, b) = 0.25 * a + b / 4\n"
                                   "function bent(a, b) = half(a, sin(b)) + half(sin(a), b)");
  // By hand: `half` has two products and a sum; `bent` has these twice, a sum and two sines.
  EXPECT_LE(program.description().tick.size(), 6u * links + 10);
  EXPECT_GE(program.description().tick.size(), 2u * links);
}

TEST(Sharing, AChainOfConstantsIsLinear) {
  std::string lets = "let c0 = 1\n";
  for (int i = 1; i <= 60; ++i) lets += fmt::format("let c{} = 0.5 * c{} + c{} / 2\n", i, i - 1, i - 1);
  const Program program = compiled("    force = -c60 * 1 N/m * hand", lets);
  Bank bank(program);
  EXPECT_FLOAT_EQ(tick(bank, {{0.05f, 0}, {0, 0}}).x, -0.05f);
}

TEST(Sharing, EqualExpressionsAreOneValue) {
  const auto instructions = [](const std::string& force) {
    return compiled("    force = " + force).description().tick.size();
  };
  EXPECT_EQ(instructions("vector(sin(x / 1 mm) * 1 N, 0 N)") + 1,
            instructions("vector(sin(x / 1 mm) * 1 N + sin(x / 1 mm) * 1 N, 0 N)"));
}

}  // namespace
}  // namespace wale::compiling::determinism_test
