#include "runtime/machine/decoded_program.hpp"

#include <array>
#include <set>

namespace wale {
namespace {

std::vector<GridShape> shapes_of(std::span<const Grid> grids) {
  std::vector<GridShape> shapes;
  std::size_t first = 0;
  for (const Grid& grid : grids) {
    shapes.push_back({first, grid.columns, grid.rows});
    first += std::size_t{grid.columns} * grid.rows;
  }
  return shapes;
}

std::vector<float> initial_cells_of(std::span<const Grid> grids) {
  std::vector<float> cells;
  for (const Grid& grid : grids) cells.insert(cells.end(), std::size_t{grid.columns} * grid.rows, grid.initial);
  return cells;
}

std::vector<Input> tick_inputs_of(const PatchProgram& program) {
  std::set<RegisterNumber> read;
  for (const auto* code : {&program.enter, &program.tick}) {
    for (const Instruction& instruction : *code) {
      const std::string_view fields = facts(static_cast<Operation>(instruction.operation)).fields;
      const std::array<RegisterNumber, 3> operands = {instruction.a, instruction.b, instruction.c};
      for (std::size_t i = 0; i < operands.size(); ++i) {
        if (fields[i] == 'r') read.insert(operands[i]);
      }
    }
  }
  for (const State& state : program.states) read.insert({state.initial, state.next});
  for (const GridWrite& write : program.writes) read.insert({write.u, write.v, write.value});
  std::vector<Input> inputs;
  for (const RegisterNumber number : read) {
    if (number < first_constant && !block_operand(program, number).uniform) inputs.push_back(static_cast<Input>(number));
  }
  return inputs;
}

}  // namespace

DecodedProgram::DecodedProgram(PatchProgram verified) : description(std::move(verified)) {
  splines.reserve(description.tables.size());
  for (const HeightTable& table : description.tables) splines.emplace_back(table);
  grids = shapes_of(description.grids);
  initial_cells = initial_cells_of(description.grids);
  tick_inputs = tick_inputs_of(description);
  const auto block = [this](std::span<const Instruction> code) {
    return decode_block(description, splines, grids, code);
  };
  enter = block(description.enter);
  tick = block(description.tick);
  picture = block(description.picture.code);
  for (const Peak& peak : description.peaks) peaks.push_back(block(peak.code));
  for (const Output& output : description.outputs) (output.axis == 0 ? force_x : force_y) = output.value;
}

}  // namespace wale
