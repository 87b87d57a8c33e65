// Values of many hands do not depend on the thread that computes them.

#include "compiler/grade/field.hpp"

#include <gtest/gtest.h>

#include <bit>

#include "compiler/grade/lift.hpp"
#include "compiler/measure/hands.hpp"
#include "tests/compiler/compiling.hpp"

namespace wale {
namespace {

TEST(LiftedField, ManyHandsGiveTheSameBitsAsFew) {
  compiling::Files files;
  SourceSet sources;
  Diagnostics diagnostics;
  const SourceId source =
      sources.add("test.wale",
                  "wale 1\nmaterial m { physical {\n"
                  "force = lateral(gradient_noise(x / 2 mm, y / 3 mm) + noise2(x / 1 mm, y / 1 mm), amplitude: 2 N) +\n"
                  "  viscous(2 N s/m * noise3(x / 3 mm, y / 3 mm, time / 50 ms)) limit 3 N\n} }\n");
  const auto program = compile(sources, source, "", default_device, files, diagnostics);
  ASSERT_TRUE(program);
  const Bank bank(*program);
  const LiftedTick lifted = lift(bank);
  LiftedField field(lifted.graph, lifted.force, bank);
  ASSERT_TRUE(field.fits());
  // Enough hands for several threads, and a last block that is not full.
  const auto hands = hands_in_motion(40'061, {0.08f, 0.08f}, 0.5f);
  std::vector<float> all, some;
  field.evaluate(hands, {}, all);
  constexpr std::size_t few = 1000;
  for (std::size_t first = 0; first < hands.size(); first += few) {
    const std::size_t count = std::min(few, hands.size() - first);
    field.evaluate(std::span(hands).subspan(first, count), {}, some);
    for (std::size_t axis = 0; axis < 2; ++axis)
      for (std::size_t i = 0; i < count; ++i)
        ASSERT_EQ(std::bit_cast<std::uint32_t>(all[axis * hands.size() + first + i]),
                  std::bit_cast<std::uint32_t>(some[axis * count + i]))
            << first + i;
  }
}

}  // namespace
}  // namespace wale
