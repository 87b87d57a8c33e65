#include <algorithm>

#include "schema/byte_reader.hpp"
#include "schema/patch_program_format.hpp"
#include "schema/read_device.hpp"
#include "schema/read_sections.hpp"
#include "schema/sentence.hpp"

namespace wale {
namespace {

using namespace patch_program_format;

void read_section(std::string_view kind, ByteReader& in, PatchProgram& program) {
  if (kind == "NAME") program.material = in.text("the material's name");
  if (kind == "REGS") {
    program.setup_registers = in.u16();
    program.temporaries = in.u16();
  }
  if (kind == "CONS") program.constants = read_constants(in);
  if (kind == "PARM") program.parameters = read_parameters(in);
  if (kind == "SETU") program.setup = in.code();
  if (kind == "PEAK") program.peaks = read_peaks(in);
  if (kind == "STAT") read_states(in, program);
  if (kind == "GRID") read_grids(in, program);
  if (kind == "TICK") program.tick = in.code();
  if (kind == "OUTP") program.outputs = read_outputs(in);
  if (kind == "PICT") read_picture(in, program.picture);
  if (kind == "FRAM") read_frame(in, program.picture);
  if (kind == "TABL") program.tables = read_tables(in);
  if (kind == "PTCH") {
    program.patch_width = in.finite_f32("the patch's width");
    program.patch_height = in.finite_f32("the patch's height");
    program.patch_rim = in.finite_f32("the patch's rim");
    program.active_watt = in.finite_f32("the power of active programs");
  }
  if (kind == "DEVI") program.device = read_device(in);
  if (kind == "VIBR") program.device.shaker = read_shaker(in);
  if (kind == "PERC") program.percepts = read_percepts(in);
  if (kind == "EVID") read_bases(in, program.percepts);
  if (kind == "FATE") program.fates = read_fates(in);
  if (kind == "CLAI") program.claims = read_claims(in);
  if (kind == "LAYR") program.layers = read_layers(in);
  if (kind == "PLAC") program.places = read_places(in, program);
  in.finish();
}

/// Fails for a file that is no patch program, or one that a transfer as text changed.
[[noreturn]] void fail_at_magic(std::span<const std::byte> bytes) {
  const bool named = bytes.size() >= 4 && std::to_integer<int>(bytes[1]) == 'W' &&
                     std::to_integer<int>(bytes[2]) == 'P' && std::to_integer<int>(bytes[3]) == 'P';
  if (!named) damaged("this is not a patch program: its first bytes are not those of a .wpp file");
  throw Error{.code = Code::damaged_file,
              .sentence = "a transfer as text has damaged this patch program",
              .mend = "copy it as binary"};
}

[[noreturn]] void fail_as_newer(std::uint16_t major, std::uint16_t minor) {
  throw Error{.code = Code::newer_file,
              .sentence = sentence("this patch program has format version ", major, ".", minor,
                                   ", but this Wale reads only up to ", major_version),
              .mend = "update Wale, or build the material again with this one"};
}

/// Checks everything before the section table and leaves `in` there. Returns the number of sections.
std::uint32_t read_header(ByteReader& in, std::span<const std::byte> bytes) {
  for (const std::uint8_t expected : magic) {
    if (in.remaining() == 0 || in.u8() != expected) fail_at_magic(bytes);
  }
  if (bytes.size() < header_size) {
    damaged("the file ends inside its header, after ", bytes.size(), " of ", header_size, " bytes");
  }
  const std::uint16_t major = in.u16();
  const std::uint16_t minor = in.u16();
  if (major > major_version) fail_as_newer(major, minor);
  if (major == 0) damaged("this patch program claims format version 0, which never existed");
  const std::uint32_t sections = in.u32();
  const std::uint64_t total = in.u64();
  if (total > bytes.size()) {
    damaged("the file is cut short: expected ", total, " bytes, found ", bytes.size());
  }
  if (total < bytes.size()) {
    damaged("the file has ", bytes.size() - total, " bytes after its end at ", total);
  }
  const std::uint32_t stored = in.u32();
  if (stored != checksum(bytes)) damaged("the file is damaged: its checksum does not match its bytes");
  if (in.u32() != 0) damaged("the reserved part of the header is not zero");
  if (sections > most_sections || sections > in.remaining() / section_entry_size) {
    damaged("the header claims ", sections, " sections, more than the file has room for");
  }
  return sections;
}

/// A section's kind as text, with question marks for bytes that cannot be printed.
std::string shown_kind(std::uint32_t fourcc) {
  std::string kind;
  for (int i = 0; i < 4; ++i) {
    const auto c = static_cast<char>(fourcc >> 8 * i & 0xff);
    kind += c > ' ' && c <= '~' ? c : '?';
  }
  return kind;
}

/// A row of the section table.
struct SectionEntry {
  std::string kind;
  std::uint32_t flags = 0;
  std::uint64_t offset = 0, size = 0;
};

/// Reads the next row. Its section must begin at `expected_offset`, where the previous one ends; `expected_offset` then
/// moves to the end of this one.
SectionEntry read_entry(ByteReader& table, std::span<const std::byte> bytes, std::size_t& expected_offset) {
  SectionEntry entry;
  entry.kind = shown_kind(table.u32());
  entry.flags = table.u32();
  entry.offset = table.u64();
  entry.size = table.u64();
  const auto& [kind, flags, offset, size] = entry;
  if (offset > bytes.size() || size > bytes.size() - offset) {
    damaged("section ", kind, " claims ", size, " bytes at ", offset, ", but the file has only ", bytes.size());
  }
  if (offset < expected_offset) damaged("section ", kind, " at ", offset, " overlaps the bytes before it");
  if (offset > expected_offset) {
    damaged("section ", kind, " at ", offset, " leaves a gap of ", offset - expected_offset, " bytes before it");
  }
  expected_offset = align(offset + size);
  if (expected_offset > bytes.size()) damaged("section ", kind, " lacks the zeros that fill its last 8 bytes");
  for (std::size_t i = offset + size; i < expected_offset; ++i) {
    if (bytes[i] != std::byte{0}) damaged("section ", kind, " is followed by bytes that are not zero");
  }
  if ((flags & ~required_flag) != 0) damaged("section ", kind, " has flags that this Wale does not know");
  return entry;
}

/// Remembers which sections have been read, and checks that each comes once, in order and with the right flag.
class SectionOrder {
 public:
  /// Whether this Wale knows the section. A section that it does not know can be skipped; if the file requires it, this
  /// fails with `newer_file`.
  bool accept(const SectionEntry& entry) {
    const std::string& kind = entry.kind;
    const bool required = (entry.flags & required_flag) != 0;
    const auto known =
        std::find_if(section_kinds.begin(), section_kinds.end(), [&](const SectionKind& k) { return k.name == kind; });
    if (known == section_kinds.end()) {
      if (required) {
        throw Error{.code = Code::newer_file,
                    .sentence = "this program needs section " + kind + ", which this Wale does not know",
                    .mend = "update Wale"};
      }
      return false;
    }
    const auto index = static_cast<std::size_t>(known - section_kinds.begin());
    if (seen_[index]) damaged("section ", kind, " occurs twice");
    if (index < next_)
      damaged("section ", kind, " comes after ", section_kinds[next_ - 1].name, ", expected before it");
    if (required != known->required) {
      damaged("section ", kind, " is marked as ",
              required ? "required, expected skippable" : "skippable, expected required");
    }
    seen_[index] = true;
    next_ = index + 1;
    return true;
  }

