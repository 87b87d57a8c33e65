#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

/// WORKSPACE_FILE.md.
namespace wale::workspace_format {

/// As in PNG: a byte that no text has, the name, then line ends and an end-of-file mark, which a text transfer changes.
inline constexpr std::array<std::uint8_t, 8> magic = {0x89, 'W', 'W', 'S', '\r', '\n', 0x1a, '\n'};
inline constexpr std::uint32_t version = 1;
inline constexpr std::size_t header_size = 24;

inline constexpr std::uint32_t no_shape = 0xffffffffu;
/// The bits of a mark's flags.
inline constexpr std::uint8_t mark_of_percept = 1, mark_has_low = 2, mark_has_high = 4;

/// Cells of all masks of a file. It bounds the memory that a malformed file can ask for: a cell takes 6 bytes.
inline constexpr std::size_t most_mask_cells = std::size_t{1} << 27;
/// It bounds the memory that a malformed file can ask for. A patch has 4 MB at most.
inline constexpr std::size_t most_programs = 4096;

}  // namespace wale::workspace_format
