// Random materials with states: the machine with its memory against the reference evaluator, tick by tick.

#include <gtest/gtest.h>

#include <algorithm>

#include "compiler/parse/parse.hpp"
#include "tests/compiler/compiling.hpp"
#include "tests/compiler/random_material.hpp"
#include "tests/reference/evaluator.hpp"
#include "wale/memory.hpp"

namespace wale::compiling::random_states_test {
namespace {

constexpr std::uint32_t materials = 600;
constexpr int ticks_each = 25;
constexpr double dt = 1.0 / 900;

double uniform(std::mt19937& random) { return random() / 2147483648.0 - 1; }

reference::HandState as_reference(const Hand& hand) {
  return {.x = hand.position.x,
          .y = hand.position.y,
          .vx = hand.velocity.x,
          .vy = hand.velocity.y,
          .ax = hand.acceleration.x,
          .ay = hand.acceleration.y,
          .time = hand.time,
          .button = hand.button};
}

/// A random hand, independent of the hand of the tick before.
Hand next_hand(std::mt19937& random, int tick) {
  const auto in = [&](double size) { return static_cast<float>(size * uniform(random)); };
  Hand hand;
  hand.position = {in(0.07), in(0.07)};
  hand.velocity = {in(0.5), in(0.5)};
  hand.acceleration = {in(8), in(8)};
  hand.time = 3 + tick * dt;
  hand.button = in(1) > 0;
  return hand;
}

/// The ticks that a run compared, whether a state changed, and whether one reached a bound.
struct Outcome {
  int ticks = 0;
  bool moved = false, at_bound = false;
};

/// Runs both until the reference is undecided or its error bound is above 0.01 N.
void run(const std::string& text, std::uint32_t seed, Outcome& outcome) {
  SourceSet sources;
  Diagnostics diagnostics;
  const SyntaxTree tree = parse(sources, sources.add("test.wale", text), diagnostics);
  const Program program = Compiled(text).only();
  Bank bank(program);
  Memory memory(program);
  // The machine's parameters are floats, so the reference takes the same floats.
  std::map<std::string, double> values;
  for (const auto& parameter : program.description().parameters) values[parameter.name] = parameter.value;
  reference::Simulation simulation(tree, values);

  std::mt19937 random(seed);
  try {
    const Hand first = next_hand(random, 0);
    simulation.enter(as_reference(first));
    memory.enter(bank, first);
    const std::vector<float> initial(memory.states().begin(), memory.states().end());
    for (int i = 0; i < ticks_each; ++i) {
      const Hand hand = i == 0 ? first : next_hand(random, i);
      const auto expected = simulation.tick(as_reference(hand));
      if (std::max(expected.error[0], expected.error[1]) > 0.01) return;
      const Force force = tick(bank, memory, hand);
      for (int axis = 0; axis < 2; ++axis)
        ASSERT_NEAR(force[axis], expected.value[axis], expected.error[axis] + 1e-12)
            << "seed " << seed << ", axis " << axis << ", tick " << i << "\n"
            << text;
      // States in the order of declaration; a vector is two states in a row.
      std::size_t index = 0;
      const auto& declared = program.description().states;
      for (const auto& [name, state] : simulation.states()) {
        const int parts = state.type == reference::Quantity::Type::vector ? 2 : 1;
        for (int part = 0; part < parts; ++part, ++index) {
          ASSERT_LT(index, declared.size());
          const float value = memory.states()[index];
          ASSERT_NEAR(value, state.value[part], state.error[part] + 1e-12)
              << "seed " << seed << ", " << name << ", part " << part << ", after tick " << i << "\n"
              << text;
          outcome.moved = outcome.moved || value != initial[index];
          outcome.at_bound = outcome.at_bound || value == declared[index].low || value == declared[index].high;
        }
      }
      ++outcome.ticks;
    }
  } catch (const reference::Undecided&) {
  }
}

TEST(RandomStates, MachineAndReferenceAgreeTickByTick) {
  int ticks = 0, whole = 0, moved = 0, at_bound = 0;
  for (std::uint32_t seed = 0; seed < materials; ++seed) {
    RandomMaterial material(seed);
    material.write_with_states();
    Outcome outcome;
    run(material.text(false), seed, outcome);
    if (HasFatalFailure()) return;
    ticks += outcome.ticks;
    whole += outcome.ticks == ticks_each ? 1 : 0;
    moved += outcome.moved ? 1 : 0;
    at_bound += outcome.at_bound ? 1 : 0;
  }
  RecordProperty("ticks", std::to_string(ticks));
  RecordProperty("whole", std::to_string(whole));
  RecordProperty("moved", std::to_string(moved));
  RecordProperty("at_bound", std::to_string(at_bound));
  // Most runs reach a comparison that 32 bits cannot decide, but enough continue to the end.
  EXPECT_GT(ticks, static_cast<int>(materials) * ticks_each / 4);
  EXPECT_GT(whole, static_cast<int>(materials) / 8);
  EXPECT_GT(moved, static_cast<int>(materials) / 4);
  EXPECT_GT(at_bound, static_cast<int>(materials) / 8);
}

TEST(RandomStates, ParametersThatAreConstantsChangeNoBit) {
  for (std::uint32_t seed = 0; seed < 200; ++seed) {
    RandomMaterial material(seed);
    material.write_with_states();
    const Program adjustable = Compiled(material.text(false)).only(), fixed = Compiled(material.text(true)).only();
    Bank one(adjustable), other(fixed);
    Memory first(adjustable), second(fixed);
    std::mt19937 random(seed);
    Hand hand = next_hand(random, 0);
    first.enter(one, hand);
    second.enter(other, hand);
    for (int i = 1; i <= 10; ++i) {
      const Force p = tick(one, first, hand), q = tick(other, second, hand);
      ASSERT_EQ(p.x, q.x) << material.text(false);
      ASSERT_EQ(p.y, q.y) << material.text(false);
      ASSERT_TRUE(std::ranges::equal(first.states(), second.states())) << material.text(false);
      hand = next_hand(random, i);
    }
  }
}

}  // namespace
}  // namespace wale::compiling::random_states_test
