#include <algorithm>

#include "runtime/machine/decoded_program.hpp"
#include "runtime/machine/floating_point_mode.hpp"
#include "runtime/machine/inputs.hpp"
#include "runtime/machine/parallel.hpp"
#include "runtime/machine/states.hpp"
#include "runtime/machine/tick_alone.hpp"
#include "wale/memory.hpp"
#include "wale/program.hpp"

namespace wale {

Force tick(Bank& bank, const Hand& hand) noexcept {
  const DecodedProgram& program = bank.program().decoded();
  float* registers = bank.registers().data();
  program.hand_reader(hand, registers);
  {
    const FloatingPointMode mode;
    if (!program.description.states.empty()) enter_lane(program, registers);
    run_threaded(program.lane_tick, program.lookups(program.initial_cells.data()), registers);
  }
  return {registers[program.force_x], registers[program.force_y]};
}

Force tick(Bank& bank, Memory& memory, const Hand& hand) noexcept {
  const DecodedProgram& program = bank.program().decoded();
  if (&program != &memory.program_.decoded()) return tick(bank, hand);
  float* registers = bank.registers().data();
  program.hand_reader(hand, registers);
  float* state = registers + program.first_state;
  for (const float value : memory.states_) *state++ = value;
  {
    const FloatingPointMode mode;
    run_threaded(program.lane_tick, program.lookups(memory.cells_.data()), registers);
    memory.remember(registers);
  }
  return {registers[program.force_x], registers[program.force_y]};
}

namespace {

/// In units of cost, summed over all hands. More work than this (about a millisecond in blocks) is divided among
/// threads.
constexpr double worth_a_thread = 4e6;

}  // namespace

void tick_alone(const Bank& bank, std::span<const Hand> hands, std::span<Force> forces) {
  const DecodedProgram& program = bank.program().decoded();
  const PatchProgram& description = program.description;
  const float* registers = bank.registers().data();
  const BlockOperand force_x = block_operand(description, program.force_x);
  const BlockOperand force_y = block_operand(description, program.force_y);
  Block block(description);
  for (std::size_t first = 0; first < hands.size(); first += lanes) {
    const std::size_t count = std::min(lanes, hands.size() - first);
    for (const Input input : program.tick_inputs) {
      float* row = block.row(block_operand(description, static_cast<RegisterNumber>(input)));
      place_input(input, hands.subspan(first, count), program.envelope, row);
    }
    const FloatingPointMode mode;
    if (!description.states.empty()) enter_block(program, block, registers, count);
    block.run(program.tick.code(), registers, program.initial_cells.data(), count);
    block.pairs(force_x, force_y, registers, forces.subspan(first, count));
  }
}

void tick_all(const Bank& bank, std::span<const Hand> hands, std::span<Force> forces) {
  const PatchProgram& description = bank.program().description();
  const double cost = 1.0 + static_cast<double>(cost_of(description.enter) + cost_of(description.tick));
  if (static_cast<double>(hands.size()) * cost < worth_a_thread) return tick_alone(bank, hands, forces);
  in_parallel((hands.size() + lanes - 1) / lanes, [&](std::size_t begin, std::size_t end) {
    const std::size_t first = begin * lanes, count = std::min(end * lanes, hands.size()) - first;
    tick_alone(bank, hands.subspan(first, count), forces.subspan(first, count));
  });
}

}  // namespace wale
