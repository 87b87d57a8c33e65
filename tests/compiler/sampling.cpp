// Running a trace: there is one memory, entered whenever the hand comes onto the patch.

#include <gtest/gtest.h>

#include "compiler/measure/sample.hpp"
#include "tests/runtime/programs.hpp"

namespace wale::sampling_test {
namespace {

/// A program whose force along x is the number of ticks since entering, and along y an input (0 for Input::x).
Bank counting(Input input) {
  Assembly a({9, 0, 1});
  const RegisterNumber count = a.state("count", 0, 100);
  a.evolve(count, a.constant(1), a.tick(Operation::add, count, a.constant(2)));
  a.push(0, count, a.constant(0));
  a.push(1, input == Input::x ? a.constant(1) : a.input(input), a.constant(0));
  return Bank(a.load());
}

SampledHand at(double time, float x, float speed = 0) { return {time, {.position = {x, 0}, .velocity = {speed, 0}}}; }

TEST(Sampling, ATraceIsRunWithOneMemory) {
  // The patch ends at 80 mm.
  const auto samples = sample(counting(Input::x), {at(0, 0), at(1, 0.01f), at(2, 0.05f), at(3, 0.1f), at(4, 0.09f),
                                                   at(5, 0.07f), at(6, 0.08f), at(7, -0.2f), at(8, -0.08f)});
  std::vector<float> forces;
  for (const SampledHand& one : samples) forces.push_back(one.force.x);
  EXPECT_EQ(forces, (std::vector<float>{0, 1, 2, 0, 0, 0, 1, 0, 0}));
}

TEST(Sampling, TimeIsThatOfTheTrace) {
  const auto samples = sample(counting(Input::time), {at(0.5, 0), at(2.25, 0), at(4, 0)});
  EXPECT_EQ(samples[0].force.y, 0.5f);
  EXPECT_EQ(samples[1].force.y, 2.25f);
  EXPECT_EQ(samples[2].force.y, 4.0f);
}

TEST(Sampling, DerivativesComeFromDifferencesOfTheTrace) {
  const std::vector<SampledHand> trace = {at(0, 0, 0.125f), at(0.5, 0.03125f, 0.25f), at(0.75, 0.0625f, 0.5f)};
  const auto last = [&](Input input) { return sample(counting(input), trace)[2].force.y; };
  EXPECT_EQ(last(Input::acceleration_x), 1.0f);
  EXPECT_EQ(last(Input::raw_velocity_x), 0.125f);
  EXPECT_EQ(last(Input::raw_acceleration_x), (0.125f - 0.0625f) / 0.25f);
  EXPECT_EQ(last(Input::workspace_x), 0.0625f);
}

}  // namespace
}  // namespace wale::sampling_test