  void require_all() const {
    for (std::size_t i = 0; i < section_kinds.size(); ++i) {
      if (section_kinds[i].always && !seen_[i]) damaged("section ", section_kinds[i].name, " is missing");
    }
  }

 private:
  std::array<bool, section_kinds.size()> seen_{};
  std::size_t next_ = 0;
};

PatchProgram program_in(std::span<const std::byte> bytes) {
  ByteReader table("the section table", bytes);
  const std::uint32_t sections = read_header(table, bytes);
  PatchProgram program;
  SectionOrder order;
  std::size_t expected_offset = header_size + sections * section_entry_size;
  for (std::uint32_t number = 0; number < sections; ++number) {
    const SectionEntry entry = read_entry(table, bytes, expected_offset);
    if (!order.accept(entry)) continue;
    if (entry.kind == "PLAC") order.require_all();  // places are checked against the code
    ByteReader section("section " + entry.kind, bytes.subspan(entry.offset, entry.size));
    read_section(entry.kind, section, program);
  }
  if (expected_offset != bytes.size()) {
    damaged("the file has ", bytes.size() - expected_offset, " bytes after its last section");
  }
  order.require_all();
  return program;
}

}  // namespace

Result<PatchProgram> read_patch_program(std::span<const std::byte> bytes) {
  try {
    return program_in(bytes);
  } catch (const Error& error) {
    return error;
  }
}

}  // namespace wale
