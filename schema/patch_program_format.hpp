#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

#include "wale/patch_program.hpp"

/// What the reader and the writer of `.wpp` files agree on; the prose is schema/PATCH_PROGRAM.md.
namespace wale::patch_program_format {

/// As in PNG: a byte that no text has, the name, then line ends and an end-of-file mark, which text transfers change.
inline constexpr std::array<std::uint8_t, 8> magic = {0x89, 'W', 'P', 'P', '\r', '\n', 0x1a, '\n'};
inline constexpr std::uint16_t major_version = 1;
inline constexpr std::uint16_t minor_version = 2;

inline constexpr std::size_t header_size = 32;
inline constexpr std::size_t checksum_offset = 24;
inline constexpr std::size_t section_entry_size = 24;
inline constexpr std::size_t alignment = 8;

inline constexpr std::uint32_t required_flag = 1;

/// More than any program has; the table stays short.
inline constexpr std::uint32_t most_sections = 256;
/// Bytes; the longest text of a file, a layer's source included.
inline constexpr std::uint32_t longest_text = 1u << 20;

struct SectionKind {
  std::string_view name;  ///< four characters
  bool required;          ///< its flag: a reader that does not know the section must not run the program
  bool always;            ///< every file has it; other sections are left out if they would be empty
};

/// Known sections in the order in which they stand in a file.
inline constexpr std::array<SectionKind, 22> section_kinds = {
    {{"NAME", true, true},   {"REGS", true, true},   {"CONS", true, true},   {"PARM", true, true},
     {"SETU", true, true},   {"PEAK", true, true},   {"STAT", true, false},  {"GRID", true, false},
     {"TICK", true, true},   {"OUTP", true, true},   {"PICT", true, true},   {"FRAM", false, false},
     {"TABL", true, true},   {"PTCH", true, true},   {"DEVI", true, true},   {"VIBR", true, false},
     {"PERC", false, false}, {"EVID", false, false}, {"FATE", false, false}, {"CLAI", false, false},
     {"LAYR", false, false}, {"PLAC", false, false}}};

constexpr std::size_t align(std::size_t size) { return (size + alignment - 1) / alignment * alignment; }

/// A section of code.
struct CodeAt {
  CodeSection section = CodeSection::setup;
  std::size_t index = 0;
};

/// All sections of a program's code in the order in which their places are listed.
std::vector<CodeAt> code_of(const PatchProgram& program);

/// CRC-32 (IEEE 802.3, as in PNG and zlib) of a whole file; its checksum field counts as zero.
/// `file` is at least as long as a header.
std::uint32_t checksum(std::span<const std::byte> file);

/// FNV-1a, 64 bits, over the width, the height and the codes, in the bytes of the file.
std::uint64_t content_hash(const HeightTable& table);

}  // namespace wale::patch_program_format
