#include "runtime/machine/states.hpp"

namespace wale {

#if defined(__GNUC__)
__attribute__((noinline))  // see FloatingPointMode
#endif
void enter_lane(const DecodedProgram& program, float* registers) noexcept {
  const PatchProgram& description = program.description;
  run_threaded(program.lane_enter, program.lookups(nullptr), registers);
  float* states = registers + description.first_state();
  for (const State& state : description.states) *states++ = initial_state(registers[state.initial], state);
}

#if defined(__GNUC__)
__attribute__((noinline))  // see FloatingPointMode
#endif
void enter_block(const DecodedProgram& program, Block& block, const float* registers) {
  const PatchProgram& description = program.description;
  block.run(program.enter, registers, nullptr);
  RegisterNumber number = description.first_state();
  for (const State& state : description.states) {
    float* row = block.row(block_operand(description, number++));
    const BlockOperand initial = block_operand(description, state.initial);
    for (std::size_t lane = 0; lane < lanes; ++lane) {
      row[lane] = initial_state(block.value(initial, lane, registers), state);
    }
  }
}

}  // namespace wale
