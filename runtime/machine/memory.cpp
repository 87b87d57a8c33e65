#include "wale/memory.hpp"

#include <algorithm>
#include <cmath>

#include "runtime/machine/decoded_program.hpp"
#include "runtime/machine/floating_point_mode.hpp"
#include "runtime/machine/inputs.hpp"
#include "runtime/machine/states.hpp"

namespace wale {

Memory::Memory(const Program& program) : program_(program), cells_(program.decoded().initial_cells) {
  for (const State& state : program.description().states) {
    states_.push_back(initial_state(arithmetic::not_a_number, state));
  }
  initial_states_ = states_;
}

void Memory::enter(Bank& bank, const Hand& hand) noexcept {
  const DecodedProgram& program = program_.decoded();
  if (&program != &bank.program().decoded() || states_.empty()) return;
  float* registers = bank.registers().data();
  program.hand_reader(hand, registers);
  {
    const FloatingPointMode mode;
    enter_lane(program, registers);
  }
  for (std::size_t i = 0; i < states_.size(); ++i) {
    states_[i] = initial_states_[i] = registers[program.description.first_state() + i];
    if (std::isnan(registers[program.description.states[i].initial])) ++restored_;
  }
}

std::span<const float> Memory::grid(std::size_t index) const {
  const GridShape& shape = program_.decoded().grids[index];
  return std::span(cells_).subspan(shape.first, std::size_t{shape.columns} * shape.rows);
}

#if defined(__GNUC__)
__attribute__((noinline))  // see FloatingPointMode
#endif
void Memory::remember(const float* registers) noexcept {
  const DecodedProgram& decoded = program_.decoded();
  const PatchProgram& description = decoded.description;
  for (std::size_t i = 0; i < states_.size(); ++i) {
    const StateRule& rule = decoded.state_rules[i];
    const float next = registers[rule.next];
    const bool within = next >= rule.low && next <= rule.high && absolute(next) >= arithmetic::least_normal;
    if (within) [[likely]] {  // foreseen, so the next tick need not wait for it
      states_[i] = next;
    } else {
      states_[i] = held_state(next, rule, initial_states_[i]);
      if (next != next) ++restored_;
    }
  }
  for (const GridWrite& write : description.writes) {
    const float u = registers[write.u], v = registers[write.v], value = registers[write.value];
    if (u != u || v != v || value != value) continue;
    const Grid& grid = description.grids[write.grid];
    cells_[cell_at(decoded.grids[write.grid], u, v)] = std::clamp(value, grid.low, grid.high);
  }
}

}  // namespace wale
