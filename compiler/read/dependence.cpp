#include "compiler/read/dependence.hpp"

#include <algorithm>
#include <array>
#include <string_view>

namespace wale {

bool reads(const PatchProgram& program, std::initializer_list<Input> inputs) {
  return std::ranges::any_of(program.tick, [&](const Instruction& instruction) {
    const std::string_view fields = facts(static_cast<Operation>(instruction.operation)).fields;
    const std::array operands = {instruction.a, instruction.b, instruction.c};
    for (std::size_t i = 0; i < operands.size(); ++i)
      if (fields[i] == 'r' &&
          std::ranges::any_of(inputs, [&](Input input) { return operands[i] == static_cast<RegisterNumber>(input); }))
        return true;
    return false;
  });
}

bool depends_on_place(const PatchProgram& program) {
  // A state may start as the hand's position.
  return !program.states.empty() || !program.grids.empty() ||
         reads(program, {Input::x, Input::y, Input::workspace_x, Input::workspace_y});
}

bool remembers_anything(const PatchProgram& program) { return !program.states.empty() || !program.grids.empty(); }

}  // namespace wale
