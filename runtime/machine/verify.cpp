#include "runtime/machine/verify.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <initializer_list>
#include <vector>

#include "runtime/machine/verify_figures.hpp"
#include "schema/refuse.hpp"

namespace wale {
namespace {

/// What the code of one section may do.
struct Section {
  std::string name;
  std::initializer_list<Input> inputs;   ///< that it may read
  RegisterNumber first_destination = 0;  ///< it writes from here
  std::size_t destination_count = 0;     ///< on, so many registers
  bool peaks = false;                    ///< it may hold `peak` instructions
  bool grids = false;                    ///< it may hold `recall` and `cell` instructions
};

/// Whether each register of the program is defined; as char, since bits are slower to look at one by one.
using Registers = std::vector<char>;

constexpr std::initializer_list<Input> patch_inputs = {Input::patch_half_width, Input::patch_half_height,
                                                       Input::patch_rim, Input::seconds_per_tick};
constexpr std::initializer_list<Input> picture_inputs = {
    Input::x, Input::y, Input::patch_half_width, Input::patch_half_height, Input::patch_rim, Input::seconds_per_tick};
constexpr std::initializer_list<Input> tick_inputs = {Input::x,
                                                      Input::y,
                                                      Input::velocity_x,
                                                      Input::velocity_y,
                                                      Input::patch_half_width,
                                                      Input::patch_half_height,
                                                      Input::patch_rim,
                                                      Input::acceleration_x,
                                                      Input::acceleration_y,
                                                      Input::raw_velocity_x,
                                                      Input::raw_velocity_y,
                                                      Input::raw_acceleration_x,
                                                      Input::raw_acceleration_y,
                                                      Input::workspace_x,
                                                      Input::workspace_y,
                                                      Input::time,
                                                      Input::button,
                                                      Input::seconds_per_tick};
constexpr std::initializer_list<Input> prediction_inputs = {Input::patch_half_width, Input::patch_half_height,
                                                            Input::patch_rim, Input::probe, Input::seconds_per_tick};

/// Follows code in order and refuses the first instruction that breaks a rule.
class Verifier {
 public:
  explicit Verifier(const PatchProgram& program)
      : program_(program),
        register_count_(program.register_count()),
        defined_(register_count_, false),
        proved_(register_count_, false) {
    for (std::size_t i = first_constant; i < program.first_setup(); ++i) defined_[i] = true;
  }

  void verify_program() {
    verify_setup();
    const Registers after_setup = defined_;
    verify_enter(after_setup);
    Registers with_states = after_setup;
    for (std::size_t i = 0; i < program_.states.size(); ++i) with_states[program_.first_state() + i] = true;
    verify_tick(with_states);
    verify_picture(with_states);
    for (std::size_t i = 0; i < program_.percepts.size(); ++i) verify_percept(i, after_setup);
    verify_outputs();
    verify_costs();
  }

 private:
  Section temporary_section(std::string name, std::initializer_list<Input> inputs, bool grids = false) const {
    return {std::move(name), inputs, program_.first_temporary(), program_.temporaries, false, grids};
  }

  void verify_setup() {
    const Section setup{"setup", patch_inputs, program_.first_setup(), program_.setup_registers, true};
    std::vector<bool> invoked(program_.peaks.size());
    for (std::size_t number = 0; number < program_.setup.size(); ++number) {
      const Instruction& instruction = program_.setup[number];
      check_fields(setup, number, instruction, defined_);
      if (instruction.operation == static_cast<std::uint8_t>(Operation::peak)) {
        if (invoked[instruction.a]) {
          refuse(place(setup, number, instruction), " runs peak ", instruction.a, " a second time");
        }
        invoked[instruction.a] = true;
        verify_peak(instruction.a);
      }
      define(instruction, defined_);
      note_ceiling(instruction);
    }
    for (std::size_t i = 0; i < invoked.size(); ++i) {
      if (!invoked[i]) refuse("peak ", i, " is run by no instruction of setup");
    }
    for (std::size_t i = 0; i < program_.setup_registers; ++i) {
      if (!defined_[program_.first_setup() + i]) {
        refuse("setup leaves register ", program_.first_setup() + i, " undefined");
      }
    }
  }

  /// A peak sees the setup registers as they are when its instruction runs it.
  void verify_peak(std::size_t index) {
    const Peak& peak = program_.peaks[index];
    const Section section = temporary_section("peak " + std::to_string(index), picture_inputs);
    const Section extents{section.name, patch_inputs};
    require_result(extents, defined_, peak.half_width, "half width");
    require_result(extents, defined_, peak.half_height, "half height");
    require_result(section, run(section, peak.code, defined_), peak.value, "value");
  }

  /// States begin with what `enter` leaves, which knows of no states.
  void verify_enter(const Registers& after_setup) const {
    const Section section = temporary_section("enter", tick_inputs);
    const Registers after = run(section, program_.enter, after_setup);
    for (const State& state : program_.states) {
      require_result(section, after, state.initial, "initial value of state " + state.name);
    }
  }

