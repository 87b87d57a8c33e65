// The picture of a program: its surface with the effect of its memory, its colours and its marks.

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "tests/machine/running.hpp"
#include "tests/runtime/programs.hpp"
#include "wale/picture.hpp"

namespace wale::pictures_test {
namespace {

constexpr float nan = std::numeric_limits<float>::quiet_NaN();

/// A program with a state that counts ticks and begins at x + 5. Its relief is x + state + the cell at (0, 0), which
/// each tick sets to its count. Its colour is (10 x, state, not a number). Its marks hold the hand's place, velocity,
/// time and button, the state and the cell.
Program counter() {
  Assembly a({9, 0, 1, 5, 10, nan});
  const RegisterNumber count = a.state("count", 0, 100);
  a.program.grids = {{"last", 1, 1, 0.5f, 0, 100}};
  const RegisterNumber next = a.tick(Operation::add, count, a.constant(2));
  a.evolve(count, a.enter(Operation::add, a.input(Input::x), a.constant(3)), next);
  a.program.writes = {{0, a.constant(1), a.constant(1), next}};
  a.push(0, a.constant(1), a.constant(0));
  a.push(1, a.constant(1), a.constant(0));
  Picture& picture = a.program.picture;
  const RegisterNumber cell = a(picture.code, Operation::cell, a.constant(1), a.constant(1), 0);
  picture.relief = a(picture.code, Operation::add, a(picture.code, Operation::add, a.input(Input::x), count), cell);
  picture.colour =
      std::array{a(picture.code, Operation::multiply, a.input(Input::x), a.constant(4)), count, a.constant(5)};
  const RegisterNumber last = a(picture.frame, Operation::cell, a.constant(1), a.constant(1), 0);
  picture.marks = {{MarkKind::point, {a.input(Input::x), a.input(Input::y), count}, 0xff0000},
                   {MarkKind::box,
                    {a.input(Input::velocity_x), last, a.input(Input::time), a.input(Input::button), a.constant(5)},
                    0x0000ff}};
  return a.load();
}

TEST(Pictures, SurfaceIsThatOfTheMemory) {
  const Program program = counter();
  Bank bank(program);
  Memory memory(program);
  memory.enter(bank, {.position = {0.0625f, 0}});
  for (int i = 0; i < 3; ++i) tick(bank, memory, {});
  std::vector<glm::vec2> places;
  for (int i = 0; i < 200; ++i) places.push_back({static_cast<float>(i) * 1e-3f, 0});
  std::vector<float> heights(places.size());
  std::vector<glm::vec3> colours(places.size());
  surface_all(bank, &memory, places, heights, colours);
  for (std::size_t i = 0; i < places.size(); ++i) {
    const double x = places[i].x;
    ASSERT_NEAR(heights[i], x + 2 * 8.0625, 2e-6) << "three ticks after it began at 5.0625";
    ASSERT_NEAR(colours[i].r, std::min(1.0, 10 * x), 1e-6);
    ASSERT_EQ(colours[i].g, 1.0f);
    ASSERT_EQ(colours[i].b, 0.0f) << "not a number";
  }
}

TEST(Pictures, WithoutAMemoryTheHandHasEnteredAtTheCentre) {
  const Bank bank(counter());
  const glm::vec2 place(0.03125f, 0.01f);
  float height = 0, relief = 0;
  surface_all(bank, nullptr, {&place, 1}, {&height, 1});
  EXPECT_EQ(height, 0.03125f + 5 + 0.5f);
  relief_all(bank, {&place, 1}, {&relief, 1});
  EXPECT_EQ(relief, height);
  const Memory others(bead(1000));
  surface_all(bank, &others, {&place, 1}, {&relief, 1});
  EXPECT_EQ(relief, height) << "a memory of another program counts for none";
}

TEST(Pictures, AProgramWithoutColourLeavesTheColoursAlone) {
  const Bank bank(bead(1000));
  const glm::vec2 place(0);
  float height = 0;
  glm::vec3 colour(0.25f);
  surface_all(bank, nullptr, {&place, 1}, {&height, 1}, {&colour, 1});
  EXPECT_EQ(colour, glm::vec3(0.25f));
}

TEST(Pictures, MarksHoldTheValuesOfTheFrame) {
  const Program program = counter();
  Bank bank(program);
  Memory memory(program);
  memory.enter(bank, {});
  tick(bank, memory, {});
  const auto marks =
      show(bank, memory, {.position = {0.125f, -0.0625f}, .velocity = {0.5f, 0}, .time = 12, .button = true});
  ASSERT_EQ(marks.size(), 2u);
  EXPECT_EQ(marks[0], (ShownMark{MarkKind::point, {0.125f, -0.0625f, 6, 0, 0}, 0xff0000}));
  EXPECT_EQ(marks[1].kind, MarkKind::box);
  EXPECT_EQ(marks[1].values[0], 0.5f);
  EXPECT_EQ(marks[1].values[1], 6);
  EXPECT_EQ(marks[1].values[2], 12);
  EXPECT_EQ(marks[1].values[3], 1);
  EXPECT_TRUE(std::isnan(marks[1].values[4]));
  EXPECT_EQ(memory.states()[0], 6) << "showing changes nothing";
}

}  // namespace
}  // namespace wale::pictures_test
