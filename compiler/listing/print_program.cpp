#include "compiler/listing/print_program.hpp"

#include <fmt/format.h>

#include "compiler/listing/figures.hpp"
#include "schema/patch_program_format.hpp"

namespace wale {
namespace {

constexpr std::size_t cost_column = 58, line_column = 66, interval_column = 92;

std::string quoted(const std::string& text) { return text.empty() ? "" : fmt::format("  \"{}\"", text); }

const char* mark_name(MarkKind kind) {
  switch (kind) {
    case MarkKind::point: return "point";
    case MarkKind::circle: return "circle";
    case MarkKind::box: return "box";
    case MarkKind::line: return "line";
    case MarkKind::spring: return "spring";
    case MarkKind::trajectory: return "trajectory";
  }
  return "mark";
}

std::string output_name(const Output& output) {
  switch (output.quantity) {
    case OutputQuantity::amplitude: return "amplitude";
    case OutputQuantity::frequency: return "frequency";
    case OutputQuantity::force: break;
  }
  return output.axis == 0 ? "force x" : "force y";
}

const char* output_unit(OutputQuantity quantity) {
  return quantity == OutputQuantity::force ? "N" : quantity == OutputQuantity::frequency ? "Hz" : "m/s^2";
}

class ProgramPrinter {
 public:
  ProgramPrinter(const PatchProgram& program, const IntervalOf& interval_of)
      : program_(program), interval_of_(interval_of) {}

  std::string run() {
    line("program {} for {}: {} of 16384 registers", program_.material, program_.device.name,
         program_.register_count());
    line("patch {} m x {} m, rim {} m", figure(program_.patch_width), figure(program_.patch_height),
         figure(program_.patch_rim));
    print_registers();
    for (const auto& [section, index] : patch_program_format::code_of(program_)) print_section(section, index);
    print_costs();
    return std::move(text_);
  }

 private:
  template <typename... Parts>
  void line(fmt::format_string<Parts...> format, Parts&&... parts) {
    text_ += fmt::format(format, std::forward<Parts>(parts)...);
    while (text_.ends_with(' ')) text_.pop_back();
    text_ += '\n';
  }

  void print_registers() {
    RegisterNumber number = first_constant;
    for (const float constant : program_.constants) line("  r{:<5} constant   {}", number++, figure(constant));
    for (const Parameter& p : program_.parameters) {
      const std::string unit = p.si_unit.empty() ? "" : " " + p.si_unit;
      line("  r{:<5} parameter  {} = {}{} in {} .. {}{}", number++, p.name, figure(p.value), unit, figure(p.low),
           figure(p.high), quoted(p.description));
    }
    if (program_.setup_registers > 0) {
      line("  r{} .. r{}  results of setup", program_.first_setup(),
           program_.first_setup() + program_.setup_registers - 1);
    }
    number = program_.first_state();
    for (const State& s : program_.states) {
      line("  r{:<5} state      {} in {} .. {}", number++, s.name, figure(s.low), figure(s.high));
    }
    if (program_.temporaries > 0) {
      line("  r{} .. r{}  temporaries", program_.first_temporary(), program_.register_count() - 1);
    }
    for (std::size_t i = 0; i < program_.grids.size(); ++i) {
      const Grid& g = program_.grids[i];
      line("  grid {}   {}: {} x {} cells of {} in {} .. {}", i, g.name, g.columns, g.rows, figure(g.initial),
           figure(g.low), figure(g.high));
    }
    for (std::size_t i = 0; i < program_.tables.size(); ++i) {
      const HeightTable& t = program_.tables[i];
      line("  table {}  {} x {} heights, hash {:016x}", i, t.width, t.height, patch_program_format::content_hash(t));
    }
  }

  std::string operand(RegisterNumber number) const {
    if (number < first_constant) return input_name(number);
    if (number < program_.first_parameter()) return figure(program_.constants[number - first_constant]);
    if (number < program_.first_setup()) return program_.parameters[number - program_.first_parameter()].name;
    if (number >= program_.first_state() && number < program_.first_temporary())
      return program_.states[number - program_.first_state()].name;
    return fmt::format("r{}", number);
  }

