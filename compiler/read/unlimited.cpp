#include "compiler/read/unlimited.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <vector>

namespace wale {
namespace {

constexpr double just_below = 1 - 1e-5;  // of the limit: 32-bit floats round

/// The tick's last instruction that writes this register.
std::vector<Instruction>::iterator last_writer(std::vector<Instruction>& code, RegisterNumber number) {
  const auto found =
      std::find_if(code.rbegin(), code.rend(), [&](const Instruction& each) { return each.destination == number; });
  return found == code.rend() ? code.end() : std::prev(found.base());
}

}  // namespace

std::optional<Unlimited> without_limit(const Bank& bank) {
  PatchProgram program = bank.program().description();
  if (program.vibrates()) return std::nullopt;
  // Every force must end in a limit of at most the device's. A force over a second's ticks is so small that the limit
  // does not reach it, and the number of ticks is there as an input.
  for (const Output& output : program.outputs) {
    const auto limit = last_writer(program.tick, output.value);
    if (limit == program.tick.end() || limit->operation != static_cast<std::uint8_t>(Operation::limit))
      return std::nullopt;
    const Instruction smaller{static_cast<std::uint8_t>(Operation::multiply), output.value, limit->a,
                              static_cast<RegisterNumber>(Input::seconds_per_tick), 0};
    const Instruction limited{static_cast<std::uint8_t>(Operation::limit), output.value, output.value, output.ceiling,
                              0};
    *limit = limited;
    program.tick.insert(limit, smaller);
  }
  std::vector<float> parameters;
  for (std::size_t i = 0; i < program.parameters.size(); ++i)
    parameters.push_back(bank.registers()[program.first_parameter() + i]);
  const double ticks = program.device.rate;
  Result<Program> loaded = Program::load(std::move(program));
  if (!loaded) return std::nullopt;
  return Unlimited{Bank(*loaded, parameters, bank.size()), ticks};
}

bool at_limit(glm::dvec2 force, double most) {
  return std::max(std::abs(force.x), std::abs(force.y)) >= just_below * most;
}

}  // namespace wale
