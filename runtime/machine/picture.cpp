#include "wale/picture.hpp"

#include <algorithm>

#include "runtime/machine/decoded_program.hpp"
#include "runtime/machine/floating_point_mode.hpp"
#include "runtime/machine/inputs.hpp"
#include "runtime/machine/meet_edge.hpp"
#include "runtime/machine/states.hpp"

namespace wale {
namespace {

/// All inputs that come from a hand.
constexpr auto hand_inputs = [] {
  std::array<Input, changing_inputs> inputs{};
  std::size_t count = 0;
  for (RegisterNumber number = 0; number < first_constant; ++number)
    if (input_table[number].changes) inputs[count++] = static_cast<Input>(number);
  return inputs;
}();

bool belongs(const Memory* memory, const Bank& bank) {
  return memory != nullptr && &memory->program().decoded() == &bank.program().decoded();
}

/// A copy of the bank's registers with a hand, and with the states of the memory or, without one, those after entering.
std::vector<float> registers_at(const Bank& bank, const Memory* memory, const Hand& hand) {
  const DecodedProgram& program = bank.program().decoded();
  std::vector<float> registers(bank.registers().begin(), bank.registers().end());
  HandReader(hand_inputs, program.envelope)(hand, registers.data());
  if (memory != nullptr) {
    std::copy(memory->states().begin(), memory->states().end(), registers.begin() + program.description.first_state());
  } else {
    const FloatingPointMode mode;
    enter_lane(program, registers.data());
  }
  return registers;
}

float within_one(float value) { return value > 0 ? std::min(value, 1.0f) : 0.0f; }

}  // namespace

void surface_all(const Bank& bank, const Memory* memory, std::span<const glm::vec2> positions, std::span<float> heights,
                 std::span<glm::vec3> colours) {
  surface_all(bank, memory, positions, Shape(), heights, colours);
}

void surface_all(const Bank& bank, const Memory* memory, std::span<const glm::vec2> positions, const Shape& shape,
                 std::span<float> heights, std::span<glm::vec3> colours) {
  const DecodedProgram& program = bank.program().decoded();
  const PatchProgram& description = program.description;
  const Picture& picture = description.picture;
  if (!belongs(memory, bank)) memory = nullptr;
  const std::vector<float> registers = registers_at(bank, memory, {});
  const float* cells = memory != nullptr ? memory->cells().data() : program.initial_cells.data();
  const auto operand = [&description](RegisterNumber number) { return block_operand(description, number); };

  Block block(description);
  for (std::size_t i = 0; i < description.states.size(); ++i) {
    const auto number = static_cast<RegisterNumber>(description.first_state() + i);
    std::fill_n(block.row(operand(number)), lanes, registers[number]);
  }
  const BlockOperand relief = operand(picture.relief);
  constexpr std::array places = {Input::x, Input::y, Input::shape_edge, Input::shape_edge_x, Input::shape_edge_y};
  const bool coloured = picture.colour && !colours.empty();
  std::array<Hand, lanes> hands;
  for (std::size_t first = 0; first < positions.size(); first += lanes) {
    const std::size_t count = std::min(lanes, positions.size() - first);
    for (std::size_t lane = 0; lane < count; ++lane) {
      hands[lane].position = positions[first + lane];
      if (shape.is_rectangle()) continue;
      const EdgeDistance edge = shape.edge(hands[lane].position);
      meet_edge(hands[lane], edge.metres, edge.slope);
    }
    for (const Input each : places)
      place_input(each, std::span(hands).first(count), program.envelope, block.row(operand(static_cast<RegisterNumber>(each))));
    const FloatingPointMode mode;
    block.run(program.picture.code(), registers.data(), cells);
    for (std::size_t lane = 0; lane < count; ++lane) {
      const auto value = [&](BlockOperand of) { return block.value(of, lane, registers.data()); };
      heights[first + lane] = value(relief);
      if (!coloured) continue;
      const auto& [red, green, blue] = *picture.colour;
      colours[first + lane] = {within_one(value(operand(red))), within_one(value(operand(green))),
                               within_one(value(operand(blue)))};
    }
  }
}

void relief_all(const Bank& bank, std::span<const glm::vec2> positions, std::span<float> heights) {
  surface_all(bank, nullptr, positions, heights);
}

std::vector<ShownMark> show(const Bank& bank, const Memory& memory, const Hand& hand) {
  const DecodedProgram& program = bank.program().decoded();
  const Picture& picture = program.description.picture;
  const Memory* own = belongs(&memory, bank) ? &memory : nullptr;
  std::vector<float> registers = registers_at(bank, own, hand);
  {
    const FloatingPointMode mode;
    const float* cells = own != nullptr ? own->cells().data() : program.initial_cells.data();
    run_threaded(program.lane_frame, program.lookups(cells), registers.data());
  }
  std::vector<ShownMark> shown;
  for (const Mark& mark : picture.marks) {
    ShownMark one{.kind = mark.kind, .colour = mark.colour};
    for (std::size_t i = 0; i < mark_operands(mark.kind); ++i) one.values[i] = registers[mark.operands[i]];
    shown.push_back(one);
  }
  return shown;
}

}  // namespace wale
