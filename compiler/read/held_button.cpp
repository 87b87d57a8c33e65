#include "compiler/read/held_button.hpp"

#include <algorithm>
#include <string_view>
#include <utility>
#include <vector>

#include "compiler/read/dependence.hpp"
#include "compiler/read/slow_sway.hpp"

namespace wale {
namespace {

constexpr auto button_register = static_cast<RegisterNumber>(Input::button);

/// Makes a section's code read `held` for the button.
void read_for_button(std::vector<Instruction>& code, RegisterNumber held) {
  for (Instruction& each : code) {
    const std::string_view fields = facts(static_cast<Operation>(each.operation)).fields;
    RegisterNumber* const operands[] = {&each.a, &each.b, &each.c};
    for (std::size_t i = 0; i < 3; ++i)
      if (fields[i] == 'r' && *operands[i] == button_register) *operands[i] = held;
  }
  // A number divided by itself is 1, and a tick is never 0 s long.
  constexpr auto tick_length = static_cast<RegisterNumber>(Input::seconds_per_tick);
  code.insert(code.begin(), {static_cast<std::uint8_t>(Operation::divide), held, tick_length, tick_length, 0});
}

}  // namespace

std::optional<Bank> with_button_held(const Bank& bank) {
  PatchProgram program = bank.program().description();
  if (program.vibrates() || !reads(program, {Input::button})) return std::nullopt;
  const auto held = static_cast<RegisterNumber>(program.register_count());
  ++program.temporaries;
  read_for_button(program.tick, held);
  if (!program.states.empty()) read_for_button(program.enter, held);
  const auto replace = [&](RegisterNumber& number) {
    if (number == button_register) number = held;
  };
  for (State& state : program.states) replace(state.initial), replace(state.next);
  for (GridWrite& write : program.writes) replace(write.u), replace(write.v), replace(write.value);
  program.places = {};
  const auto first = bank.registers().begin() + program.first_parameter();
  const std::vector<float> parameters(first, first + static_cast<std::ptrdiff_t>(program.parameters.size()));
  const Result<Program> loaded = Program::load(std::move(program));
  if (!loaded) return std::nullopt;
  return Bank(*loaded, parameters, bank.size());
}

std::optional<HeldButton> held_button(const Bank& bank, const WallFace* wall) {
  const std::optional<Bank> held = with_button_held(bank);
  if (!held) return std::nullopt;
  HeldButton found;
  found.opposing = opposing_force(*held, wall), found.inertia = inertia(*held);
  const std::vector<std::vector<Force>> felt = felt_at_rest(*held);
  tell_swings(*held, felt, found.sway, found.vibration);
  found.slow = slow_parts(*held, felt, found.sway, found.vibration).change;
  return found;
}

}  // namespace wale
