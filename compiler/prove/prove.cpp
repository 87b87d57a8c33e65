#include "compiler/prove/prove.hpp"

#include <algorithm>

#include "compiler/prove/range_machine.hpp"
#include "compiler/prove/relations.hpp"
#include "compiler/prove/slice.hpp"

namespace wale {

Proof prove(const Program& program, const Domain& domain) {
  const PatchProgram& description = program.description();
  const std::vector<Quantity> quantities = force_slice(description).quantities;
  RangeMachine machine(program);
  Proof proof;
  const auto run = [&](const std::vector<Instruction>& code) {
    Proof::Ranges ranges(code.size());
    machine.run(code, ranges);
    return ranges;
  };
  machine.start(domain, quantities);
  proof.peaks.resize(description.peaks.size());
  const Relations relations(description, description.setup, description.tick);
  // A peak reads the setup registers as they are when its instruction runs.
  for (const Instruction& instruction : description.setup) {
    if (instruction.operation == static_cast<std::uint8_t>(Operation::peak)) {
      const std::vector<Instruction>& code = description.peaks[instruction.a].code;
      Proof::Ranges& ranges = proof.peaks[instruction.a];
      ranges.resize(code.size());
      machine.run_peak(instruction.a, code, ranges);
    }
    const std::size_t number = proof.setup.size();
    machine.run({&instruction, 1}, relations, number, {&proof.setup.emplace_back(), 1});
  }
  proof.enter = run(description.enter);
  proof.tick.resize(description.tick.size());
  machine.run(description.tick, relations, description.setup.size(), proof.tick);
  std::array<RegisterNumber, 2> values{};
  for (const Output& output : description.outputs) {
    proof.force[output.component()] = machine.range(output.value);
    proof.ceiling[output.component()] = machine.range(output.ceiling);
    values[output.component()] = output.value;
  }
  proof.bound_newton =
      std::min(length_bound(proof.force[0], proof.force[1]), machine.length(relations, values[0], values[1]));
  for (const Output& output : description.outputs) {
    // The last instruction that writes the register is its limit. Registers are used again, so the operand of the limit
    // is read from a run up to it.
    std::size_t limit = description.tick.size() - 1;
    while (description.tick[limit].destination != output.value) --limit;
    const std::span before(description.tick.data(), limit);
    machine.run(before, relations, description.setup.size());
    proof.unlimited[output.component()] = machine.range(description.tick[limit].a);
  }
  proof.picture = run(description.picture.code);
  proof.frame = run(description.picture.frame);
  for (const PerceptRecord& percept : description.percepts) proof.predictions.push_back(run(percept.prediction));
  return proof;
}

Proof prove(const Program& program) { return prove(program, whole_domain(program.description())); }

}  // namespace wale
