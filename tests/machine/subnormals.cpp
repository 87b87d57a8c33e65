// Subnormal numbers from outside (hands, constants, parameters, bounds, cells, sizes) count as zeros of their signs,
// and no result is subnormal. With zeros in their place every bit is the same, in one lane by each dispatch and in
// blocks by either kernel.

#include <gtest/gtest.h>

#include <bit>
#include <cmath>

#include "runtime/machine/decoded_program.hpp"
#include "runtime/machine/floating_point_mode.hpp"
#include "tests/machine/random_program.hpp"
#include "tests/machine/running.hpp"
#include "wale/batch.hpp"
#include "wale/memory.hpp"
#include "wale/picture.hpp"

namespace wale {
namespace {

using example::loaded;

/// The bits of `value`; all not-a-numbers have the same (threaded_code.cpp says why).
std::uint32_t bits_but_of_nan(float value) {
  return std::isnan(value) ? 0x7fc00000u : std::bit_cast<std::uint32_t>(value);
}

bool is_subnormal(float value) { return std::fpclassify(value) == FP_SUBNORMAL; }

float as_zero(float value) { return is_subnormal(value) ? std::copysign(0.0f, value) : value; }

/// Puts subnormal numbers, and the normal numbers next to them, into programs and hands.
class Sprinkler {
 public:
  explicit Sprinkler(unsigned seed) : random_(seed) {}

  float tiny() {
    constexpr float all[] = {1e-45f,           -1e-45f,           1e-40f,    -1e-40f,
                             0x1.fffffcp-127f, -0x1.fffffcp-127f, 0x1p-126f, -0x1p-126f};
    return all[random_() % std::size(all)];
  }

  PatchProgram program(PatchProgram program) {
    for (std::size_t i = 5; i < program.constants.size(); ++i)
      if (random_() % 2 == 0) program.constants[i] = tiny();
    Parameter& parameter = program.parameters[random_() % 2];
    parameter.low = -std::abs(tiny());
    if (random_() % 2 == 0) parameter.value = tiny();
    if (random_() % 2 == 0) parameter.high = std::abs(tiny());
    parameter.value = std::clamp(parameter.value, parameter.low, parameter.high);
    parameter.soft_low = parameter.soft_high = parameter.value;
    State& state = program.states[random_() % program.states.size()];
    state.low = -std::abs(tiny());
    state.high = std::abs(tiny());
    if (random_() % 2 == 0) state.low = state.high;
    Grid& grid = program.grids[random_() % program.grids.size()];
    grid.initial = tiny();
    grid.low = std::min(grid.initial, random_() % 2 == 0 ? -1.0f : tiny());
    grid.high = std::max(grid.initial, tiny());
    for (State& each : program.states)
      if (random_() % 2 == 0) each.initial = constant();
    for (GridWrite& write : program.writes)
      if (random_() % 2 == 0) write.value = constant();
    return program;
  }

  std::vector<Hand> hands(std::size_t count) {
    std::uniform_real_distribution<float> place(-0.1f, 0.1f);
    std::vector<Hand> all(count);
    for (Hand& hand : all) {
      for (glm::vec2* pair : {&hand.position, &hand.velocity, &hand.acceleration, &hand.raw_velocity,
                              &hand.raw_acceleration, &hand.workspace})
        for (const int axis : {0, 1}) (*pair)[axis] = random_() % 3 == 0 ? place(random_) : tiny();
      hand.time = random_() % 2 == 0 ? 1.5 : 1e-40;
    }
    return all;
  }

 private:
  RegisterNumber constant() { return static_cast<RegisterNumber>(first_constant + 5 + random_() % 8); }

