// A reading that is multiplied, against the reading of the stronger program itself.
#include "compiler/read/proportional.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <string>

#include "compiler/modules/load_modules.hpp"
#include "compiler/read/cues.hpp"
#include "tests/standard/standard.hpp"

namespace wale::proportional_test {
namespace {

Program with_slider(const std::string& slider, const std::string& force) {
  return standard::material("material m { physical {\n    " + slider + "\n    force = " + force + "\n} }", "m");
}

Bank set_to(const Program& program, float value) {
  const std::array values{value};
  return Bank(program, values, Bank(program).size());
}

TEST(Proportional, AMultipliedReadingIsThatOfTheStrongerProgram) {
  static const auto common = common_modules();
  constexpr const char* forces[] = {
      "strength * lateral(grating(x, period: 3 mm), amplitude: 0.5 N)",
      "strength * (lateral(grating(y, period: 20 mm), amplitude: 0.5 N) + vector(0.3 N, 0.1 N))",
      "strength * (vector(-20 N/m * x, -5 N/m * y) + firm(100 N/m, face: 50 mm))",
      "strength * (vector(-1 N s/m * velocity.x, 0 N) + vector(0 N, -0.4 N * sign(velocity.y)))",
      "strength * -0.05 kg * acceleration"};
  for (const char* force : forces) {
    const Program program = with_slider("param strength = 1 in 0 .. 2", force);
    for (const float times : {0.5f, 1.7f}) {
      const Bank here = set_to(program, 1), there = set_to(program, times);
      const auto found = times_as_strong(here, there);
      ASSERT_TRUE(found) << force;
      EXPECT_NEAR(*found, times, 1e-4 * times) << force;
      const Cues told = cues_of(there, times_as_strong(read(here, common->declarations), *found));
      const Cues truth = cues_of(there, read(there, common->declarations));
      for (std::size_t i = 0; i < cue_count; ++i) {
        ASSERT_EQ(told.values[i].has_value(), truth.values[i].has_value()) << force << ' ' << cue_table()[i].name;
        if (truth.values[i]) {
          EXPECT_NEAR(*told.values[i], *truth.values[i], 0.01 * std::abs(*truth.values[i]) + 1e-4)
              << force << ' ' << cue_table()[i].name;
        }
      }
    }
  }
}

TEST(Proportional, WhatIsNoMultipleIsToldApart) {
  const Program finer =
      with_slider("param period = 3 mm in 1 mm .. 5 mm", "lateral(grating(x, period: period), amplitude: 1 N)");
  EXPECT_FALSE(times_as_strong(set_to(finer, 3e-3f), set_to(finer, 2e-3f)));
  // The device's limit, 10 N, cuts the stronger one.
  const Program cut = with_slider("param stiffness = 50 N/m in 0 N/m .. 900 N/m", "spring(stiffness)");
  EXPECT_TRUE(times_as_strong(set_to(cut, 50), set_to(cut, 100)));
  EXPECT_FALSE(times_as_strong(set_to(cut, 50), set_to(cut, 400)));
}

}  // namespace
}  // namespace wale::proportional_test
