// The shape of a force is read without the device's limit.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "compiler/compile.hpp"
#include "compiler/emit/emit.hpp"
#include "compiler/emit/lower.hpp"

namespace wale::unlimited_test {
namespace {

/// The largest force over 2 000 places of a material that pushes with 400 N at most.
double largest(bool limited) {
  SourceSet sources;
  Diagnostics diagnostics;
  const auto resolver = file_resolver({});
  const SourceId source =
      sources.add("test.wale",
                  "wale 1\nmaterial m { physical { force = vector(400 N * sin(2 pi * x / 5 mm), 0 N) } "
                  "}\n");
  const CheckedModule module = check_source(sources, source, *resolver, diagnostics);
  SolvedMaterial solved = solve(module.materials.front(), module, default_device, sources, *resolver, diagnostics);
  solved.limited = limited;
  const auto program = emit(lower(solved, diagnostics), solved, diagnostics);
  const auto loaded = Program::load(program.value());
  const Bank bank(*loaded);
  double most = 0;
  for (int i = 0; i < 2000; ++i) {
    Bank moved = bank;
    most = std::max<double>(most, std::abs(tick(moved, {.position = {static_cast<float>(i) * 1e-5f, 0}}).x));
  }
  return most;
}

TEST(Unlimited, AForceKeepsItsSize) {
  EXPECT_NEAR(largest(false), 400, 0.1);
  EXPECT_FLOAT_EQ(static_cast<float>(largest(true)), 10);
}

}  // namespace
}  // namespace wale::unlimited_test
