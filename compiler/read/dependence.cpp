#include "compiler/read/dependence.hpp"

#include <algorithm>
#include <array>
#include <set>
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

bool remembers_time_only(const PatchProgram& program) {
  if (program.states.empty() || !program.grids.empty()) return false;
  // What the hand changes, register by register in the order of the tick.
  std::set<RegisterNumber> by_hand;
  for (const Input input : {Input::x, Input::y, Input::workspace_x, Input::workspace_y, Input::velocity_x,
                            Input::velocity_y, Input::raw_velocity_x, Input::raw_velocity_y, Input::acceleration_x,
                            Input::acceleration_y, Input::raw_acceleration_x, Input::raw_acceleration_y, Input::button})
    by_hand.insert(static_cast<RegisterNumber>(input));
  const auto is_changed = [&](const Instruction& instruction) {
    const std::string_view fields = facts(static_cast<Operation>(instruction.operation)).fields;
    const std::array operands = {instruction.a, instruction.b, instruction.c};
    for (std::size_t i = 0; i < operands.size(); ++i)
      if (fields[i] == 'r' && by_hand.contains(operands[i])) return true;
    return false;
  };
  // A state may begin as the place at which the hand came.
  if (std::ranges::any_of(program.enter, is_changed) ||
      std::ranges::any_of(program.states, [&](const State& state) { return by_hand.contains(state.initial); }))
    return false;
  for (const Instruction& instruction : program.tick) {
    if (is_changed(instruction))
      by_hand.insert(instruction.destination);
    else
      by_hand.erase(instruction.destination);
  }
  return std::ranges::none_of(program.states, [&](const State& state) { return by_hand.contains(state.next); });
}

bool depends_on_motion(const PatchProgram& program) {
  return reads(program, {Input::velocity_x, Input::velocity_y, Input::raw_velocity_x, Input::raw_velocity_y}) ||
         (remembers_anything(program) && !remembers_time_only(program));
}

}  // namespace wale
