#include "runtime/stage/potential_range.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <map>
#include <vector>

#include "runtime/machine/decoded_program.hpp"
#include "runtime/machine/floating_point_mode.hpp"
#include "runtime/machine/lane.hpp"
#include "runtime/machine/tick_alone.hpp"

namespace wale {
namespace {

constexpr std::size_t lines = 32, points = 512;

/// The middle of part `index` of `count` equal parts of a length, relative to the middle of the whole.
float middle(std::size_t index, std::size_t count, float length) {
  return length * ((static_cast<float>(index) + 0.5f) / static_cast<float>(count) - 0.5f);
}

/// The part of a tick that depends on one coordinate alone, and that one component of the force needs.
class OneCoordinate {
 public:
  /// `coordinate` is an input; `output` a register of the force.
  OneCoordinate(const Program& program, Input coordinate, RegisterNumber output) : program_(program.decoded()) {
    const PatchProgram& description = program.description();
    const std::size_t count = description.register_count();
    first_own_ = count;
    std::vector<bool> varies(count);      // by register: it may change along the line
    std::vector<std::size_t> own(count);  // by register: 1 more than where its value is kept, if it has one of its own
    const auto is_own = [&](RegisterNumber number) { return own[number] != 0; };
    for (const Input along : {Input::x, Input::y}) varies[static_cast<std::size_t>(along)] = along != coordinate;
    own[static_cast<std::size_t>(coordinate)] = static_cast<std::size_t>(coordinate) + 1;
    const std::vector<bool> needed = needed_for(description, output);
    std::size_t next = first_own_;
    const auto join = [&](RegisterNumber number) {
      if (is_own(number)) joined_.push_back(own[number] - 1);
    };
    for (std::size_t i = 0; i < description.tick.size(); ++i) {
      if (!needed[i]) continue;
      Instruction instruction = description.tick[i];
      const OperationFacts& known = operation_table[instruction.operation];
      const std::array<RegisterNumber*, 3> operands{&instruction.a, &instruction.b, &instruction.c};
      bool moves = false, owned = false;
      for (int k = 0; k < known.operands; ++k) {
        moves = moves || varies[*operands[k]];
        owned = owned || is_own(*operands[k]);
      }
      if (moves) {
        for (int k = 0; k < known.operands; ++k) join(*operands[k]);
      } else if (owned) {
        for (int k = 0; k < known.operands; ++k)
          if (is_own(*operands[k])) *operands[k] = static_cast<RegisterNumber>(own[*operands[k]] - 1);
      }
      const RegisterNumber destination = instruction.destination;
      for (int k = 0; k < known.results; ++k) {
        varies[destination + k] = moves;
        own[destination + k] = owned && !moves ? next + static_cast<std::size_t>(k) + 1 : 0;
      }
      if (!owned || moves) {
        // A value that depends on neither coordinate is the same on all lines, and is computed with them.
        if (!moves) code_.push_back(instruction);
        continue;
      }
      instruction.destination = static_cast<RegisterNumber>(next);
      next += static_cast<std::size_t>(known.results);
      code_.push_back(instruction);
    }
    join(output);
    registers_ = next;
  }

  /// Whether the registers fit the numbers that instructions have.
  bool fits() const { return registers_ <= register_limit; }

  /// All that the rest of the tick gets from the coordinate, as bits. Equal on two lines: the force is equal on them.
  std::vector<std::uint32_t> joined_at(const Bank& bank, Input coordinate, float value) const {
    std::vector<float> registers(bank.registers().begin(), bank.registers().end());
    registers.resize(registers_);
    for (std::size_t number = 0; number < first_constant; ++number)
      if (input_table[number].changes) registers[number] = 0;  // the hand is at rest
    registers[static_cast<std::size_t>(coordinate)] = value;
    {
      const FloatingPointMode mode;
      run_lane(program_, code_, registers.data(), program_.initial_cells.data());
    }
    std::vector<std::uint32_t> bits;
    for (const std::size_t number : joined_) bits.push_back(std::bit_cast<std::uint32_t>(registers[number]));
    return bits;
  }

 private:
  /// Which instructions of the tick the output depends on.
  static std::vector<bool> needed_for(const PatchProgram& description, RegisterNumber output) {
    std::vector<bool> wanted(description.register_count()), needed(description.tick.size());
    wanted[output] = true;
    for (std::size_t i = description.tick.size(); i-- > 0;) {
      const Instruction& instruction = description.tick[i];
      const OperationFacts& known = operation_table[instruction.operation];
      for (int k = 0; k < known.results; ++k) needed[i] = needed[i] || wanted[instruction.destination + k];
      if (!needed[i]) continue;
      for (int k = 0; k < known.results; ++k) wanted[instruction.destination + k] = false;
      if (known.operands > 0) wanted[instruction.a] = true;
      if (known.operands > 1) wanted[instruction.b] = true;
      if (known.operands > 2) wanted[instruction.c] = true;
    }
    return needed;
  }