  std::mt19937 random_;
};

/// The same program with zeros in place of subnormal numbers.
PatchProgram zeroed(PatchProgram program) {
  for (float& constant : program.constants) constant = as_zero(constant);
  for (Parameter& each : program.parameters)
    for (float* figure : {&each.value, &each.low, &each.high, &each.soft_low, &each.soft_high})
      *figure = as_zero(*figure);
  for (State& each : program.states) each.low = as_zero(each.low), each.high = as_zero(each.high);
  for (Grid& each : program.grids)
    for (float* figure : {&each.initial, &each.low, &each.high}) *figure = as_zero(*figure);
  return program;
}

std::vector<Hand> zeroed(std::vector<Hand> hands) {
  for (Hand& hand : hands) {
    for (glm::vec2* pair : {&hand.position, &hand.velocity, &hand.acceleration, &hand.raw_velocity,
                            &hand.raw_acceleration, &hand.workspace})
      for (const int axis : {0, 1}) (*pair)[axis] = as_zero((*pair)[axis]);
    if (hand.time < 1e-38) hand.time = 0;
  }
  return hands;
}

/// All results of a program for some hands, as bits.
class Results {
 public:
  void add(float value) {
    EXPECT_FALSE(is_subnormal(value));
    all_.push_back(bits_but_of_nan(value));
  }
  void add(const Force& force) { add(force.x), add(force.y); }
  template <class Values>
  void add_all(const Values& values) {
    for (const auto& value : values) add(value);
  }
  friend bool operator==(const Results&, const Results&) = default;

