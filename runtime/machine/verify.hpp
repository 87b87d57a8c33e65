#pragma once

#include <cstdint>

#include "wale/patch_program.hpp"

namespace wale {

/// Most that one tick may cost, as a fraction of the device's period, at one nanosecond a unit. The rest is for a cold
/// cache, a machine several times slower and the runtime's own work.
inline constexpr double tick_share_of_period = 0.25;
/// Most that setup and its peaks may cost together, in units: about a second on the control thread.
inline constexpr std::uint64_t setup_cost_limit = 1'000'000'000;
/// Most points of a peak.
inline constexpr std::uint32_t peak_points_limit = 1u << 20;
/// Samples per side of a table.
inline constexpr std::uint32_t table_side_least = 2, table_side_most = 16384;
/// Most that a program may remember: states, grids, cells per side of a grid, and cells in all grids together.
inline constexpr std::size_t states_limit = 512, grids_limit = 16;
inline constexpr std::uint32_t grid_side_limit = 1024;
inline constexpr std::size_t cells_limit = std::size_t{1} << 20;
/// Most grid writes of a tick and marks of a picture.
inline constexpr std::size_t writes_limit = 16, marks_limit = 1024;

/// Most instructions that an error shows.
inline constexpr std::size_t shown_instructions = 5;

/// Checks that a program may run. schema/PATCH_PROGRAM.md lists the rules.
///
/// A program that passes ends in time, reads only defined registers, has a bounded memory, and for all contents of its
/// registers commands no force beyond its ceilings. The check takes time and memory in proportion to the program's
/// size. From any thread.
///
/// Error: `refused_program`. If an instruction breaks a rule, `place` is that instruction (its section, its number from
/// 0, its text, and its line of Wale if the program records it). `led_to` has that instruction and those that its
/// operands come from, in the order in which they run, at most `shown_instructions`.
Result<> verify(const PatchProgram& program);

}  // namespace wale