  std::string instruction_text(const Instruction& i) const {
    const OperationFacts* known = operation_facts(i.operation);
    if (!known) return fmt::format("operation {}", i.operation);
    std::string text = fmt::format("r{}", i.destination);
    if (known->results > 1) text += fmt::format("..r{}", i.destination + known->results - 1);
    text += fmt::format(" = {}", known->name);
    const RegisterNumber fields[] = {i.a, i.b, i.c};
    for (std::size_t field = 0; field < 3; ++field) {
      switch (known->fields[field]) {
        case 'r': text += " " + operand(fields[field]); break;
        case 't': text += fmt::format(" table {}", fields[field]); break;
        case 'g': text += " " + program_.grids[fields[field]].name; break;
        case 'p': text += fmt::format(" {}", fields[field]); break;
        default: break;
      }
    }
    return text;
  }

  void print_section(CodeSection section, std::size_t index) {
    const auto& code = program_.code(section, index);
    if (code.empty() && (section == CodeSection::enter || section == CodeSection::frame) && results_of(section).empty())
      return;
    line("");
    line("{}: {}, cost {}", section_name(section, index), counted(code.size(), "instruction"), cost_of(code));
    if (section == CodeSection::peak) {
      const Peak& peak = program_.peaks[index];
      line("  percentile {} of {} at {} points within {} and {} of the centre", figure(peak.percentile),
           operand(peak.value), peak.points, operand(peak.half_width), operand(peak.half_height));
    }
    for (std::size_t number = 0; number < code.size(); ++number) {
      const OperationFacts* known = operation_facts(code[number].operation);
      std::string text = fmt::format("{:>5}  {}", number, instruction_text(code[number]));
      text = beside(text, cost_column, fmt::format("{:>4}", known ? known->cost : 0));
      text = beside(text, line_column, shown(program_.place_of(section, index, number)));
      if (const auto interval = interval_of_ ? interval_of_(section, index, number) : std::nullopt)
        text = beside(text, interval_column, fmt::format("[{}]", *interval));
      line("{}", text);
    }
    for (const auto& result : results_of(section, index)) line("       {}", result);
  }

  /// How the program uses the results of a section, in words.
  std::vector<std::string> results_of(CodeSection section, std::size_t index = 0) const {
    std::vector<std::string> results;
    switch (section) {
      case CodeSection::enter:
        for (const State& s : program_.states)
          results.push_back(fmt::format("{} begins at {}", s.name, operand(s.initial)));
        break;
      case CodeSection::tick:
        for (const Output& o : program_.outputs)
          results.push_back(fmt::format("{} is {} within {} {}", output_name(o), operand(o.value), operand(o.ceiling),
                                        output_unit(o.quantity)));
        for (const State& s : program_.states)
          results.push_back(
              fmt::format("{} becomes {} in {} .. {}", s.name, operand(s.next), figure(s.low), figure(s.high)));
        for (const GridWrite& w : program_.writes)
          results.push_back(fmt::format("{} at {} {} becomes {}", program_.grids[w.grid].name, operand(w.u),
                                        operand(w.v), operand(w.value)));
        break;
      case CodeSection::picture:
        results.push_back(fmt::format("relief is {}{}", operand(program_.picture.relief),
                                      program_.picture.relief_is_length ? " m" : ""));
        if (program_.picture.colour) {
          const auto& [red, green, blue] = *program_.picture.colour;
          results.push_back(fmt::format("colour is {} {} {}", operand(red), operand(green), operand(blue)));
        }
        break;
      case CodeSection::frame:
        for (const Mark& mark : program_.picture.marks) {
          std::string text = fmt::format("{} in #{:06x} at", mark_name(mark.kind), mark.colour);
          for (std::size_t i = 0; i < mark_operands(mark.kind); ++i) text += " " + operand(mark.operands[i]);
          results.push_back(std::move(text));
        }
        break;
      case CodeSection::prediction: {
        const PerceptRecord& percept = program_.percepts[index];
        results.push_back(fmt::format("{} of {} {} {} has magnitude {}, level {}", percept.name, percept.carrier,
                                      operand(percept.amplitude), percept.unit, operand(percept.magnitude),
                                      operand(percept.level)));
        break;
      }
      case CodeSection::setup:
      case CodeSection::peak: break;
    }
    return results;
  }

  void print_costs() {
    long once = cost_of(program_.setup);
    for (const Peak& peak : program_.peaks) once += peak.points * (cost_of(peak.code) + 1);
    line("");
    line("cost: {} a tick, {} an entry, {} a change of parameters (with peaks), {} a point of the picture",
         cost_of(program_.tick), cost_of(program_.enter), once, cost_of(program_.picture.code));
  }

  const PatchProgram& program_;
  const IntervalOf& interval_of_;
  std::string text_;
};

}  // namespace

std::string print_program(const PatchProgram& program, const IntervalOf& interval_of) {
  return ProgramPrinter(program, interval_of).run();
}

}  // namespace wale
