#include "compiler/prove/prove.hpp"

#include <cmath>

#include "compiler/prove/range_machine.hpp"
#include "compiler/prove/slice.hpp"

namespace wale {

double length_bound(const Interval& x, const Interval& y) {
  const double a = x.largest(), b = y.largest();
  return std::sqrt(a * a + b * b) * (1 + 0x1p-50);  // two roundings of the sum and one of the root
}

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
  // A peak finds the setup registers as they are when its instruction runs it.
  for (const Instruction& instruction : description.setup) {
    if (instruction.operation == static_cast<std::uint8_t>(Operation::peak)) {
      const std::vector<Instruction>& code = description.peaks[instruction.a].code;
      Proof::Ranges& ranges = proof.peaks[instruction.a];
      ranges.resize(code.size());
      machine.run_peak(instruction.a, code, ranges);
    }
    machine.run({&instruction, 1}, {&proof.setup.emplace_back(), 1});
  }
  proof.enter = run(description.enter);
  proof.tick = run(description.tick);
  for (const Output& output : description.outputs) {
    proof.force[output.axis] = machine.range(output.value);
    proof.ceiling[output.axis] = machine.range(output.ceiling);
  }
  for (const Output& output : description.outputs) {
    // The last instruction that writes it is its limit. What that is given is what a run up to it leaves, since
    // registers are used again.
    std::size_t limit = description.tick.size() - 1;
    while (description.tick[limit].destination != output.value) --limit;
    machine.run({description.tick.data(), limit});
    proof.unlimited[output.axis] = machine.range(description.tick[limit].a);
  }
  proof.bound_newton = length_bound(proof.force[0], proof.force[1]);
  proof.picture = run(description.picture.code);
  proof.frame = run(description.picture.frame);
  for (const PerceptRecord& percept : description.percepts) proof.predictions.push_back(run(percept.prediction));
  return proof;
}

Proof prove(const Program& program) { return prove(program, whole_domain(program.description())); }

}  // namespace wale
