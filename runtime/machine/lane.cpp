#include "runtime/machine/lane.hpp"

#include "runtime/machine/meaning.hpp"
#include "runtime/machine/peak.hpp"

namespace wale {
namespace {

void run_sample(const DecodedProgram& program, const Instruction& i, float* registers, const float*) {
  const SplineSample sample = sample_of(program.splines[i.c], registers[i.a], registers[i.b]);
  registers[i.destination] = sample.value;
  registers[i.destination + 1] = sample.along_a;
  registers[i.destination + 2] = sample.along_b;
}

void run_recall(const DecodedProgram& program, const Instruction& i, float* registers, const float* cells) {
  const GridSample sample = recall_of(program.grids[i.c], cells, registers[i.a], registers[i.b]);
  registers[i.destination] = sample.value;
  registers[i.destination + 1] = sample.along_a;
  registers[i.destination + 2] = sample.along_b;
}

void run_cell(const DecodedProgram& program, const Instruction& i, float* registers, const float* cells) {
  registers[i.destination] = cells[cell_at(program.grids[i.c], registers[i.a], registers[i.b])];
}

void run_peak(const DecodedProgram& program, const Instruction& i, float* registers, const float*) {
  registers[i.destination] = value_of_peak(program, i.a, {registers, program.description.register_count()});
}

}  // namespace

#if defined(__GNUC__)
__attribute__((noinline))  // see FloatingPointMode
#endif
void run_lane(const DecodedProgram& program, std::span<const Instruction> code, float* registers,
              const float* cells) {
  // An operand that an operation does not read is 0, which is a register like any other.
  for (const Instruction& i : code) {
    // clang-format off
    switch (static_cast<Operation>(i.operation)) {
#define INSTRUCTION(number, name, fields, results, cost, meaning, range, derivative)                                  \
      case Operation::name:                                                                                    \
        registers[i.destination] = Meaning<Operation::name>::of(registers[i.a], registers[i.b], registers[i.c]); \
        break;
#define SPECIAL(number, name, fields, results, cost) \
      case Operation::name:                          \
        run_##name(program, i, registers, cells);    \
        break;
#include "wale/instruction.def"
    }
    // clang-format on
  }
}

}  // namespace wale
