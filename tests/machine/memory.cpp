// Programs with states and grids, written by hand, against recurrences in double and closed forms.

#include "wale/memory.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>

#include "tests/machine/running.hpp"
#include "tests/runtime/programs.hpp"

namespace wale::memory_test {
namespace {

constexpr float nan = std::numeric_limits<float>::quiet_NaN();
constexpr float inf = std::numeric_limits<float>::infinity();

/// A program with one state, which is its force along x. `load` takes the registers of its initial and next value.
struct OneState {
  OneState(float low, float high, std::vector<float> constants = {})
      : assembly([&] {
          constants.insert(constants.begin(), {9, 0});
          return constants;
        }()),
        state(assembly.state("state", low, high)) {}

  RegisterNumber constant(unsigned i) const { return assembly.constant(2 + i); }
  Program load(RegisterNumber initial, RegisterNumber next) {
    assembly.evolve(state, initial, next);
    assembly.push(0, state, assembly.constant(0));
    assembly.push(1, assembly.constant(1), assembly.constant(0));
    return assembly.load();
  }

  Assembly assembly;
  RegisterNumber state;
};

Hand at(float x, float y = 0) { return {.position = {x, y}}; }

TEST(Memory, ABeadOnASpringFollowsSemiImplicitEuler) {
  const float stiffness = 3000;
  const Program program = bead(stiffness);
  Bank bank(program);
  Memory memory(program);
  double place = 0.01f, speed = 0;
  const double dt = static_cast<float>(1 / 900.0);
  memory.enter(bank, at(0.01f));
  for (int i = 0; i < 3000; ++i) {
    const auto x = static_cast<float>(0.02 * std::sin(0.01 * i));
    const Force force = tick(bank, memory, at(x));
    const double pull = stiffness * (x - place);
    ASSERT_NEAR(force.x, std::clamp(-pull, -9.0, 9.0), 3e-2) << i;
    speed += pull * dt;
    place += speed * dt;
    ASSERT_NEAR(memory.states()[0], place, 1e-5) << i;
    ASSERT_NEAR(memory.states()[1], speed, 6e-4) << i;
  }
}

// With the hand at rest at 0 the recurrence p(n+1) - 2 p(n) + p(n-1) = -(w dt)^2 p(n) has the solution
// p(n) = P (cos n q + b sin n q), where cos q = 1 - (w dt)^2 / 2 and b follows from p(1) = P (1 - (w dt)^2).
TEST(Memory, AReleasedBeadOscillatesAsTheClosedFormSays) {
  const float stiffness = 3000, start = 0.008f;
  const Program program = bead(stiffness);
  Bank bank(program);
  Memory memory(program);
  memory.enter(bank, at(start));
  const double step = stiffness / (900.0 * 900.0), angle = std::acos(1 - step / 2);
  const double b = (1 - step - std::cos(angle)) / std::sin(angle);
  for (int n = 0; n < 2000; ++n) {
    const double place = start * (std::cos(n * angle) + b * std::sin(n * angle));
    ASSERT_NEAR(memory.states()[0], place, 1e-5) << n;
    tick(bank, memory, at(0));
  }
}

TEST(Memory, AChangedParameterKeepsTheStates) {
  const Program program = bead(3000);
  Memory memory(program);
  double place = 0.01f, speed = 0;
  const double dt = 1 / 900.0;
  for (int i = 0; i < 900; ++i) {
    const float stiffness = 1000.0f + static_cast<float>(i / 100) * 500;
    Bank bank(program, std::vector<float>{stiffness}, program.default_size());
    if (i == 0) memory.enter(bank, at(0.01f));
    tick(bank, memory, at(-0.01f));
    speed += stiffness * (-0.01 - place) * dt;
    place += speed * dt;
    ASSERT_NEAR(memory.states()[0], place, 1e-5) << i;
  }
}

TEST(Memory, StatesReadAsTheyWereWhenTheTickBegan) {
  // Two states that exchange their values each tick.
  Assembly a({9});
  const RegisterNumber one = a.state("one", -9, 9), two = a.state("two", -9, 9);
  a.evolve(one, a.input(Input::x), two);
  a.evolve(two, a.input(Input::y), one);
  a.push(0, one, a.constant(0));
  a.push(1, two, a.constant(0));
  const Program program = a.load();
  Bank bank(program);
  Memory memory(program);
  memory.enter(bank, at(0.125f, 0.0625f));
  EXPECT_EQ(tick(bank, memory, at(0)), Force(0.125f, 0.0625f));
  EXPECT_EQ(tick(bank, memory, at(0)), Force(0.0625f, 0.125f));
  EXPECT_EQ(tick(bank, memory, at(0)), Force(0.125f, 0.0625f));
}

TEST(Memory, StatesAreHeldInTheirRange) {
  OneState one(-0.5f, 2, {0.75f});
  const Program program =
      one.load(one.assembly.constant(1), one.assembly.tick(Operation::add, one.state, one.assembly.input(Input::x)));
  Bank bank(program);
  Memory memory(program);
  memory.enter(bank, at(0));
  for (int i = 1; i <= 30; ++i) {
    tick(bank, memory, at(0.1f));
    EXPECT_FLOAT_EQ(memory.states()[0], std::min(0.1f * static_cast<float>(i), 2.0f));
  }
  for (int i = 0; i < 30; ++i) tick(bank, memory, at(-0.1f));
  EXPECT_EQ(memory.states()[0], -0.5f);
  EXPECT_EQ(memory.restored(), 0);
}

TEST(Memory, InitialValuesAreHeldInTheirRange) {
  const auto begins = [](float low, float high, float initial) {
    OneState one(low, high, {initial});
    const Program program = one.load(one.constant(0), one.state);
    Bank bank(program);
    Memory memory(program);
    memory.enter(bank, at(0));
    return memory.states()[0];
  };
  EXPECT_EQ(begins(-1, 2, 1.5f), 1.5f);
  EXPECT_EQ(begins(-1, 2, inf), 2);
  EXPECT_EQ(begins(-1, 2, -7), -1);
  EXPECT_EQ(begins(-1, 2, nan), 0) << "the nearest to 0";
  EXPECT_EQ(begins(1, 2, nan), 1);
  EXPECT_EQ(begins(-2, -1, nan), -1);
}

TEST(Memory, AStateThatIsNotANumberBeginsAgain) {
  // The next state is sqrt(state - x), which is not a number where x is larger.
  OneState one(0, 9);
  const RegisterNumber rest = one.assembly.tick(Operation::subtract, one.state, one.assembly.input(Input::x));
  const Program program = one.load(one.assembly.input(Input::y), one.assembly.tick(Operation::square_root, rest));
  Bank bank(program);
  Memory memory(program);
  memory.enter(bank, at(0, 0.0625f));
  tick(bank, memory, at(0));
  EXPECT_EQ(memory.states()[0], 0.25f);
  EXPECT_EQ(memory.restored(), 0);
  tick(bank, memory, at(0.2f, 0.03f));
  EXPECT_FLOAT_EQ(memory.states()[0], std::sqrt(0.05f)) << "enter would give 0.03 now";
  tick(bank, memory, at(0.2285f));
  EXPECT_EQ(memory.states()[0], 0.0625f) << "the initial value of the last entry";
  EXPECT_EQ(memory.restored(), 1);
  tick(bank, memory, at(0.0625f));
  EXPECT_EQ(memory.states()[0], 0.0f);
}

TEST(Memory, WithoutAMemoryEachTickIsTheFirst) {
  const Program program = bead(3000);
  Bank bank(program);
  for (int i = 0; i < 3; ++i) EXPECT_EQ(tick(bank, at(0.01f)).x, 0.0f) << "the bead hangs where the hand is";
}

TEST(Memory, OfAnotherProgramIsLeftAlone) {
  const Program program = bead(3000), other = bead(3000);
  Bank bank(program), others(other);
  Memory memory(program);
  memory.enter(bank, at(0.01f));
  memory.enter(others, at(0.02f));
  EXPECT_EQ(tick(others, memory, at(0)), tick(others, at(0)));
  EXPECT_EQ(memory.states()[0], 0.01f);
}

TEST(Memory, BeforeTheFirstEntryIsDefined) {
  OneState one(1, 2);
  const Program program = one.load(one.assembly.constant(0), one.state);
  Bank bank(program);
  Memory memory(program);
  EXPECT_EQ(tick(bank, memory, at(0)).x, 1);
}

/// A program that writes the hand's velocity along x into a grid of 4 x 3 cells at (1000 x, 1000 y). Its force is the
/// recalled value there along x and the nearest cell along y, both as they were before the tick.
Program ground(float low = -1, float high = 1) {
  Assembly a({9, 1000, 2});
  a.program.grids = {{"ground", 4, 3, 0.25f, low, high}};
  const RegisterNumber u = a.tick(Operation::multiply, a.input(Input::x), a.constant(1));
  const RegisterNumber v = a.tick(Operation::multiply, a.input(Input::y), a.constant(1));
  const RegisterNumber recalled = a.tick(Operation::recall, u, v, 0);
  const RegisterNumber nearest = a.tick(Operation::cell, u, v, 0);
  a.program.writes = {{0, u, v, a.input(Input::velocity_x)}};
  a.push(0, recalled, a.constant(0));
  a.push(1, nearest, a.constant(0));
  return a.load();
}

TEST(Memory, AGridKeepsWhatAMovingHandWritesIntoIt) {
  const Program program = ground();
  Bank bank(program);
  Memory memory(program);
  memory.enter(bank, at(0));
  EXPECT_EQ(std::vector<float>(memory.grid(0).begin(), memory.grid(0).end()), std::vector<float>(12, 0.25f));
  const auto write = [&](float x, float y, float value) {
    return tick(bank, memory, {.position = {x * 1e-3f, y * 1e-3f}, .velocity = {value, 0}});
  };
  for (int j = 0; j < 3; ++j) {
    for (int i = 0; i < 4; ++i) {
      const auto x = static_cast<float>(i), y = static_cast<float>(j);
      EXPECT_FLOAT_EQ(write(x, y, 0.1f * x - 0.2f * y).y, 0.25f) << "the value before the write is read";
    }
  }
  memory.enter(bank, at(0));  // grids keep their cells
  for (int j = 0; j < 3; ++j) {
    for (int i = 0; i < 4; ++i) {
      const auto x = static_cast<float>(i), y = static_cast<float>(j);
      EXPECT_FLOAT_EQ(memory.grid(0)[j * 4 + i], 0.1f * x - 0.2f * y);
      const Force read = write(x, y, 0.1f * x - 0.2f * y);
      EXPECT_NEAR(read.x, 0.1f * x - 0.2f * y, 1e-4);
      EXPECT_FLOAT_EQ(read.y, 0.1f * x - 0.2f * y);
    }
  }
  EXPECT_NEAR(tick(bank, at(0.0015f, 0.0005f)).x, 0.25, 1e-6) << "without a memory, cells have their initial value";
}

TEST(Memory, AWriteGoesToTheNearestCellAndIsHeldInTheRange) {
  const Program program = ground(-0.5f, 0.75f);
  Bank bank(program);
  Memory memory(program);
  const auto write = [&](float x, float y, float value) {
    tick(bank, memory, {.position = {x * 1e-3f, y * 1e-3f}, .velocity = {value, 0}});
    return memory.grid(0);
  };
  EXPECT_EQ(write(1.4f, 0.6f, 0.5f)[4 + 1], 0.5f);
  EXPECT_EQ(write(100, 1.6f, 0.625f)[2 * 4 + 3], 0.625f) << "beyond the edge: the nearest one";
  EXPECT_EQ(write(-100, -100, 0.625f)[0], 0.625f);
  EXPECT_EQ(write(0, 0, 0.9f)[0], 0.75f);
  EXPECT_EQ(write(0, 0, -0.9f)[0], -0.5f);
}

TEST(Memory, NotANumberWritesNothing) {
  for (const int broken : {0, 1, 2, 3}) {
    Assembly a({9, nan, 0.5f, 0});
    a.program.grids = {{"ground", 2, 2, 0, -1, 1}};
    GridWrite write{0, a.constant(3), a.constant(3), a.constant(2)};
    if (broken == 0) write.u = a.constant(1);
    if (broken == 1) write.v = a.constant(1);
    if (broken == 2) write.value = a.constant(1);
    a.program.writes = {write};
    a.push(0, a.constant(3), a.constant(0));
    a.push(1, a.constant(3), a.constant(0));
    const Program program = a.load();
    Bank bank(program);
    Memory memory(program);
    tick(bank, memory, at(0));
    EXPECT_EQ(memory.grid(0)[0], broken == 3 ? 0.5f : 0.0f) << broken;
  }
}

TEST(Memory, WritesHappenInOrderWithValuesFromBeforeTheTick) {
  Assembly a({9, 0, 1, 0.5f, 0.25f});
  a.program.grids = {{"one", 2, 1, 0, -9, 9}, {"two", 1, 2, 3, -9, 9}};
  const RegisterNumber first = a.tick(Operation::cell, a.constant(1), a.constant(1), 0);
  const RegisterNumber second = a.tick(Operation::cell, a.constant(1), a.constant(1), 1);
  a.program.writes = {{0, a.constant(1), a.constant(1), a.constant(3)},
                      {1, a.constant(1), a.constant(1), first},
                      {0, a.constant(1), a.constant(1), second},
                      {1, a.constant(1), a.constant(2), a.constant(4)}};
  a.push(0, first, a.constant(0));
  a.push(1, second, a.constant(0));
  const Program program = a.load();
  Bank bank(program);
  Memory memory(program);
  EXPECT_EQ(tick(bank, memory, at(0)), Force(0, 3));
  EXPECT_EQ(std::vector<float>(memory.cells().begin(), memory.cells().end()), (std::vector<float>{3, 0, 0, 0.25f}));
  EXPECT_EQ(tick(bank, memory, at(0)), Force(3, 0)) << "they exchanged their values: the last write counts";
}

}  // namespace
}  // namespace wale::memory_test
