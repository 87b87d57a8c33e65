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

namespace {

/// Whether an instruction reads one of these registers.
bool reads_any(const Instruction& instruction, const std::set<RegisterNumber>& registers) {
  const std::string_view fields = facts(static_cast<Operation>(instruction.operation)).fields;
  const std::array operands = {instruction.a, instruction.b, instruction.c};
  for (std::size_t i = 0; i < operands.size(); ++i)
    if (fields[i] == 'r' && registers.contains(operands[i])) return true;
  return false;
}

std::set<RegisterNumber> of_the_hand() {
  std::set<RegisterNumber> found;
  for (const Input input : {Input::x, Input::y, Input::workspace_x, Input::workspace_y, Input::velocity_x,
                            Input::velocity_y, Input::raw_velocity_x, Input::raw_velocity_y, Input::acceleration_x,
                            Input::acceleration_y, Input::raw_acceleration_x, Input::raw_acceleration_y, Input::button})
    found.insert(static_cast<RegisterNumber>(input));
  return found;
}

/// What the hand has changed at the end of a tick, register by register in the order of the tick.
std::set<RegisterNumber> changed_by_hand(const PatchProgram& program) {
  std::set<RegisterNumber> by_hand = of_the_hand();
  for (const Instruction& instruction : program.tick) {
    if (reads_any(instruction, by_hand))
      by_hand.insert(instruction.destination);
    else
      by_hand.erase(instruction.destination);
  }
  return by_hand;
}

}  // namespace

bool remembers_time_only(const PatchProgram& program) {
  if (program.states.empty() || !program.grids.empty()) return false;
  const std::set<RegisterNumber> hand = of_the_hand(), by_hand = changed_by_hand(program);
  // A state may begin as the place at which the hand came.
  return std::ranges::none_of(program.enter, [&](const Instruction& each) { return reads_any(each, hand); }) &&
         std::ranges::none_of(program.states, [&](const State& state) {
           return hand.contains(state.initial) || by_hand.contains(state.next);
         });
}

bool goes_by_time(const PatchProgram& program) {
  if (!program.grids.empty()) return false;
  if (reads(program, {Input::time})) return true;
  const std::set<RegisterNumber> by_hand = changed_by_hand(program);
  return std::ranges::any_of(program.states, [&](const State& state) { return !by_hand.contains(state.next); });
}

bool depends_on_motion(const PatchProgram& program) {
  return reads(program, {Input::velocity_x, Input::velocity_y, Input::raw_velocity_x, Input::raw_velocity_y}) ||
         (remembers_anything(program) && !remembers_time_only(program));
}

}  // namespace wale
