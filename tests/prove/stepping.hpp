#pragma once

#include <cmath>
#include <optional>
#include <span>
#include <sstream>
#include <string>
#include <vector>

#include "compiler/prove/prove.hpp"
#include "runtime/machine/decoded_program.hpp"
#include "runtime/machine/floating_point_mode.hpp"
#include "runtime/machine/grid.hpp"
#include "runtime/machine/meaning.hpp"
#include "runtime/machine/peak.hpp"

/// A plain machine for tests. It runs one instruction at a time and exposes every register.
namespace wale::stepping {

/// Registers, cells and the cost so far of a run.
struct State {
  const DecodedProgram& program;
  std::vector<float> registers;
  std::vector<float> cells;
  long cost = 0;  ///< of all instructions run so far
};

/// Runs one instruction. Not inlined, so that it is computed in the floating-point mode that the caller has set.
[[gnu::noinline]] inline void step(State& state, const Instruction& i) {
  float* const r = state.registers.data();
  const auto three = [&](const auto& sample) {
    r[i.destination] = sample.value;
    r[i.destination + 1] = sample.along_a;
    r[i.destination + 2] = sample.along_b;
  };
  const auto operation = static_cast<Operation>(i.operation);
  // clang-format off
  switch (operation) {
#define INSTRUCTION(number, name, fields, results, cost, meaning, range, derivative)                        \
    case Operation::name: r[i.destination] = Meaning<Operation::name>::of(r[i.a], r[i.b], r[i.c]); break;
#define SPECIAL(number, name, fields, results, cost)
#include "wale/instruction.def"
    case Operation::sample: three(sample_of(state.program.splines.at(i.c), r[i.a], r[i.b])); break;
    case Operation::recall: three(recall_of(state.program.grids.at(i.c), state.cells.data(), r[i.a], r[i.b])); break;
    case Operation::cell: r[i.destination] = state.cells.at(cell_at(state.program.grids.at(i.c), r[i.a], r[i.b])); break;
    case Operation::peak: r[i.destination] = value_of_peak(state.program, i.a, state.registers); break;
  }
  // clang-format on
  state.cost += facts(operation).cost;
}

/// Runs code and returns the first result outside of its range, in words.
inline std::optional<std::string> run(State& state, std::span<const Instruction> code, const std::string& section,
                                      std::span<const ResultRanges> ranges) {
  const FloatingPointMode mode;
  for (std::size_t number = 0; number < code.size(); ++number) {
    step(state, code[number]);
    const OperationFacts& known = operation_table[code[number].operation];
    for (int result = 0; result < known.results; ++result) {
      const float value = state.registers[code[number].destination + static_cast<std::size_t>(result)];
      const Interval& range = ranges[number][static_cast<std::size_t>(result)];
      if (range.contains(value)) continue;
      std::ostringstream complaint;
      complaint.precision(9);
      complaint << section << " " << number << " " << known.name << " leaves " << value << " as its result " << result
                << ", and " << range.low << " .. " << range.high << (range.maybe_nan ? " or nan" : "") << " is proved";
      return complaint.str();
    }
  }
  return std::nullopt;
}

/// A force with subnormals as zero: instructions that only move a value may pass a subnormal on.
inline double seen(float force) { return std::abs(force) < arithmetic::least_normal ? 0.0 : force; }

/// Runs every section of a program whose inputs, constants, parameters and states are set in `state`. Returns the first
/// result outside of its range, or force outside of its bound, in words.
inline std::optional<std::string> run_all(State& state, const Proof& proof) {
  const PatchProgram& program = state.program.description;
  // Peaks run on a copy of the state, at corners and inner places of their box.
  for (std::size_t number = 0; number < program.setup.size(); ++number) {
    const Instruction& instruction = program.setup[number];
    if (instruction.operation == static_cast<std::uint8_t>(Operation::peak)) {
      const Peak& peak = program.peaks[instruction.a];
      for (const auto& [u, v] : {std::pair{-1.0f, 1.0f}, {0.0f, 0.0f}, {0.37f, -0.83f}, {1.0f, 1.0f}}) {
        State at = state;
        const FloatingPointMode mode;
        at.registers[0] = u * state.registers[peak.half_width];
        at.registers[1] = v * state.registers[peak.half_height];
        if (auto complaint = run(at, peak.code, "peak", proof.peaks[instruction.a])) return complaint;
      }
    }
    if (auto complaint = run(state, {&instruction, 1}, "setup", {&proof.setup[number], 1})) return complaint;
  }
  const auto section = [&](const std::vector<Instruction>& code, const std::string& name, const Proof::Ranges& ranges) {
    const long before = state.cost;
    auto complaint = run(state, code, name, ranges);
    if (!complaint && state.cost - before > cost_of(code)) complaint = name + " costs more than it declares";
    return complaint;
  };
  if (auto complaint = section(program.enter, "enter", proof.enter)) return complaint;
  if (auto complaint = section(program.picture.code, "picture", proof.picture)) return complaint;
  if (auto complaint = section(program.picture.frame, "frame", proof.frame)) return complaint;
  for (std::size_t i = 0; i < program.percepts.size(); ++i) {
    if (auto complaint = section(program.percepts[i].prediction, "prediction", proof.predictions[i])) return complaint;
  }
  if (auto complaint = section(program.tick, "tick", proof.tick)) return complaint;
  double squares = 0;
  for (const Output& output : program.outputs) {
    const float force = state.registers[output.value];
    if (!proof.force[output.component()].contains(force)) return "a force leaves its range";
    const float ceiling = state.registers[output.ceiling];
    if (!(std::abs(seen(force)) <= ceiling || seen(force) == 0)) return "a force leaves its ceiling";
    squares += seen(force) * seen(force);
  }
  if (!(std::sqrt(squares) <= proof.bound_newton)) return "the force leaves its bound";
  return std::nullopt;
}

}  // namespace wale::stepping