 private:
  std::vector<std::uint32_t> all_;
};

Results tick_by_tick(const Program& program, const std::vector<float>& parameters, const std::vector<Hand>& hands) {
  Results results;
  Bank bank(program, parameters, {0.1f, 0.1f, 1e-40f});
  results.add_all(bank.registers());
  Memory memory(program);
  results.add_all(memory.states());
  memory.enter(bank, hands[0]);
  for (const Hand& hand : hands) {
    results.add(tick(bank, memory, hand));
    results.add_all(bank.registers());
    results.add_all(memory.states());
    results.add_all(memory.cells());
  }
  for (const ShownMark& mark : show(bank, memory, hands[0])) results.add_all(mark.values);
  return results;
}

Results side_by_side(const Program& program, const std::vector<float>& parameters, const std::vector<Hand>& hands) {
  Results results;
  const Bank bank(program, parameters, {0.1f, 0.1f, 1e-40f});
  std::vector<Force> forces(hands.size());
  tick_all(bank, hands, forces);
  results.add_all(forces);
  Batch batch(bank, hands.size());
  batch.enter(hands);
  for (int often = 0; often < 3; ++often) {
    batch.tick(hands, forces);
    results.add_all(forces);
    for (std::size_t state = 0; state < program.description().states.size(); ++state)
      for (std::size_t i = 0; i < hands.size(); ++i) results.add(batch.state(state, i));
  }
  std::vector<glm::vec2> places;
  for (const Hand& hand : hands) places.push_back(hand.position);
  std::vector<float> heights(hands.size());
  relief_all(bank, places, heights);
  results.add_all(heights);
  return results;
}

TEST(Subnormals, AreTheZerosOfTheirSigns) {
  for (unsigned seed = 0; seed < 200; ++seed) {
    Sprinkler sprinkler(seed);
    const PatchProgram description = sprinkler.program(example::RandomProgram(seed).make());
    ASSERT_EQ(example::refusal_of(description), "") << seed;
    const Program program = loaded(description), without = loaded(zeroed(description));
    const std::vector<Hand> hands = sprinkler.hands(6);
    const std::vector<float> parameters = {sprinkler.tiny(), sprinkler.tiny()};
    const std::vector<float> zeros = {as_zero(parameters[0]), as_zero(parameters[1])};
    ASSERT_EQ(tick_by_tick(program, parameters, hands), tick_by_tick(without, zeros, zeroed(hands))) << seed;
    ASSERT_EQ(side_by_side(program, parameters, hands), side_by_side(without, zeros, zeroed(hands))) << seed;
    if (HasFailure()) return;
  }
}

/// The tick leaves the same bits in all temporaries by every dispatch and kernel, for hands that have just entered.
TEST(Subnormals, EveryWayToRunGivesTheSameBits) {
  for (unsigned seed = 0; seed < 200; ++seed) {
    Sprinkler sprinkler(seed);
    const Program program = loaded(sprinkler.program(example::RandomProgram(seed).make()));
    const DecodedProgram& decoded = program.decoded();
    const PatchProgram& description = program.description();
    const std::vector<Hand> hands = sprinkler.hands(5);
    Bank bank(program, std::vector{sprinkler.tiny(), sprinkler.tiny()}, program.default_size());
    // The registers of the bank, with each hand's inputs and its states after entering.
    std::vector<std::vector<float>> begun;
    for (const Hand& hand : hands) {
      Memory memory(program);
      memory.enter(bank, hand);
      begun.emplace_back(bank.registers().begin(), bank.registers().end());
      decoded.hand_reader(hand, begun.back().data());
      std::copy(memory.states().begin(), memory.states().end(), begun.back().begin() + description.first_state());
    }
    std::vector<std::vector<std::uint32_t>> lanes_apart;
    for (const Dispatch dispatch : {Dispatch::wide_tail_calls, Dispatch::tail_calls, Dispatch::portable_switch}) {
      std::vector<std::uint32_t> found;
      const ThreadedCode code = decode_threaded(description.tick, dispatch);
      for (std::vector<float> registers : begun) {
        const FloatingPointMode mode;
        run_threaded(code, decoded.lookups(decoded.initial_cells.data()), registers.data());
        for (unsigned i = description.first_temporary(); i < registers.size(); ++i)
          found.push_back(bits_but_of_nan(registers[i]));
      }
      lanes_apart.push_back(found);
    }
    for (const Vectors vectors : {Vectors::baseline, Vectors::widest}) {
      Block block(description);
      const BlockCode code = decode_block(description, decoded.splines, decoded.grids, description.tick, vectors);
      const auto row_of = [&](unsigned number) {
        return block.row(block_operand(description, static_cast<RegisterNumber>(number)));
      };
      for (std::size_t lane = 0; lane < hands.size(); ++lane) {
        for (const Input input : decoded.tick_inputs)
          row_of(static_cast<unsigned>(input))[lane] = begun[lane][static_cast<std::size_t>(input)];
        for (unsigned i = description.first_state(); i < description.register_count(); ++i)
          row_of(i)[lane] = begun[lane][i];
      }
      {
        const FloatingPointMode mode;
        block.run(code, bank.registers().data(), decoded.initial_cells.data());
      }
      std::vector<std::uint32_t> found;
      for (std::size_t lane = 0; lane < hands.size(); ++lane)
        for (unsigned i = description.first_temporary(); i < description.register_count(); ++i)
          found.push_back(bits_but_of_nan(row_of(i)[lane]));
      lanes_apart.push_back(found);
    }
    for (const auto& found : lanes_apart) ASSERT_EQ(found, lanes_apart.front()) << seed;
  }
}

TEST(Subnormals, FlushedIsTheZeroOfTheSign) {
  const float least = std::numeric_limits<float>::min();
  for (const float sign : {1.0f, -1.0f}) {
    for (const float same : {0.0f, least, 2 * least, 1.0f, 3e38f, std::numeric_limits<float>::infinity()})
      EXPECT_EQ(bits_but_of_nan(arithmetic::flushed(sign * same)), bits_but_of_nan(sign * same));
    for (const float tiny : {1e-45f, 1e-40f, std::nextafter(least, 0.0f)})
      EXPECT_EQ(bits_but_of_nan(arithmetic::flushed(sign * tiny)), bits_but_of_nan(sign * 0.0f));
  }
  EXPECT_TRUE(std::isnan(arithmetic::flushed(std::nanf(""))));
}

// A patch whose half side is subnormal would have no size.
TEST(Subnormals, SidesOfAPatchAreRefused) {
  PatchProgram program = example::least();
  program.patch_width = 1e-38f;
  EXPECT_NE(example::refusal_of(program).find("patch's width"), std::string::npos);
  const Program usual = loaded(example::least());
  EXPECT_EQ(Bank(usual, {}, {1e-38f, 1e-45f, 0.0f}).size().width, usual.default_size().width);
}

// Coefficients in a long flat part decrease from sample to sample until they are subnormal. They are the same in any
// floating-point mode of the thread that makes the spline.
TEST(Subnormals, SplinesAreTheSameInAnyMode) {
  HeightTable table{400, 3, std::vector<std::uint16_t>(1200)};
  table.heights[0] = table.heights[401] = 65535;
  const Spline ordinary(table);
  const Spline flushing = [&] {
    const FloatingPointMode mode;
    return Spline(table);
  }();
  int zeros = 0;
  for (std::size_t i = 0; i < ordinary.coefficients.size(); ++i) {
    ASSERT_EQ(bits_but_of_nan(ordinary.coefficients[i]), bits_but_of_nan(flushing.coefficients[i])) << i;
    ASSERT_FALSE(is_subnormal(ordinary.coefficients[i])) << i;
    zeros += ordinary.coefficients[i] == 0;
  }
  EXPECT_GT(zeros, 100);
}

}  // namespace
}  // namespace wale