  void verify_tick(const Registers& with_states) const {
    const Section section = temporary_section("tick", tick_inputs, true);
    const Registers after = run(section, program_.tick, with_states);
    for (const State& state : program_.states) {
      require_result(section, after, state.next, "next value of state " + state.name);
    }
    for (std::size_t i = 0; i < program_.writes.size(); ++i) {
      const GridWrite& write = program_.writes[i];
      const std::string name = "write " + std::to_string(i);
      if (write.grid >= program_.grids.size()) {
        refuse(name, " goes to grid ", write.grid, " of ", program_.grids.size());
      }
      require_result(section, after, write.u, "column of " + name);
      require_result(section, after, write.v, "row of " + name);
      require_result(section, after, write.value, "value of " + name);
    }
  }

  void verify_picture(const Registers& with_states) const {
    const Picture& picture = program_.picture;
    const Section section = temporary_section("picture", picture_inputs, true);
    const Registers after = run(section, picture.code, with_states);
    require_result(section, after, picture.relief, "relief");
    if (picture.colour) {
      for (const RegisterNumber number : *picture.colour) require_result(section, after, number, "colour");
    }
    const Section frame = temporary_section("frame", tick_inputs, true);
    const Registers shown = run(frame, picture.frame, with_states);
    for (std::size_t i = 0; i < picture.marks.size(); ++i) {
      const Mark& mark = picture.marks[i];
      for (std::size_t operand = 0; operand < mark_operands(mark.kind); ++operand) {
        require_result(frame, shown, mark.operands[operand],
                       "operand " + std::to_string(operand) + " of mark " + std::to_string(i));
      }
    }
  }

  void verify_percept(std::size_t index, const Registers& after_setup) {
    const PerceptRecord& percept = program_.percepts[index];
    const Section section = temporary_section("percept " + std::to_string(index), prediction_inputs);
    if (percept.amplitude < first_constant || !is_uniform(percept.amplitude)) {
      refuse(section.name, " finds its amplitude in register ", percept.amplitude,
             ", which is neither a constant, a parameter nor set up");
    }
    const Registers after = run(section, percept.prediction, after_setup);
    require_result(section, after, percept.magnitude, "magnitude");
    require_result(section, after, percept.level, "level");
  }

  /// Code of a section that starts from `defined`; returns what is defined after it.
  Registers run(const Section& section, std::span<const Instruction> code, const Registers& defined) const {
    Registers known = defined;
    for (std::size_t number = 0; number < code.size(); ++number) {
      check_fields(section, number, code[number], known);
      define(code[number], known);
    }
    return known;
  }

  void check_fields(const Section& section, std::size_t number, const Instruction& instruction,
                    const Registers& defined) const {
    const auto known = operation_facts(instruction.operation);
    if (!known) {
      refuse(section.name, " ", number, " has operation number ", int{instruction.operation},
             ", which this Wale does not know");
    }
    const auto here = [&] { return place(section, number, instruction); };
    if (instruction.operation == static_cast<std::uint8_t>(Operation::peak) && !section.peaks) {
      refuse(here(), " runs a peak, which only setup may");
    }
    if (known->fields[2] == 'g' && !section.grids) {
      refuse(here(), " looks into a grid, which only tick, picture and frame may");
    }
    const std::array<RegisterNumber, 3> operands = {instruction.a, instruction.b, instruction.c};
    for (std::size_t i = 0; i < operands.size(); ++i) {
      const RegisterNumber operand = operands[i];
      switch (known->fields[i]) {
        case 'r':
          check_read(
              section, [&] { return here() + " reads"; }, operand, defined);
          break;
        case 't':
          if (operand >= program_.tables.size()) {
            refuse(here(), " looks into table ", operand, " of ", program_.tables.size());
          }
          break;
        case 'g':
          if (operand >= program_.grids.size()) {
            refuse(here(), " looks into grid ", operand, " of ", program_.grids.size());
          }
          break;
        case 'p':
          if (operand >= program_.peaks.size()) refuse(here(), " runs peak ", operand, " of ", program_.peaks.size());
          break;
        default:
          if (operand != 0) {
            refuse(here(), " has ", operand, " for operand ", "abc"[i], ", which it does not use and must be zero");
          }
      }
    }
    const std::size_t end = section.first_destination + section.destination_count;
    if (instruction.destination < section.first_destination ||
        instruction.destination + static_cast<std::size_t>(known->results) > end) {
      refuse(here(), " writes register ", instruction.destination, known->results > 1 ? " and those after it" : "",
             ", and ", section.name, " may write only ", section.destination_count, " registers from ",
             section.first_destination, " on");
    }
  }

  /// `who` gives the beginning of the sentence for a refusal.
  template <typename Sentence>
  void check_read(const Section& section, const Sentence& who, RegisterNumber number, const Registers& defined) const {
    if (number >= register_count_) {
      refuse(who(), " register ", number, ", and the program has ", register_count_);
    }
    if (number < first_constant) {
      const auto legal = [number](Input input) { return static_cast<RegisterNumber>(input) == number; };
      if (std::none_of(section.inputs.begin(), section.inputs.end(), legal)) {
        refuse(who(), " input ", number, ", which ", section.name, " does not have");
      }
    } else if (!defined[number]) {
      refuse(who(), " register ", number, ", which nothing before it writes");
    }
  }

