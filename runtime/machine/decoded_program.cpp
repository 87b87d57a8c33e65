#include "runtime/machine/decoded_program.hpp"

#include <array>

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
  for (const Grid& grid : grids)
    cells.insert(cells.end(), std::size_t{grid.columns} * grid.rows, arithmetic::flushed(grid.initial));
  return cells;
}

std::vector<Input> tick_inputs_of(const PatchProgram& program) {
  std::array<bool, first_constant> read{};  // by input
  const auto reads = [&read](RegisterNumber number) {
    if (number < first_constant) read[number] = true;
  };
  for (const auto* code : {&program.enter, &program.tick}) {
    for (const Instruction& instruction : *code) {
      const int operands = operation_table[instruction.operation].operands;
      if (operands > 0) reads(instruction.a);
      if (operands > 1) reads(instruction.b);
      if (operands > 2) reads(instruction.c);
    }
  }
  for (const State& state : program.states) reads(state.initial), reads(state.next);
  for (const GridWrite& write : program.writes) reads(write.u), reads(write.v), reads(write.value);
  std::vector<Input> inputs;
  for (RegisterNumber number = 0; number < first_constant; ++number) {
    if (read[number] && input_table[number].changes) inputs.push_back(static_cast<Input>(number));
  }
  return inputs;
}

}  // namespace

const BlockCode& BlockSection::code() const {
  if (is_decoded_.load(std::memory_order_acquire)) return code_;
  const std::lock_guard lock(decoding_);  // with std::call_once an exception may end the process when memory is short
  if (!is_decoded_.load(std::memory_order_relaxed)) {
    code_ = decode_block(program_.description, program_.splines, program_.grids, instructions_);
    is_decoded_.store(true, std::memory_order_release);
  }
  return code_;
}

DecodedProgram::DecodedProgram(PatchProgram verified) : description(std::move(verified)), envelope(description.device) {
  for (HeightTable& table : description.tables) {
    maps.push_back(shared_map(table));
    splines.emplace_back(maps.back()->spline);
    table = maps.back()->table;
  }
  grids = shapes_of(description.grids);
  initial_cells = initial_cells_of(description.grids);
  tick_inputs = tick_inputs_of(description);
  hand_reader = HandReader(tick_inputs, envelope);
  lane_enter = decode_threaded(description.enter);
  lane_tick = decode_threaded(description.tick);
  lane_frame = decode_threaded(description.picture.frame);
  for (const Peak& peak : description.peaks) peaks.push_back(std::make_unique<const BlockSection>(*this, peak.code));
  first_state = description.first_state();
  for (const State& state : description.states) state_rules.emplace_back(state);
  for (const GridWrite& write : description.writes)
    write_rules.emplace_back(write, description.grids[write.grid], grids[write.grid]);
  for (const Output& output : description.outputs) (output.component() == 0 ? force_x : force_y) = output.value;
}

}  // namespace wale
