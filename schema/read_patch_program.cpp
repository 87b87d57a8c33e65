#include <algorithm>

#include "schema/byte_reader.hpp"
#include "schema/patch_program_format.hpp"
#include "schema/read_device.hpp"
#include "schema/sentence.hpp"

namespace wale {
namespace {

using namespace patch_program_format;

std::vector<float> read_constants(ByteReader& in) {
  std::vector<float> constants(in.count(4, "constants"));
  for (float& constant : constants) constant = in.f32();
  return constants;
}

std::vector<Parameter> read_parameters(ByteReader& in) {
  std::vector<Parameter> parameters(in.count(44, "parameters"));
  for (Parameter& parameter : parameters) {
    parameter.name = in.text("a parameter's name");
    parameter.unit = in.text("a parameter's unit");
    parameter.unit_in_si = in.finite_f64("a parameter's unit");
    parameter.si_unit = in.text("a parameter's SI unit");
    parameter.value = in.finite_f32("a parameter's default");
    parameter.low = in.finite_f32("a parameter's range");
    parameter.high = in.finite_f32("a parameter's range");
    parameter.soft_low = in.finite_f32("a parameter's usual range");
    parameter.soft_high = in.finite_f32("a parameter's usual range");
    parameter.description = in.text("a parameter's description");
  }
  return parameters;
}

std::vector<Peak> read_peaks(ByteReader& in) {
  std::vector<Peak> peaks(in.count(18, "peaks"));
  for (Peak& peak : peaks) {
    peak.value = in.u16();
    peak.half_width = in.u16();
    peak.half_height = in.u16();
    peak.points = in.u32();
    peak.percentile = in.finite_f32("a peak's percentile");
    peak.code = in.code();
  }
  return peaks;
}

void read_states(ByteReader& in, PatchProgram& program) {
  program.states.resize(in.count(20, "states"));
  for (State& state : program.states) {
    state.name = in.text("a state's name");
    state.si_unit = in.text("a state's unit");
    state.low = in.finite_f32("a state's range");
    state.high = in.finite_f32("a state's range");
    state.initial = in.u16();
    state.next = in.u16();
  }
  program.enter = in.code();
  if (program.states.empty() && program.enter.empty()) {
    in.damaged(" is empty; a file without states leaves it out");
  }
}

void read_grids(ByteReader& in, PatchProgram& program) {
  program.grids.resize(in.count(28, "grids"));
  for (Grid& grid : program.grids) {
    grid.name = in.text("a grid's name");
    grid.si_unit = in.text("a grid's unit");
    grid.columns = in.u32();
    grid.rows = in.u32();
    grid.initial = in.finite_f32("a grid's initial value");
    grid.low = in.finite_f32("a grid's range");
    grid.high = in.finite_f32("a grid's range");
  }
  program.writes.resize(in.count(8, "writes"));
  for (GridWrite& write : program.writes) {
    write.grid = in.u16();
    write.u = in.u16();
    write.v = in.u16();
    write.value = in.u16();
  }
  if (program.grids.empty() && program.writes.empty()) {
    in.damaged(" is empty; a file without grids leaves it out");
  }
}

void read_picture(ByteReader& in, Picture& picture) {
  picture.relief = in.u16();
  picture.relief_is_length = in.boolean("whether the relief is a length");
  const bool coloured = in.boolean("whether the surface is coloured");
  std::array<RegisterNumber, 3> colour{};
  for (RegisterNumber& number : colour) number = in.u16();
  if (coloured) picture.colour = colour;
  if (!coloured && colour != std::array<RegisterNumber, 3>{}) {
    in.damaged(" names registers for a colour, but says that the surface has none");
  }
  picture.code = in.code();
}

void read_frame(ByteReader& in, Picture& picture) {
  picture.frame = in.code();
  picture.marks.resize(in.count(11, "marks"));
  for (Mark& mark : picture.marks) {
    const std::uint8_t kind = in.u8();
    mark.kind = static_cast<MarkKind>(kind);
    if (mark_operands(mark.kind) == 0) {
      in.damaged(" has a mark of kind ", int{kind}, ", which this Wale does not know");
    }
    mark.colour = in.u32();
    for (std::size_t i = 0; i < mark_operands(mark.kind); ++i) mark.operands[i] = in.u16();
  }
  if (picture.frame.empty() && picture.marks.empty()) {
    in.damaged(" is empty; a file without marks leaves it out");
  }
}

std::vector<Output> read_outputs(ByteReader& in) {
  std::vector<Output> outputs(in.count(6, "outputs"));
  for (Output& output : outputs) {
    const std::uint8_t quantity = in.u8();
    if (quantity < static_cast<std::uint8_t>(OutputQuantity::force) ||
        quantity > static_cast<std::uint8_t>(OutputQuantity::frequency)) {
      in.damaged(" names quantity ", int{quantity}, ", which this Wale does not know");
    }
    output.quantity = static_cast<OutputQuantity>(quantity);
    output.axis = in.u8();
    output.value = in.u16();
    output.ceiling = in.u16();
  }
  return outputs;
}

std::vector<HeightTable> read_tables(ByteReader& in) {
  std::vector<HeightTable> tables(in.count(16, "tables"));
  for (std::size_t number = 0; number < tables.size(); ++number) {
    HeightTable& table = tables[number];
    table.width = in.u32();
    table.height = in.u32();
    const std::uint64_t hash = in.u64();
    const std::uint64_t samples = std::uint64_t{table.width} * table.height;
    if (samples > in.remaining() / 2) {
      in.damaged(" claims ", table.width, " x ", table.height, " heights for table ", number, " but has only ",
                 in.remaining(), " bytes for them");
    }
    table.heights.resize(samples);
    for (std::uint16_t& code : table.heights) code = in.u16();
    if (content_hash(table) != hash) in.damaged(" holds table ", number, ", whose heights do not match its hash");
  }
  return tables;
}

Evidence read_evidence(ByteReader& in, std::string_view what) {
  const std::uint8_t value = in.u8();
  if (value < static_cast<std::uint8_t>(Evidence::measured) ||
      value > static_cast<std::uint8_t>(Evidence::extrapolated)) {
    in.damaged(" has evidence grade ", int{value}, " for ", what, ", which this Wale does not know");
  }
  return static_cast<Evidence>(value);
}

std::vector<PerceptRecord> read_percepts(ByteReader& in) {
  std::vector<PerceptRecord> percepts(in.count(93, "percepts"));
  for (PerceptRecord& percept : percepts) {
    percept.name = in.text("a percept's name");
    percept.carrier = in.text("a percept's carrier");
    const std::uint8_t live = in.u8();
    if (live > 2) in.damaged(" holds ", int{live}, " for how a percept's level is set, expected 0, 1 or 2");
    const std::uint16_t parameter = in.u16();
    if (live == 1) percept.parameter = parameter;
    percept.blended = live == 2;
    if (live != 1 && parameter != 0) in.damaged(" names parameter ", parameter, " for a percept without a parameter");
    percept.amplitude = in.u16();
    percept.alone = in.boolean("whether a percept is alone");
    percept.prediction = in.code();
    percept.magnitude = in.u16();
    percept.level = in.u16();
    percept.valid_low = in.finite_f32("a percept's valid range");
    percept.valid_high = in.finite_f32("a percept's valid range");
    percept.uncertainty.scatter = in.finite_f32("a percept's scatter");
    percept.slope = read_evidence(in, "a slope");
    percept.anchor = read_evidence(in, "an anchor");
    percept.handle = read_evidence(in, "a handle");
    percept.map = in.text("a map's name");
    percept.device = in.text("a map's device");
    percept.source = in.text("a map's source");
    percept.unit = in.text("a carrier's unit");
    const std::uint8_t extractor = in.u8();
    if (extractor > static_cast<std::uint8_t>(Extractor::acceleration)) {
      in.damaged(" has extractor ", int{extractor}, ", which this Wale does not know");
    }
    percept.extractor = static_cast<Extractor>(extractor);
    for (float* figure : {&percept.period_low, &percept.period_high, &percept.one, &percept.near_threshold,
                          &percept.uncertainty.spread, &percept.weber, &percept.floor}) {
      *figure = in.finite_f32("a percept's figure");
    }
    percept.uncertainty.observers = in.u16();
    percept.weber_evidence = read_evidence(in, "a threshold");
    percept.weber_source = in.text("a threshold's source");
    percept.realisation = in.text("a realisation");
  }
  if (percepts.empty()) in.damaged(" is empty; a file without percepts leaves it out");
  return percepts;
}

/// Reads the basis of each percept; they have been read before.
void read_bases(ByteReader& in, std::vector<PerceptRecord>& percepts) {
  if (in.count(40, "percepts") != percepts.size() || percepts.empty())
    in.damaged(" has not as many entries as there are percepts");
  for (PerceptRecord& percept : percepts) {
    Basis& basis = percept.basis;
    basis.share = in.finite_f32("the share of a carrier");
    basis.tolerance = in.finite_f32("the tolerance of a level");
    LawUncertainty& law = percept.uncertainty;
    for (float* figure : {&law.slope_error, &law.noise}) *figure = in.finite_f32("the uncertainty of a law");
    law.stimuli = in.u16();
    for (bool* answer :
         {&basis.summand, &basis.valid_assumed, &law.scatter_assumed, &law.spread_assumed, &law.noise_assumed})
      *answer = in.boolean("what is assumed");
    StimulusDomain& domain = basis.domain;
    domain.stated = in.boolean("whether stimuli are stated");
    domain.profiles = in.u8(), domain.dimensions = in.u8();
    if (domain.profiles > 15 || domain.dimensions > 2) in.damaged(" has stimuli that this Wale does not know");
    domain.alone = in.boolean("whether stimuli were alone");
    domain.crest_low = in.finite_f32("the crest of stimuli");
    domain.crest_high = in.finite_f32("the crest of stimuli");
    domain.crest_assumed = in.boolean("whether a crest is assumed");
    basis.ranges.resize(in.count(25, "ranges"));
    for (MeasuredRange& range : basis.ranges) {
      range.quantity = in.text("the quantity of a range");
      range.low = in.finite_f32("a range");
      range.high = in.finite_f32("a range");
      range.unit = in.text("the unit of a range");
      range.unit_in_si = in.finite_f64("the unit of a range");
      range.assumed = in.boolean("whether a range is assumed");
    }
  }
}

std::vector<FateRecord> read_fates(ByteReader& in) {
  std::vector<FateRecord> fates(in.count(18, "fates"));
  for (FateRecord& fate : fates) {
    fate.name = in.text("the name of a fate");
    fate.percept = in.boolean("whether a fate is of a percept");
    const std::uint8_t word = in.u8();
    if (word < static_cast<std::uint8_t>(Fate::kept) || word > static_cast<std::uint8_t>(Fate::lost)) {
      in.damaged(" has fate ", int{word}, ", which this Wale does not know");
    }
    fate.fate = static_cast<Fate>(word);
    fate.asked = in.finite_f32("the level asked for");
    fate.given = in.finite_f32("the level given");
    fate.reason = in.text("the reason of a fate");
  }
  if (fates.empty()) in.damaged(" is empty; a file without fates leaves it out");
  return fates;
}

Layers read_layers(ByteReader& in) {
  Layers layers;
  layers.representative.resize(in.count(8, "entries"));
  for (auto& [key, values] : layers.representative) {
    key = in.text("an entry's name");
    values.resize(in.count(4, "values"));
    for (std::string& value : values) value = in.text("an entry's value");
  }
  layers.perceptual = in.text("the perceptual layer");
  layers.physical = in.text("the physical layer");
  layers.documentation = in.text("the documentation");
  if (layers == Layers{}) in.damaged(" is empty; a file without layers leaves it out");
  return layers;
}

/// Reads the places of the program's code, which has been read before: this section stands after all others.
SourcePlaces read_places(ByteReader& in, const PatchProgram& program) {
  SourcePlaces places;
  places.files.resize(in.count(4, "files"));
  for (std::string& file : places.files) file = in.text("a file's name");
  if (places.files.empty()) in.damaged(" is empty; a file without places leaves it out");
  for (const auto& [section, index] : code_of(program)) {
    auto& runs = places.sections.emplace_back(in.count(10, "runs"));
    std::uint64_t placed = 0;
    for (SourcePlaces::Run& run : runs) {
      run.instructions = in.u32();
      run.file = in.u16();
      run.line = in.u32();
      if (run.instructions == 0) in.damaged(" has a run of no instructions");
      if (run.file >= places.files.size()) {
        in.damaged(" names file ", run.file, " but has only ", places.files.size());
      }
      if (run.line == 0) in.damaged(" names line 0; lines are numbered from 1");
      placed += run.instructions;
    }
    const std::size_t written = program.code(section, index).size();
    if (placed != written) {
      in.damaged(" has places for ", placed, " instructions, but the code has ", written);
    }
  }
  return places;
}

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

PatchProgram read(std::span<const std::byte> bytes) {
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
    return read(bytes);
  } catch (const Error& error) {
    return error;
  }
}

}  // namespace wale
