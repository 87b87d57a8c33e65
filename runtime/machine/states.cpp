#include "runtime/machine/states.hpp"

namespace wale {

#if defined(__GNUC__)
__attribute__((noinline))  // see FloatingPointMode
#endif
void enter_lane(const DecodedProgram& program, float* registers) noexcept {
  run_threaded(program.lane_enter, program.lookups(nullptr), registers);
  float* states = registers + program.first_state;
  for (const StateRule& rule : program.state_rules) *states++ = initial_state(registers[rule.initial], rule);
}

#if defined(__GNUC__)
__attribute__((noinline))  // see FloatingPointMode
#endif
void enter_block(const DecodedProgram& program, Block& block, const float* registers, std::size_t count) {
  block.run(program.enter.code(), registers, nullptr, count);
  RegisterNumber number = program.first_state;
  for (const StateRule& rule : program.state_rules) {
    float* row = block.row(block_operand(program.first_state, number++));
    const BlockOperand initial = block_operand(program.first_state, rule.initial);
    for (std::size_t lane = 0; lane < count; ++lane) {
      row[lane] = initial_state(block.value(initial, lane, registers), rule);
    }
  }
}

}  // namespace wale
