#include "wale/patch_program.hpp"

#include "schema/fnv1a.hpp"
#include "schema/patch_program_format.hpp"

namespace wale {

long cost_of(std::span<const Instruction> code) {
  long cost = 0;
  for (const Instruction& instruction : code)
    if (const OperationFacts* known = operation_facts(instruction.operation)) cost += known->cost;
  return cost;
}

const std::vector<Instruction>& PatchProgram::code(CodeSection section, std::size_t index) const {
  switch (section) {
    case CodeSection::setup: return setup;
    case CodeSection::peak: return peaks[index].code;
    case CodeSection::enter: return enter;
    case CodeSection::tick: return tick;
    case CodeSection::picture: return picture.code;
    case CodeSection::frame: return picture.frame;
    case CodeSection::prediction: return percepts[index].prediction;
  }
  return setup;
}

std::optional<SourceLine> PatchProgram::place_of(CodeSection section, std::size_t index,
                                                 std::size_t instruction) const {
  // Each kind of section occurs once, except peaks, which come second, and predictions, which come last.
  std::size_t number = static_cast<std::size_t>(section) + index;
  if (section > CodeSection::peak) number += peaks.size() - 1;
  if (number >= places.sections.size()) return std::nullopt;
  for (const SourcePlaces::Run& run : places.sections[number]) {
    if (instruction < run.instructions) {
      if (run.file >= places.files.size()) return std::nullopt;
      return SourceLine{places.files[run.file], run.line};
    }
    instruction -= run.instructions;
  }
  return std::nullopt;
}

namespace patch_program_format {

std::vector<CodeAt> code_of(const PatchProgram& program) {
  std::vector<CodeAt> all{{CodeSection::setup, 0}};
  for (std::size_t i = 0; i < program.peaks.size(); ++i) all.push_back({CodeSection::peak, i});
  for (const CodeSection one : {CodeSection::enter, CodeSection::tick, CodeSection::picture, CodeSection::frame}) {
    all.push_back({one, 0});
  }
  for (std::size_t i = 0; i < program.percepts.size(); ++i) all.push_back({CodeSection::prediction, i});
  return all;
}

namespace {

constexpr std::array<std::uint32_t, 256> make_crc_table() {
  std::array<std::uint32_t, 256> table{};
  for (std::uint32_t byte = 0; byte < 256; ++byte) {
    std::uint32_t remainder = byte;
    for (int bit = 0; bit < 8; ++bit) remainder = remainder >> 1 ^ (remainder & 1 ? 0xedb88320u : 0);
    table[byte] = remainder;
  }
  return table;
}

constexpr auto crc_table = make_crc_table();

}  // namespace

std::uint32_t checksum(std::span<const std::byte> file) {
  std::uint32_t crc = 0xffffffffu;
  for (std::size_t i = 0; i < file.size(); ++i) {
    const bool in_field = i >= checksum_offset && i < checksum_offset + 4;
    const auto byte = in_field ? 0u : std::to_integer<std::uint32_t>(file[i]);
    crc = crc >> 8 ^ crc_table[(crc ^ byte) & 0xff];
  }
  return ~crc;
}

std::uint64_t content_hash(const HeightTable& table) {
  Fnv1a<std::uint64_t> hash;
  const auto take = [&hash](std::uint64_t value, int bytes) {
    for (int i = 0; i < bytes; ++i) hash.take(static_cast<std::uint8_t>(value >> 8 * i));
  };
  take(table.width, 4);
  take(table.height, 4);
  for (const std::uint16_t code : table.heights) take(code, 2);
  return hash.hash();
}

}  // namespace patch_program_format
}  // namespace wale
