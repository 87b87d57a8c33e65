#include "schema/patch_program_format.hpp"
#include "schema/read_sections.hpp"

namespace wale::patch_program_format {

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

}  // namespace wale::patch_program_format
