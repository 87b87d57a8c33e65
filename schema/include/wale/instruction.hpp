#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string_view>

namespace wale {

/// The operations of a patch program; numbers are those of the file format.
enum class Operation : std::uint8_t {
#define INSTRUCTION(number, name, fields, results, cost, meaning, range, derivative) name = number,
#define SPECIAL(number, name, fields, results, cost) name = number,
#include "wale/instruction.def"
};

/// One row of `instruction.def`.
struct OperationFacts {
  std::string_view name;
  std::string_view fields;  ///< of a, b, c: r register, t table, g grid, p peak, - must be zero
  int results;              ///< consecutive registers written
  int cost;                 ///< in units of one addition
  int operands = 0;         ///< how many of a, b, c are registers; they come first
};

/// The facts of all operations, by number. An unused number has an empty name. In a file that is not verified an operation
/// may have a number beyond the table: `operation_facts` knows.
inline constexpr auto operation_table = [] {
  std::array<OperationFacts, 32> table{};
  // clang-format off
#define INSTRUCTION(number, name, fields, results, cost, meaning, range, derivative) \
  table[number] = {#name, fields, results, cost};
#define SPECIAL(number, name, fields, results, cost) \
  table[number] = {#name, fields, results, cost};
#include "wale/instruction.def"
  // clang-format on
  for (OperationFacts& each : table)
    for (const char field : each.fields) each.operands += field == 'r';
  return table;
}();

/// The facts of an operation number, or null if no operation has that number.
constexpr const OperationFacts* operation_facts(unsigned number) {
  const bool known = number < operation_table.size() && !operation_table[number].name.empty();
  return known ? &operation_table[number] : nullptr;
}

constexpr const OperationFacts& facts(Operation operation) {
  return operation_table[static_cast<std::uint8_t>(operation)];
}

/// A register, table, grid or peak is named by a 14-bit number.
using RegisterNumber = std::uint16_t;
inline constexpr unsigned register_limit = 1u << 14;

/// One instruction: an operation, the first register it writes and three operands.
///
/// `operation` is the number from the file, which may be unknown; in a verified program it is known.
struct Instruction {
  std::uint8_t operation = 0;
  RegisterNumber destination = 0, a = 0, b = 0, c = 0;

  friend bool operator==(const Instruction&, const Instruction&) = default;
};

/// The canonical eight bytes: operation in bits 0-7, then destination, a, b, c in 14 bits each, low to high.
constexpr std::uint64_t encode(const Instruction& i) {
  return std::uint64_t{i.operation} | std::uint64_t{i.destination} << 8 | std::uint64_t{i.a} << 22 |
         std::uint64_t{i.b} << 36 | std::uint64_t{i.c} << 50;
}

constexpr Instruction decode(std::uint64_t word) {
  constexpr std::uint64_t mask = register_limit - 1;
  return {static_cast<std::uint8_t>(word & 0xff), static_cast<RegisterNumber>(word >> 8 & mask),
          static_cast<RegisterNumber>(word >> 22 & mask), static_cast<RegisterNumber>(word >> 36 & mask),
          static_cast<RegisterNumber>(word >> 50 & mask)};
}

/// The registers that the runtime fills before a section runs; numbers never change.
///
/// Position (m), velocity (m/s) and acceleration (m/s^2) are the hand's, from the patch's centre. Velocity and
/// acceleration are filtered as the device declares; the raw ones are plain differences of positions. `workspace_x` and
/// `workspace_y` are the hand's position from the workspace's centre, m. `time` is in s since the stage began to run,
/// `seconds_per_tick` is the device's period, `button` is 1 while it is pressed and else 0. `probe` is the size of the
/// carrier whose feel a percept's prediction is asked for (for roughness, a lateral amplitude in N). `shape_edge` is
/// the hand's distance to the edge of the patch's own shape, m, and the other two are its change along x and y, from -1
/// to
/// 1. All three are 0 on a patch that is a rectangle: its edges follow from its size.
enum class Input : RegisterNumber {
  x = 0,
  y = 1,
  velocity_x = 2,
  velocity_y = 3,
  patch_half_width = 4,
  patch_half_height = 5,
  patch_rim = 6,
  probe = 7,
  acceleration_x = 8,
  acceleration_y = 9,
  raw_velocity_x = 10,
  raw_velocity_y = 11,
  raw_acceleration_x = 12,
  raw_acceleration_y = 13,
  workspace_x = 14,
  workspace_y = 15,
  time = 16,
  button = 17,
  seconds_per_tick = 18,
  shape_edge = 19,
  shape_edge_x = 20,
  shape_edge_y = 21,
};

/// Registers 0 .. 31 are inputs, named or reserved; constants begin at 32.
inline constexpr RegisterNumber first_constant = 32;

/// When an input changes, and which code may read it.
struct InputFacts {
  bool changes = false;     ///< it changes from tick to tick; otherwise the bank or a prediction sets it once
  bool setup = false;       ///< setup and the extents of peaks may read it
  bool picture = false;     ///< picture code and peaks may read it
  bool tick = false;        ///< tick, enter and frame code may read it
  bool prediction = false;  ///< a percept's prediction may read it
};

/// The facts of all inputs, by number. No code may read a reserved one.
inline constexpr auto input_table = [] {
  std::array<InputFacts, first_constant> table{};
  const auto at = [&table](Input input) -> InputFacts& { return table[static_cast<RegisterNumber>(input)]; };
  for (const Input place : {Input::x, Input::y, Input::shape_edge, Input::shape_edge_x, Input::shape_edge_y})
    at(place) = {.changes = true, .picture = true, .tick = true};
  for (const Input motion :
       {Input::velocity_x, Input::velocity_y, Input::acceleration_x, Input::acceleration_y, Input::raw_velocity_x,
        Input::raw_velocity_y, Input::raw_acceleration_x, Input::raw_acceleration_y, Input::workspace_x,
        Input::workspace_y, Input::time, Input::button})
    at(motion) = {.changes = true, .tick = true};
  for (const Input patch :
       {Input::patch_half_width, Input::patch_half_height, Input::patch_rim, Input::seconds_per_tick})
    at(patch) = {.setup = true, .picture = true, .tick = true, .prediction = true};
  at(Input::probe) = {.prediction = true};
  return table;
}();

/// How many inputs change from tick to tick.
inline constexpr std::size_t changing_inputs = [] {
  std::size_t count = 0;
  for (const InputFacts& input : input_table) count += input.changes;
  return count;
}();

}  // namespace wale
