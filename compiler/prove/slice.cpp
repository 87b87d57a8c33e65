#include "compiler/prove/slice.hpp"

#include <algorithm>

namespace wale {
namespace {

/// Whether the value of each register is read later.
using Live = std::vector<char>;

void read(const Instruction& instruction, Live& live) {
  const int operands = facts(static_cast<Operation>(instruction.operation)).operands;
  if (operands > 0) live[instruction.a] = true;
  if (operands > 1) live[instruction.b] = true;
  if (operands > 2) live[instruction.c] = true;
}

/// The instructions of `code` that the live registers at its end depend on; `live` becomes the live registers at its
/// beginning. `also` is called for each.
template <typename Also>
std::vector<Instruction> sliced(const std::vector<Instruction>& code, Live& live, const Also& also) {
  std::vector<Instruction> kept;
  for (auto i = code.rbegin(); i != code.rend(); ++i) {
    const int results = facts(static_cast<Operation>(i->operation)).results;
    bool needed = false;
    for (int result = 0; result < results; ++result) {
      needed |= live[i->destination + result] != 0;
      live[i->destination + result] = false;
    }
    if (!needed) continue;
    read(*i, live);
    also(*i);
    kept.push_back(*i);
  }
  std::reverse(kept.begin(), kept.end());
  return kept;
}

}  // namespace

ForceSlice force_slice(const PatchProgram& program) {
  ForceSlice slice;
  slice.peaks.resize(program.peaks.size());
  Live live(program.register_count());
  for (const Output& output : program.outputs) live[output.value] = true;
  slice.tick = sliced(program.tick, live, [](const Instruction&) {});
  slice.setup = sliced(program.setup, live, [&](const Instruction& instruction) {
    if (instruction.operation != static_cast<std::uint8_t>(Operation::peak)) return;
    const Peak& peak = program.peaks[instruction.a];
    Live in_peak(program.register_count());
    in_peak[peak.value] = true;
    slice.peaks[instruction.a] = sliced(peak.code, in_peak, [](const Instruction&) {});
    in_peak[static_cast<RegisterNumber>(Input::x)] = in_peak[static_cast<RegisterNumber>(Input::y)] = false;
    in_peak[peak.half_width] = in_peak[peak.half_height] = true;
    for (std::size_t i = 0; i < live.size(); ++i) live[i] = live[i] || in_peak[i];
  });
  const auto quantities = [&](Quantity::Kind kind, std::size_t first, std::size_t count) {
    for (std::size_t i = 0; i < count; ++i) {
      if (live[first + i]) slice.quantities.push_back({kind, i});
    }
  };
  quantities(Quantity::Kind::input, 0, static_cast<std::size_t>(Input::seconds_per_tick));
  quantities(Quantity::Kind::state, program.first_state(), program.states.size());
  quantities(Quantity::Kind::parameter, program.first_parameter(), program.parameters.size());
  return slice;
}

long ForceSlice::instructions() const {
  std::size_t count = setup.size() + tick.size();
  for (const auto& code : peaks) count += code.size();
  return static_cast<long>(count);
}

}  // namespace wale
