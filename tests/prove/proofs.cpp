// Proved ranges hold for every register of every run, for random programs and hands with ordinary and extreme values.

#include <gtest/gtest.h>

#include "compiler/prove/prove.hpp"
#include "runtime/machine/inputs.hpp"
#include "tests/machine/running.hpp"
#include "tests/prove/programs.hpp"
#include "tests/prove/stepping.hpp"
#include "tests/prove/values.hpp"
#include "wale/memory.hpp"

namespace wale::proofs_test {
namespace {

using example::instruction;
using example::loaded;
using prove_test::pushing;
using prove_test::random_program;
using prove_test::Values;

/// A random part of a domain.
Domain part_of(const Domain& whole, Values& values) {
  Domain part = whole;
  for (Interval& input : part.inputs) input = values.within(input);
  for (Interval& parameter : part.parameters) parameter = values.within(parameter);
  for (Interval& state : part.states) state = values.within(state);
  return part;
}

/// Registers and cells at random within a domain.
stepping::State within(const Domain& domain, const Program& program, Values& values) {
  const PatchProgram& description = program.description();
  stepping::State state{program.decoded(), std::vector<float>(description.register_count()), {}};
  for (std::size_t i = 0; i < first_constant; ++i) state.registers[i] = values.of(domain.inputs[i]);
  std::copy(description.constants.begin(), description.constants.end(), state.registers.begin() + first_constant);
  for (std::size_t i = 0; i < domain.parameters.size(); ++i) {
    state.registers[description.first_parameter() + i] = values.of(domain.parameters[i]);
  }
  for (std::size_t i = 0; i < domain.states.size(); ++i) {
    state.registers[description.first_state() + i] = values.of(domain.states[i]);
  }
  for (const Grid& grid : description.grids) {
    for (std::size_t i = 0; i < std::size_t{grid.columns} * grid.rows; ++i) {
      state.cells.push_back(values.of(Interval::between(grid.low, grid.high)));
    }
  }
  return state;
}

TEST(Proofs, EveryRegisterKeepsToItsRange) {
  Values values(3);
  long informative = 0, all = 0;
  for (unsigned seed = 0; seed < 250; ++seed) {
    const Program program = loaded(random_program(seed));
    const Domain whole = whole_domain(program.description());
    for (int round = 0; round < 6; ++round) {
      const Domain domain = round == 0 ? whole : part_of(whole, values);
      const Proof proof = prove(program, domain);
      for (const ResultRanges& ranges : proof.tick) informative += ranges[0].is_finite(), ++all;
      for (int run = 0; run < 12; ++run) {
        stepping::State state = within(domain, program, values);
        const auto complaint = stepping::run_all(state, proof);
        ASSERT_FALSE(complaint) << "seed " << seed << ", round " << round << ": " << *complaint;
      }
    }
  }
  EXPECT_GT(informative, all / 3) << "too few of the ranges are finite";
}

// The stepping machine of the test gives the same force as the machine, bit for bit, from the same states and cells.
TEST(Proofs, TheSteppedMachineIsTheMachine) {
  for (unsigned seed = 0; seed < 60; ++seed) {
    const Program program = loaded(random_program(seed));
    const PatchProgram& description = program.description();
    Bank bank(program);
    const Proof proof = prove(program);
    Memory memory(program);
    Values values(seed);
    for (int i = 0; i < 30; ++i) {
      Hand hand;
      for (glm::vec2* pair : {&hand.position, &hand.velocity, &hand.raw_velocity, &hand.workspace}) {
        *pair = {values.of(Interval::everything(true)), 0.05f * values.of(Interval::between(-1, 1))};
      }
      hand.time = 0.01 * i;
      if (i % 10 == 0) memory.enter(bank, hand);
      stepping::State state{program.decoded(),
                            {bank.registers().begin(), bank.registers().end()},
                            {memory.cells().begin(), memory.cells().end()}};
      HandReader(program.decoded().tick_inputs, program.decoded().envelope)(hand, state.registers.data());
      std::copy(memory.states().begin(), memory.states().end(), state.registers.begin() + description.first_state());
      const auto complaint = stepping::run(state, description.tick, "tick", proof.tick);
      ASSERT_FALSE(complaint) << "seed " << seed << ": " << *complaint;
      const Force force = tick(bank, memory, hand);
      for (const Output& output : description.outputs) {
        ASSERT_EQ(std::bit_cast<std::uint32_t>(force[output.component()]),
                  std::bit_cast<std::uint32_t>(state.registers[output.value]));
      }
    }
  }
}

using enum Operation;

TEST(Proofs, ASpringPushesWithItsStiffnessTimesTheWorkspace) {
  const Program spring =
      loaded(pushing({-30.0f}, {}, [](unsigned t) { return std::vector{instruction(multiply, t, 0, 34)}; }));
  const Proof proof = prove(spring);
  const float reach = 0.2286f;
  EXPECT_EQ(proof.force[0], Interval::between(-30.0f * reach, 30.0f * reach));
  EXPECT_EQ(proof.force[1], Interval{});
  EXPECT_NEAR(proof.bound_newton, 30 * 0.2286, 1e-5);
  EXPECT_FALSE(proof.limit_matters(0));
}

TEST(Proofs, AStifferSpringPushesWithItsLimit) {
  const Program spring =
      loaded(pushing({-300.0f}, {}, [](unsigned t) { return std::vector{instruction(multiply, t, 0, 34)}; }));
  const Proof proof = prove(spring);
  EXPECT_EQ(proof.bound_newton, 10 * (1 + 0x1p-50));
  EXPECT_TRUE(proof.limit_matters(0));
  EXPECT_FALSE(proof.limit_matters(1));
}

TEST(Proofs, AGratingPushesWithItsAmplitudeInItsRange) {
  const Parameter amplitude{"amplitude", "N", 1, 1.0f, 0.5f, 2.5f, 0.5f, 2.5f, ""};
  const Program grating = loaded(pushing({2513.27f}, {amplitude}, [](unsigned t) {
    return std::vector{instruction(multiply, t, 0, 34), instruction(sine, t + 1, t),
                       instruction(multiply, t, t + 1, 35)};
  }));
  EXPECT_EQ(prove(grating).force[0], Interval::between(-2.5f, 2.5f));
  const Domain usual = domain_at_defaults(grating.description());
  EXPECT_EQ(prove(grating, usual).force[0], Interval::between(-1, 1));
}

// (x - 0.1)(x + 0.1) on +-0.2286 is least at 0, where it is -0.01. Both factors depend on the same x, and the proof
// knows it.
TEST(Proofs, DependenceBetweenRegistersTightensTheBound) {
  const Program program = loaded(pushing({0.1f, 100.0f}, {}, [](unsigned t) {
    return std::vector{instruction(subtract, t, 0, 34), instruction(add, t + 1, 0, 34),
                       instruction(multiply, t + 2, t, t + 1), instruction(multiply, t, t + 2, 35)};
  }));
  const double interval_alone = 100 * 0.3286 * 0.3286;
  EXPECT_LT(prove(program).bound_newton, 0.7 * interval_alone);
}

}  // namespace
}  // namespace wale::proofs_test