  const DecodedProgram& program_;
  std::size_t first_own_ = 0, registers_ = 0;
  std::vector<Instruction> code_;
  std::vector<std::size_t> joined_;
};

/// The lines across `across` on which the force differs, one of each kind.
std::vector<std::size_t> different_lines(const Bank& bank, bool along_x, float across) {
  const DecodedProgram& program = bank.program().decoded();
  const Input coordinate = along_x ? Input::y : Input::x;
  const OneCoordinate beside(bank.program(), coordinate, along_x ? program.force_x : program.force_y);
  std::vector<std::size_t> different;
  std::map<std::vector<std::uint32_t>, std::size_t> known;
  for (std::size_t line = 0; line < lines; ++line)
    if (!beside.fits() ||
        known.try_emplace(beside.joined_at(bank, coordinate, middle(line, lines, across)), line).second)
      different.push_back(line);
  return different;
}

/// J, the largest range of the potential along any line of one direction.
std::optional<double> farthest_along(const Bank& bank, bool along_x, const std::atomic<bool>* stop) {
  const float length = along_x ? bank.size().width : bank.size().height;
  const float across = along_x ? bank.size().height : bank.size().width;
  std::vector<Hand> hands(points);
  std::vector<Force> forces(points);
  const auto component = [&](std::size_t index) -> double { return along_x ? forces[index].x : forces[index].y; };
  const double step = static_cast<double>(length) / points;
  double farthest = 0;
  for (const std::size_t line : different_lines(bank, along_x, across)) {
    if (stop != nullptr && stop->load(std::memory_order_relaxed)) return std::nullopt;
    for (std::size_t point = 0; point < points; ++point) {
      const float along = middle(point, points, length), beside = middle(line, lines, across);
      hands[point].position = along_x ? glm::vec2(along, beside) : glm::vec2(beside, along);
    }
    tick_alone(bank, hands, forces);
    double potential = 0, low = 0, high = 0;
    for (std::size_t point = 1; point < points; ++point) {
      potential -= 0.5 * (component(point - 1) + component(point)) * step;
      low = std::min(low, potential);
      high = std::max(high, potential);
    }
    farthest = std::max(farthest, high - low);
  }
  return farthest;
}

bool is_of_a_shape(Input input) {
  return input == Input::shape_edge || input == Input::shape_edge_x || input == Input::shape_edge_y;
}

/// N along an axis.
double most_force(const Bank& bank) {
  double most = 0;
  for (const Output& output : bank.program().description().outputs)
    most = std::max(most, static_cast<double>(std::abs(bank.registers()[output.ceiling])));
  return most;
}

}  // namespace

double trivial_potential_range(const Bank& bank) {
  const double width = bank.size().width, height = bank.size().height;
  return most_force(bank) * std::hypot(width, height);
}

bool has_sampled_range(const Program& program) {
  const PatchProgram& description = program.description();
  return description.states.empty() && description.grids.empty() &&
         std::ranges::all_of(program.decoded().tick_inputs, [](Input input) {
           return input == Input::x || input == Input::y || input == Input::velocity_x || input == Input::velocity_y ||
                  input == Input::raw_velocity_x || input == Input::raw_velocity_y || is_of_a_shape(input);
         });
}

bool reads_shape_edge(const Program& program) {
  return std::ranges::any_of(program.decoded().tick_inputs, is_of_a_shape);
}

std::optional<double> potential_range(const Bank& bank, const std::atomic<bool>* stop) {
  const double trivial = trivial_potential_range(bank);
  if (!has_sampled_range(bank.program())) return trivial;
  const double width = bank.size().width, height = bank.size().height;
  const double between_lines = most_force(bank) * 0.5 * (width + height) / lines;
  const std::optional<double> along_x = farthest_along(bank, true, stop);
  const std::optional<double> along_y = along_x ? farthest_along(bank, false, stop) : std::nullopt;
  if (!along_y) return std::nullopt;
  return std::min(trivial, *along_x + *along_y + between_lines);
}

double potential_range(const Bank& bank) { return *potential_range(bank, nullptr); }

}  // namespace wale
