// Threaded code, by either dispatch, against the plain switch over canonical instructions: every register, bit for bit.
// All not-a-numbers count as equal: compilers may swap the operands of a sum, and the sum of two not-a-numbers has the
// bits of the first.

#include "runtime/machine/threaded_code.hpp"

#include <gtest/gtest.h>
#include <pthread.h>

#include <bit>
#include <cmath>
#include <cstdint>

#include "runtime/machine/floating_point_mode.hpp"
#include "runtime/machine/lane.hpp"
#include "tests/machine/random_program.hpp"
#include "tests/machine/running.hpp"

namespace wale::threaded_code_test {
namespace {

using example::instruction;
using example::loaded;

constexpr Dispatch dispatches[] = {Dispatch::wide_tail_calls, Dispatch::tail_calls, Dispatch::portable_switch};

std::vector<std::uint32_t> bits(const std::vector<float>& registers) {
  std::vector<std::uint32_t> all;
  for (const float value : registers) {
    all.push_back(std::isnan(value) ? 0x7fc00000u : std::bit_cast<std::uint32_t>(value));
  }
  return all;
}

std::vector<float> plain(const DecodedProgram& program, std::span<const Instruction> code,
                         std::vector<float> registers) {
  const FloatingPointMode mode;
  run_lane(program, code, registers.data(), program.initial_cells.data());
  return registers;
}

std::vector<float> threaded(const DecodedProgram& program, std::span<const Instruction> code, Dispatch dispatch,
                            std::vector<float> registers) {
  const FloatingPointMode mode;
  run_threaded(decode_threaded(code, dispatch), program.lookups(program.initial_cells.data()), registers.data());
  return registers;
}

/// Registers of any kind of float; constants and parameters as the program has them.
std::vector<float> anything(const Program& program, example::RandomProgram& generator) {
  const Bank bank(program);
  std::vector<float> registers(bank.registers().begin(), bank.registers().end());
  constexpr float extremes[] = {
      0.0f, -0.0f, 1e-20f, -1.2e-38f, 3e38f, -3e38f, __builtin_inff(), -__builtin_inff(), __builtin_nanf("")};
  for (std::size_t i = 0; i < registers.size(); ++i) {
    if (i >= first_constant && i < program.description().first_state()) continue;
    registers[i] =
        generator.random()() % 6 == 0 ? extremes[generator.random()() % std::size(extremes)] : generator.number();
  }
  return registers;
}

TEST(ThreadedCode, GivesTheBitsOfPlainInstructions) {
  for (unsigned seed = 0; seed < 300; ++seed) {
    example::RandomProgram generator(seed);
    const Program program = loaded(generator.make());
    const PatchProgram& description = program.description();
    for (const auto* code : {&description.enter, &description.tick, &description.picture.frame}) {
      for (int often = 0; often < 5; ++often) {
        const std::vector<float> registers = anything(program, generator);
        const auto expected = bits(plain(program.decoded(), *code, registers));
        for (const Dispatch dispatch : dispatches)
          ASSERT_EQ(bits(threaded(program.decoded(), *code, dispatch, registers)), expected) << seed;
      }
    }
  }
}

// Every operation takes its predecessor's result at every operand, which random code seldom does.
TEST(ThreadedCode, ForwardsTheLastResultToAnyOperand) {
  example::RandomProgram generator(1);
  const Program program = loaded(generator.make());
  const unsigned temporary = program.description().first_temporary(), other = first_constant + 10, x = 0;
  int cases = 0;
  for (unsigned number = 1; number < operation_table.size(); ++number) {
    const OperationFacts* known = operation_facts(number);
    if (known == nullptr || known->fields[0] == 'p') continue;
    for (unsigned which = 0; which < 8; ++which) {
      const auto operand = [&](unsigned i) -> unsigned {
        if (known->fields[i] != 'r') return 0;
        return (which >> i & 1) != 0 ? temporary : other + i;
      };
      // A result of one register, and the first of three.
      for (const Instruction& first :
           {instruction(Operation::sine, temporary, x, 0, 0), instruction(Operation::sample, temporary, x, 1, 0)}) {
        const std::vector<Instruction> code = {
            first, instruction(static_cast<Operation>(number), temporary + 4, operand(0), operand(1), operand(2)),
            instruction(Operation::add, temporary + 8, temporary + 4, temporary)};
        const std::vector<float> registers = anything(program, generator);
        const auto expected = bits(plain(program.decoded(), code, registers));
        for (const Dispatch dispatch : dispatches)
          ASSERT_EQ(bits(threaded(program.decoded(), code, dispatch, registers)), expected) << known->name << which;
        ++cases;
      }
    }
  }
  EXPECT_GT(cases, 300);
}

// Only the first result of a look-up counts as the last result, and a table's number is not a register.
TEST(ThreadedCode, ForwardsNothingElse) {
  example::RandomProgram generator(2);
  const Program program = loaded(generator.make());
  const unsigned temporary = program.description().first_temporary();
  for (const Operation look_up : {Operation::sample, Operation::recall}) {
    const std::vector<Instruction> code = {
        instruction(look_up, temporary, 0, 1, 0),
        instruction(Operation::subtract, temporary + 4, temporary + 1, temporary + 2),
        instruction(Operation::negate, 0, temporary + 4), instruction(look_up, temporary + 5, 2, 3, 0)};
    const std::vector<float> registers = anything(program, generator);
    const auto expected = bits(plain(program.decoded(), code, registers));
    for (const Dispatch dispatch : dispatches)
      ASSERT_EQ(bits(threaded(program.decoded(), code, dispatch, registers)), expected);
  }
}

// Handlers that jump to one another use no stack: a million instructions run with a stack of 64 KiB.
TEST(ThreadedCode, NeedsNoStackHoweverLongItIs) {
  example::RandomProgram generator(4);
  const Program program = loaded(generator.make());
  const unsigned temporary = program.description().first_temporary();
  constexpr std::size_t often = 1'000'000;
  const std::vector<Instruction> code(often, instruction(Operation::add, temporary, temporary, temporary + 1));
  for (const Dispatch dispatch : dispatches) {
    struct Run {
      ThreadedCode code;
      LaneLookups lookups;
      std::vector<float> registers;
    } run{decode_threaded(code, dispatch), program.decoded().lookups(nullptr),
          std::vector<float>(program.description().register_count())};
    run.registers[temporary + 1] = 1;
    pthread_attr_t attributes;
    pthread_attr_init(&attributes);
    ASSERT_EQ(pthread_attr_setstacksize(&attributes, 64 * 1024), 0);
    pthread_t thread;
    const auto body = [](void* argument) -> void* {
      Run& given = *static_cast<Run*>(argument);
      run_threaded(given.code, given.lookups, given.registers.data());
      return nullptr;
    };
    ASSERT_EQ(pthread_create(&thread, &attributes, body, &run), 0);
    pthread_join(thread, nullptr);
    pthread_attr_destroy(&attributes);
    EXPECT_EQ(run.registers[temporary], static_cast<float>(often));
  }
}

TEST(ThreadedCode, EmptyCodeDoesNothing) {
  example::RandomProgram generator(3);
  const Program program = loaded(generator.make());
  const std::vector<float> registers = anything(program, generator);
  for (const Dispatch dispatch : dispatches)
    EXPECT_EQ(bits(threaded(program.decoded(), {}, dispatch, registers)), bits(registers));
}

}  // namespace
}  // namespace wale::threaded_code_test
