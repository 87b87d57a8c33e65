#include "schema/byte_writer.hpp"
#include "schema/patch_program_format.hpp"
#include "schema/write_device.hpp"

namespace wale {
namespace {

using namespace patch_program_format;

void write_parameters(ByteWriter& out, std::span<const Parameter> parameters) {
  out.u32(parameters.size());
  for (const Parameter& parameter : parameters) {
    out.text(parameter.name);
    out.text(parameter.unit);
    out.f64(parameter.unit_in_si);
    out.text(parameter.si_unit);
    out.f32(parameter.value);
    out.f32(parameter.low);
    out.f32(parameter.high);
    out.f32(parameter.soft_low);
    out.f32(parameter.soft_high);
    out.text(parameter.description);
  }
}

void write_peaks(ByteWriter& out, std::span<const Peak> peaks) {
  out.u32(peaks.size());
  for (const Peak& peak : peaks) {
    out.u16(peak.value);
    out.u16(peak.half_width);
    out.u16(peak.half_height);
    out.u32(peak.points);
    out.f32(peak.percentile);
    out.code(peak.code);
  }
}

void write_states(ByteWriter& out, const PatchProgram& program) {
  out.u32(program.states.size());
  for (const State& state : program.states) {
    out.text(state.name);
    out.text(state.si_unit);
    out.f32(state.low);
    out.f32(state.high);
    out.u16(state.initial);
    out.u16(state.next);
  }
  out.code(program.enter);
}

void write_grids(ByteWriter& out, const PatchProgram& program) {
  out.u32(program.grids.size());
  for (const Grid& grid : program.grids) {
    out.text(grid.name);
    out.text(grid.si_unit);
    out.u32(grid.columns);
    out.u32(grid.rows);
    out.f32(grid.initial);
    out.f32(grid.low);
    out.f32(grid.high);
  }
  out.u32(program.writes.size());
  for (const GridWrite& write : program.writes) {
    out.u16(write.grid);
    out.u16(write.u);
    out.u16(write.v);
    out.u16(write.value);
  }
}

void write_picture(ByteWriter& out, const Picture& picture) {
  out.u16(picture.relief);
  out.u8(picture.relief_is_length);
  out.u8(picture.colour.has_value());
  for (const RegisterNumber number : picture.colour.value_or(std::array<RegisterNumber, 3>{})) out.u16(number);
  out.code(picture.code);
}

void write_frame(ByteWriter& out, const Picture& picture) {
  out.code(picture.frame);
  out.u32(picture.marks.size());
  for (const Mark& mark : picture.marks) {
    out.u8(static_cast<std::uint8_t>(mark.kind));
    out.u32(mark.colour);
    for (std::size_t i = 0; i < mark_operands(mark.kind); ++i) out.u16(mark.operands[i]);
  }
}

void write_outputs(ByteWriter& out, std::span<const Output> outputs) {
  out.u32(outputs.size());
  for (const Output& output : outputs) {
    out.u8(static_cast<std::uint8_t>(output.quantity));
    out.u8(output.axis);
    out.u16(output.value);
    out.u16(output.ceiling);
  }
}

void write_tables(ByteWriter& out, std::span<const HeightTable> tables) {
  out.u32(tables.size());
  for (const HeightTable& table : tables) {
    out.u32(table.width);
    out.u32(table.height);
    out.u64(content_hash(table));
    for (const std::uint16_t code : table.heights) out.u16(code);
  }
}

void write_fates(ByteWriter& out, std::span<const FateRecord> fates) {
  out.u32(fates.size());
  for (const FateRecord& fate : fates) {
    out.text(fate.name);
    out.u8(fate.percept);
    out.u8(static_cast<std::uint8_t>(fate.fate));
    out.f32(fate.asked);
    out.f32(fate.given);
    out.text(fate.reason);
  }
}

void write_claims(ByteWriter& out, std::span<const LevelClaim> claims) {
  out.u32(claims.size());
  for (const LevelClaim& claim : claims) {
    out.text(claim.percept);
    out.u8(static_cast<std::uint8_t>(claim.evidence));
  }
}

void write_bases(ByteWriter& out, std::span<const PerceptRecord> percepts) {
  out.u32(percepts.size());
  for (const PerceptRecord& percept : percepts) {
    const Basis& basis = percept.basis;
    out.f32(basis.share);
    out.f32(basis.tolerance);
    const LawUncertainty& law = percept.uncertainty;
    for (const float figure : {law.slope_error, law.noise}) out.f32(figure);
    out.u16(law.stimuli);
    for (const bool answer :
         {basis.summand, basis.valid_assumed, law.scatter_assumed, law.spread_assumed, law.noise_assumed})
      out.u8(answer);
    out.u8(basis.domain.stated);
    out.u8(basis.domain.profiles);
    out.u8(basis.domain.dimensions);
    out.u8(basis.domain.alone);
    out.f32(basis.domain.crest_low);
    out.f32(basis.domain.crest_high);
    out.u8(basis.domain.crest_assumed);
    out.u32(basis.ranges.size());
    for (const MeasuredRange& range : basis.ranges) {
      out.text(range.quantity);
      out.f32(range.low);
      out.f32(range.high);
      out.text(range.unit);
      out.f64(range.unit_in_si);
      out.u8(range.assumed);
    }
  }
}

void write_percepts(ByteWriter& out, std::span<const PerceptRecord> percepts) {
  out.u32(percepts.size());
  for (const PerceptRecord& percept : percepts) {
    out.text(percept.name);
    out.text(percept.carrier);
    out.u8(percept.parameter ? 1 : percept.blended ? 2 : 0);
    out.u16(percept.parameter.value_or(0));
    out.u16(percept.amplitude);
    out.u8(percept.alone);
    out.code(percept.prediction);
    out.u16(percept.magnitude);
    out.u16(percept.level);
    out.f32(percept.valid_low);
    out.f32(percept.valid_high);
    out.f32(percept.uncertainty.scatter);
    out.u8(static_cast<std::uint8_t>(percept.slope));
    out.u8(static_cast<std::uint8_t>(percept.anchor));
    out.u8(static_cast<std::uint8_t>(percept.handle));
    out.text(percept.map);
    out.text(percept.device);
    out.text(percept.source);
    out.text(percept.unit);
    out.u8(static_cast<std::uint8_t>(percept.extractor));
    for (const float figure : {percept.period_low, percept.period_high, percept.one, percept.near_threshold,
                               percept.uncertainty.spread, percept.weber, percept.floor})
      out.f32(figure);
    out.u16(percept.uncertainty.observers);
    out.u8(static_cast<std::uint8_t>(percept.weber_evidence));
    out.text(percept.weber_source);
    out.text(percept.realisation);
  }
}

void write_layers(ByteWriter& out, const Layers& layers) {
  out.u32(layers.representative.size());
  for (const auto& [key, values] : layers.representative) {
    out.text(key);
    out.u32(values.size());
    for (const std::string& value : values) out.text(value);
  }
  out.text(layers.perceptual);
  out.text(layers.physical);
  out.text(layers.documentation);
}

void write_places(ByteWriter& out, const SourcePlaces& places) {
  out.u32(places.files.size());
  for (const std::string& file : places.files) out.text(file);
  for (const auto& runs : places.sections) {
    out.u32(runs.size());
    for (const SourcePlaces::Run& run : runs) {
      out.u32(run.instructions);
      out.u16(run.file);
      out.u32(run.line);
    }
  }
}

/// The bytes of one section; empty for one that may be left out and would be empty.
std::vector<std::byte> write_section(std::string_view kind, const PatchProgram& program) {
  ByteWriter out;
  if (kind == "NAME") out.text(program.material);
  if (kind == "REGS") {
    out.u16(program.setup_registers);
    out.u16(program.temporaries);
  }
  if (kind == "CONS") {
    out.u32(program.constants.size());
    for (const float constant : program.constants) out.f32(constant);
  }
  if (kind == "PARM") write_parameters(out, program.parameters);
  if (kind == "SETU") out.code(program.setup);
  if (kind == "PEAK") write_peaks(out, program.peaks);
  if (kind == "STAT" && !(program.states.empty() && program.enter.empty())) write_states(out, program);
  if (kind == "GRID" && !(program.grids.empty() && program.writes.empty())) write_grids(out, program);
  if (kind == "TICK") out.code(program.tick);
  if (kind == "OUTP") write_outputs(out, program.outputs);
  if (kind == "PICT") write_picture(out, program.picture);
  if (kind == "FRAM" && !(program.picture.frame.empty() && program.picture.marks.empty())) {
    write_frame(out, program.picture);
  }
  if (kind == "TABL") write_tables(out, program.tables);
  if (kind == "PTCH") {
    out.f32(program.patch_width);
    out.f32(program.patch_height);
    out.f32(program.patch_rim);
    out.f32(program.active_watt);
  }
  if (kind == "DEVI") write_device(out, program.device);
  if (kind == "VIBR" && program.device.shaker) write_shaker(out, *program.device.shaker);
  if (kind == "PERC" && !program.percepts.empty()) write_percepts(out, program.percepts);
  if (kind == "EVID" && !program.percepts.empty()) write_bases(out, program.percepts);
  if (kind == "FATE" && !program.fates.empty()) write_fates(out, program.fates);
  if (kind == "CLAI" && !program.claims.empty()) write_claims(out, program.claims);
  if (kind == "LAYR" && program.layers != Layers{}) write_layers(out, program.layers);
  if (kind == "PLAC" && program.places != SourcePlaces{}) write_places(out, program.places);
  return std::move(out.result());
}

}  // namespace

std::vector<std::byte> write_patch_program(const PatchProgram& program) {
  struct Section {
    SectionKind kind;
    std::vector<std::byte> bytes;
  };
  std::vector<Section> sections;
  for (const SectionKind& kind : section_kinds) {
    std::vector<std::byte> bytes = write_section(kind.name, program);
    if (kind.always || !bytes.empty()) sections.push_back({kind, std::move(bytes)});
  }
  std::size_t total = header_size + sections.size() * section_entry_size;
  for (const Section& section : sections) total += align(section.bytes.size());

  ByteWriter out;
  out.result().reserve(total);
  for (const std::uint8_t byte : magic) out.u8(byte);
  out.u16(major_version);
  out.u16(minor_version);
  out.u32(sections.size());
  out.u64(total);
  out.u32(0);  // the checksum, below
  out.u32(0);  // reserved

  std::size_t offset = header_size + sections.size() * section_entry_size;
  for (const Section& section : sections) {
    for (const char c : section.kind.name) out.u8(static_cast<std::uint8_t>(c));
    out.u32(section.kind.required ? required_flag : 0);
    out.u64(offset);
    out.u64(section.bytes.size());
    offset += align(section.bytes.size());
  }
  for (const Section& section : sections) {
    out.bytes(section.bytes);
    out.pad();
  }

  std::vector<std::byte>& file = out.result();
  const std::uint32_t crc = checksum(file);
  for (std::size_t i = 0; i < 4; ++i) file[checksum_offset + i] = static_cast<std::byte>(crc >> 8 * i & 0xff);
  return std::move(file);
}

}  // namespace wale
