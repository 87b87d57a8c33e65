#pragma once

#include <optional>
#include <string>

#include "schema/patch_program.hpp"

namespace wale {

/// Most that one tick may cost, as a fraction of the device's period, at one nanosecond a unit: room for a cold
/// cache, a machine several times slower and the runtime's own work.
inline constexpr double tick_share_of_period = 0.25;
/// Most that setup and its peaks may cost together, in units: about a second on the control thread.
inline constexpr double setup_cost_limit = 1e9;
/// Most points a peak may look at.
inline constexpr std::uint32_t peak_points_limit = 1u << 20;
/// Samples a side of a table.
inline constexpr std::uint32_t table_side_least = 2, table_side_most = 16384;
/// Most that a program may remember: states, grids, cells a side of a grid and in all grids together.
inline constexpr std::size_t states_limit = 512, grids_limit = 16;
inline constexpr std::uint32_t grid_side_limit = 1024;
inline constexpr std::size_t cells_limit = std::size_t{1} << 20;
/// Most grid writes of a tick and marks of a picture.
inline constexpr std::size_t writes_limit = 16, marks_limit = 1024;

/// Most instructions that a refusal shows.
inline constexpr std::size_t shown_instructions = 5;

/// Why a program may not run, or nothing when it may. The rules are listed in schema/PATCH_PROGRAM.md. A refusal of
/// code shows the instructions that led to it, at most `shown_instructions`, with the lines that they come from where
/// the program carries them.
///
/// A program that passes stops in time, reads nothing that is not defined, remembers a bounded amount, and commands no
/// force beyond its ceilings, whatever its registers hold. Takes time and memory in proportion to the program.
std::optional<Refusal> verify(const PatchProgram& program);

/// A refusal in several lines: its reason, then the instructions that led to it, one a line.
std::string explained(const Refusal& refusal);

}  // namespace wale