  void require_result(const Section& section, const Registers& defined, RegisterNumber number,
                      std::string_view what) const {
    check_read(
        section, [&] { return section.name + " finds its " + std::string(what) + " in"; }, number, defined);
  }

  static void define(const Instruction& instruction, Registers& defined) {
    const int results = facts(static_cast<Operation>(instruction.operation)).results;
    for (int i = 0; i < results; ++i) defined[instruction.destination + i] = true;
  }

  /// Keeps up to date which setup registers are proved to lie below the device's force.
  void note_ceiling(const Instruction& instruction) {
    const int results = facts(static_cast<Operation>(instruction.operation)).results;
    for (int i = 0; i < results; ++i) proved_[instruction.destination + i] = false;
    if (instruction.operation == static_cast<std::uint8_t>(Operation::limit)) {
      proved_[instruction.destination] = is_ceiling_constant(instruction.b);
    }
  }

  bool is_uniform(RegisterNumber number) const { return number < program_.first_state(); }

  bool is_ceiling_constant(RegisterNumber number) const {
    if (number < first_constant || number >= program_.first_parameter()) return false;
    const float value = program_.constants[number - first_constant];
    return value > 0 && value <= program_.device.force_newton;
  }

  void verify_outputs() const {
    std::array<int, 2> seen{};
    for (const Output& output : program_.outputs) {
      if (output.quantity != OutputQuantity::force || output.axis > 1) {
        refuse("an output is neither force x nor force y");
      }
      ++seen[output.axis];
      verify_output(output);
    }
    for (std::size_t axis = 0; axis < seen.size(); ++axis) {
      if (seen[axis] != 1)
        refuse("output force ", "xy"[axis], " is given ", seen[axis], " times and must be given once");
    }
  }

  void verify_output(const Output& output) const {
    const std::string name = std::string("output force ") + "xy"[output.axis];
    const auto writes = [&output](const Instruction& i) {
      const auto results = static_cast<std::size_t>(facts(static_cast<Operation>(i.operation)).results);
      return output.value >= i.destination && output.value < i.destination + results;
    };
    const auto last = std::find_if(program_.tick.rbegin(), program_.tick.rend(), writes);
    if (last == program_.tick.rend()) refuse(name, " is register ", output.value, ", which tick does not write");
    if (last->operation != static_cast<std::uint8_t>(Operation::limit)) {
      const auto number = static_cast<std::size_t>(program_.tick.rend() - last) - 1;
      refuse(name, " is written last by ", place({"tick", {}}, number, *last), ", which is no limit");
    }
    if (last->b != output.ceiling) {
      refuse(name, " is limited by register ", last->b, " and declares register ", output.ceiling, " its ceiling");
    }
    const bool proved = output.ceiling < register_count_ && proved_[output.ceiling];
    if (!is_ceiling_constant(output.ceiling) && !proved) {
      refuse(name, " has register ", output.ceiling, " for its ceiling, which is neither a constant above 0 and up to ",
             program_.device.force_newton, " N nor limited by one in setup");
    }
  }

  void verify_costs() const {
    const double period = tick_share_of_period * 1e9 / program_.device.rate;
    const auto check = [period](const std::string& name, std::span<const Instruction> code) {
      const auto cost = static_cast<double>(cost_of(code));
      if (cost > period) {
        refuse(name, " costs ", cost, " units and the device's period has room for ", std::floor(period));
      }
    };
    check("tick", program_.tick);
    check("enter", program_.enter);
    check("picture", program_.picture.code);
    check("frame", program_.picture.frame);
    for (std::size_t i = 0; i < program_.percepts.size(); ++i) {
      check("percept " + std::to_string(i), program_.percepts[i].prediction);
    }
    double setup = static_cast<double>(cost_of(program_.setup));
    for (const Peak& peak : program_.peaks) {
      setup += static_cast<double>(peak.points) * (1.0 + static_cast<double>(cost_of(peak.code)));
    }
    if (setup > setup_cost_limit) {
      refuse("setup and its peaks cost ", setup, " units and may cost ", setup_cost_limit);
    }
  }

  static std::string place(const Section& section, std::size_t number, const Instruction& instruction) {
    const auto known = operation_facts(instruction.operation);
    return section.name + " " + std::to_string(number) + " `" + std::string(known->name) + "`";
  }

  const PatchProgram& program_;
  const std::size_t register_count_;
  Registers defined_, proved_;
};

}  // namespace

std::optional<Refusal> verify(const PatchProgram& program) {
  try {
    verify_figures(program);
    Verifier(program).verify_program();
    return std::nullopt;
  } catch (const Refusal& refusal) {
    return refusal;
  }
}

}  // namespace wale
