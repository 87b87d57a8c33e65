#include "runtime/machine/verify.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <initializer_list>

#include "runtime/machine/verify_figures.hpp"

namespace wale {
namespace {

using Instructions = std::span<const Instruction>;

/// Inputs as a set: bit number n for register n.
using Inputs = std::uint32_t;

/// The inputs for which `may` is true in the table of inputs.
constexpr Inputs those(bool InputFacts::*may) {
  Inputs set = 0;
  for (std::size_t number = 0; number < input_table.size(); ++number)
    if (input_table[number].*may) set |= Inputs{1} << number;
  return set;
}

constexpr Inputs patch_inputs = those(&InputFacts::setup);
constexpr Inputs picture_inputs = those(&InputFacts::picture);
constexpr Inputs tick_inputs = those(&InputFacts::tick);
constexpr Inputs prediction_inputs = those(&InputFacts::prediction);

/// The kind of thing that an operand names.
enum class Field : std::uint8_t { nothing, reg, table, grid, peak };
constexpr std::size_t field_kinds = 5;

/// What the fields of an instruction may hold. The table has one for each operation number, known or not.
struct LegalFields {
  bool known = false;
  std::uint8_t results = 0;
  std::array<Field, 3> operands{};
};

constexpr auto legal_fields = [] {
  std::array<LegalFields, 256> table{};
  for (std::size_t number = 0; number < operation_table.size(); ++number) {
    const OperationFacts& known = operation_table[number];
    if (known.name.empty()) continue;
    table[number].known = true;
    table[number].results = static_cast<std::uint8_t>(known.results);
    for (std::size_t i = 0; i < 3; ++i) {
      const char field = known.fields[i];
      table[number].operands[i] = field == 'r'   ? Field::reg
                                  : field == 't' ? Field::table
                                  : field == 'g' ? Field::grid
                                  : field == 'p' ? Field::peak
                                                 : Field::nothing;
    }
  }
  return table;
}();

/// Which registers the code of one section may write and read.
struct Registers {
  RegisterNumber first_destination = 0;  ///< the first register that it may write
  std::size_t destination_count = 0;     ///< how many, from there on
  std::uint32_t stamp = 0;               ///< marks in `Verifier::readable_` the registers that only it may read
};

/// What the code of one section may do.
struct Section {
  std::string name;
  CodeSection kind = CodeSection::setup;
  std::size_t index = 0;  ///< of the peak or the percept
  Inputs inputs = 0;      ///< those that it may read
  Registers registers;
  bool peaks = false;   ///< it may hold `peak` instructions
  bool grids = false;   ///< it may hold `recall` and `cell` instructions
  bool states = false;  ///< it may read states
};

/// Follows code in order and refuses the first instruction that breaks a rule.
class Verifier {
 public:
  explicit Verifier(const PatchProgram& program)
      : program_(program),
        first_setup_(program.first_setup()),
        first_state_(program.first_state()),
        first_temporary_(program.first_temporary()),
        register_count_(program.register_count()),
        readable_(register_count_),
        proved_(program.setup_registers) {
    std::fill(readable_.begin() + first_constant, readable_.begin() + first_setup_, always);
  }

  void verify_program() {
    verify_setup();
    verify_enter();
    verify_tick();
    verify_picture();
    for (std::size_t i = 0; i < program_.percepts.size(); ++i) verify_percept(i);
    verify_outputs();
    verify_costs(program_);
  }

 private:
  Section temporary_section(std::string name, CodeSection kind, std::size_t index, Inputs inputs,
                            bool remembers = false) {
    const Registers registers{first_temporary_, program_.temporaries, ++stamp_};
    return {std::move(name), kind, index, inputs, registers, false, remembers, remembers};
  }

  void verify_setup() {
    const Registers registers{first_setup_, program_.setup_registers, always};
    const Section setup{"setup", CodeSection::setup, 0, patch_inputs, registers, true, false, false};
    begin(setup);
    const Instructions code = program_.setup;
    std::vector<char> invoked(program_.peaks.size());
    for (std::size_t number = 0; number < code.size(); ++number) {
      const Instruction& instruction = code[number];
      if (!is_legal(instruction, registers)) refuse_illegal(setup, code, number);
      if (instruction.operation == static_cast<std::uint8_t>(Operation::peak)) {
        if (invoked[instruction.a]) {
          refuse_at(setup, code, number, place(setup, number, instruction), " runs peak ", instruction.a,
                    " a second time");
        }
        invoked[instruction.a] = true;
        verify_peak(instruction.a);
        begin(setup);
      }
      define(instruction, always);
      note_ceiling(instruction);
    }
    for (std::size_t i = 0; i < invoked.size(); ++i) {
      if (!invoked[i]) refuse("no instruction of setup runs peak ", i);
    }
    for (std::size_t i = 0; i < program_.setup_registers; ++i) {
      if (readable_[first_setup_ + i] != always) refuse("setup leaves register ", first_setup_ + i, " undefined");
    }
  }

  /// A peak reads the setup registers that are defined when its instruction runs it.
  void verify_peak(std::size_t index) {
    const Peak& peak = program_.peaks[index];
    const Section section =
        temporary_section("peak " + std::to_string(index), CodeSection::peak, index, picture_inputs);
    Section extents{section.name, section.kind, section.index, patch_inputs};
    extents.registers.stamp = ++stamp_;
    begin(extents);
    require_result(extents, peak.half_width, "half width");
    require_result(extents, peak.half_height, "half height");
    run(section, peak.code);
    require_result(section, peak.value, "value");
  }

  /// `enter` computes the first values of the states, so it cannot read states.
  void verify_enter() {
    const Section section = temporary_section("enter", CodeSection::enter, 0, tick_inputs);
    run(section, program_.enter);
    for (const State& state : program_.states) {
      require_result(section, state.initial, "initial value of state ", state.name);
    }
  }

  void verify_tick() {
    const Section section = temporary_section("tick", CodeSection::tick, 0, tick_inputs, true);
    run(section, program_.tick);
    for (const State& state : program_.states) {
      require_result(section, state.next, "next value of state ", state.name);
    }
    for (std::size_t i = 0; i < program_.writes.size(); ++i) {
      const GridWrite& write = program_.writes[i];
      if (write.grid >= program_.grids.size()) {
        refuse("write ", i, " goes to grid ", write.grid, ", but the program has ", program_.grids.size());
      }
      require_result(section, write.u, "column of write ", i);
      require_result(section, write.v, "row of write ", i);
      require_result(section, write.value, "value of write ", i);
    }
  }

  void verify_picture() {
    const Picture& picture = program_.picture;
    const Section section = temporary_section("picture", CodeSection::picture, 0, picture_inputs, true);
    run(section, picture.code);
    require_result(section, picture.relief, "relief");
    if (picture.colour) {
      for (const RegisterNumber number : *picture.colour) require_result(section, number, "colour");
    }
    const Section frame = temporary_section("frame", CodeSection::frame, 0, tick_inputs, true);
    run(frame, picture.frame);
    for (std::size_t i = 0; i < picture.marks.size(); ++i) {
      const Mark& mark = picture.marks[i];
      for (std::size_t operand = 0; operand < mark_operands(mark.kind); ++operand) {
        require_result(frame, mark.operands[operand], "operand ", operand, " of mark ", i);
      }
    }
  }

  void verify_percept(std::size_t index) {
    const PerceptRecord& percept = program_.percepts[index];
    const Section section =
        temporary_section("percept " + std::to_string(index), CodeSection::prediction, index, prediction_inputs);
    if (percept.amplitude < first_constant || percept.amplitude >= first_state_) {
      refuse(section.name, " takes the amplitude from register ", percept.amplitude,
             ", expected a constant, a parameter or a setup register");
    }
    run(section, percept.prediction);
    require_result(section, percept.magnitude, "magnitude");
    require_result(section, percept.level, "level");
  }

  void run(const Section& section, Instructions code) {
    begin(section);
    const Registers registers = section.registers;  // a copy: the compiler knows that no write below changes it
    for (std::size_t number = 0; number < code.size(); ++number) {
      if (!is_legal(code[number], registers)) refuse_illegal(section, code, number);
      define(code[number], registers.stamp);
    }
  }

  /// Makes the section's inputs and states readable, and the temporaries of earlier sections unreadable.
  void begin(const Section& section) {
    for (RegisterNumber input = 0; input < first_constant; ++input)
      readable_[input] = (section.inputs >> input & 1) != 0 ? section.registers.stamp : never;
    std::fill(readable_.begin() + first_state_, readable_.begin() + first_temporary_,
              section.states ? section.registers.stamp : never);
    ends_[static_cast<std::size_t>(Field::nothing)] = 1;  // zero
    ends_[static_cast<std::size_t>(Field::reg)] = register_count_;
    ends_[static_cast<std::size_t>(Field::table)] = program_.tables.size();
    ends_[static_cast<std::size_t>(Field::grid)] = section.grids ? program_.grids.size() : 0;
    ends_[static_cast<std::size_t>(Field::peak)] = section.peaks ? program_.peaks.size() : 0;
  }

  /// Whether the instruction agrees with the table of legal fields and with what the current section may do.
  bool is_legal(const Instruction& instruction, const Registers& registers) const {
    const LegalFields& legal = legal_fields[instruction.operation];
    const std::uint32_t* const readable = readable_.data();
    const auto names = [&](Field field, RegisterNumber operand) {
      return operand < ends_[static_cast<std::size_t>(field)] &&
             (field != Field::reg || readable[operand] >= registers.stamp);
    };
    const bool writes_its_own = instruction.destination >= registers.first_destination &&
                                instruction.destination + std::size_t{legal.results} <=
                                    registers.first_destination + registers.destination_count;
    return legal.known && writes_its_own && names(legal.operands[0], instruction.a) &&
           names(legal.operands[1], instruction.b) && names(legal.operands[2], instruction.c);
  }

  /// Says what is wrong with an instruction that is not legal.
  [[noreturn, gnu::noinline]] void refuse_illegal(const Section& section, Instructions code, std::size_t number) const {
    const Instruction& instruction = code[number];
    const LegalFields& legal = legal_fields[instruction.operation];
    if (!legal.known) {
      refuse_at(section, code, number, section.name, " ", number, " has operation number ", int{instruction.operation},
                ", which this Wale does not know");
    }
    const auto refuse_here = [&](const auto&... parts) {
      refuse_at(section, code, number, place(section, number, instruction), parts...);
    };
    const std::array<RegisterNumber, 3> operands = {instruction.a, instruction.b, instruction.c};
    for (std::size_t i = 0; i < operands.size(); ++i) {
      const RegisterNumber operand = operands[i];
      switch (legal.operands[i]) {
        case Field::reg:
          if (!may_read(section, operand)) refuse_here(" reads ", unreadable(section, operand));
          break;
        case Field::table:
          if (operand >= program_.tables.size()) {
            refuse_here(" reads table ", operand, ", but the program has ", program_.tables.size());
          }
          break;
        case Field::grid:
          if (!section.grids) refuse_here(" reads a grid, which only tick, picture and frame may do");
          if (operand >= program_.grids.size()) {
            refuse_here(" reads grid ", operand, ", but the program has ", program_.grids.size());
          }
          break;
        case Field::peak:
          if (!section.peaks) refuse_here(" runs a peak, which only setup may do");
          if (operand >= program_.peaks.size()) {
            refuse_here(" runs peak ", operand, ", but the program has ", program_.peaks.size());
          }
          break;
        case Field::nothing:
          if (operand != 0) {
            refuse_here(" has ", operand, " for operand ", "abc"[i], ", which it does not use, expected 0");
          }
      }
    }
    refuse_at(section, code, number, place(section, number, instruction), " writes register ", instruction.destination,
              legal.results > 1 ? " and those after it" : "", ", but ", section.name, " may write only ",
              section.registers.destination_count, " registers from ", section.registers.first_destination, " on");
  }

  /// Whether the section may read the register at this point of its code.
  bool may_read(const Section& section, RegisterNumber number) const {
    return number < register_count_ && readable_[number] >= section.registers.stamp;
  }

  /// The rest of a sentence about a register that may not be read.
  std::string unreadable(const Section& section, RegisterNumber number) const {
    const std::string name = std::to_string(number);
    if (number >= register_count_) {
      return "register " + name + ", but the program has " + std::to_string(register_count_);
    }
    if (number < first_constant) return "input " + name + ", which " + section.name + " does not have";
    return "register " + name + ", which no earlier instruction writes";
  }

  template <typename... What>
  void require_result(const Section& section, RegisterNumber number, const What&... what) const {
    if (!may_read(section, number)) {
      refuse(section.name, " takes the ", what..., " from ", unreadable(section, number));
    }
  }

  void define(const Instruction& instruction, std::uint32_t stamp) {
    std::uint32_t* result = readable_.data() + instruction.destination;
    *result = stamp;  // most operations have one result
    for (int i = legal_fields[instruction.operation].results; --i > 0;) *++result = stamp;
  }

  /// Updates the proved bound of the setup register that the instruction writes.
  void note_ceiling(const Instruction& instruction) {
    const int results = legal_fields[instruction.operation].results;
    float* proved = proved_.data() + (instruction.destination - first_setup_);
    std::fill(proved, proved + results, 0.0f);
    if (instruction.operation == static_cast<std::uint8_t>(Operation::limit)) {
      *proved = ceiling_constant(instruction.b);
    }
  }

  /// The proved bound of a setup register, or 0 for none.
  float proved(RegisterNumber number) const {
    return number >= first_setup_ && number < first_state_ ? proved_[number - first_setup_] : 0;
  }

  /// The value of a constant that may be a ceiling, or 0 for none.
  float ceiling_constant(RegisterNumber number) const {
    if (number < first_constant || number >= program_.first_parameter()) return 0;
    const float value = program_.constants[number - first_constant];
    return value > 0 ? value : 0;
  }

  /// Checks that the program pushes or vibrates, as its device does.
  void verify_outputs() const {
    const bool vibrates = program_.vibrates();
    const std::array<std::string, 2> names = vibrates ? std::array<std::string, 2>{"amplitude", "frequency"}
                                                      : std::array<std::string, 2>{"force x", "force y"};
    std::array<int, 2> seen{};
    for (const Output& output : program_.outputs) {
      const bool known =
          vibrates ? output.quantity == OutputQuantity::amplitude || output.quantity == OutputQuantity::frequency
                   : output.quantity == OutputQuantity::force;
      if (!known || output.axis > (vibrates ? 0 : 1)) {
        refuse("an output is neither ", names[0], " nor ", names[1],
               vibrates ? ", the only outputs of this device" : "");
      }
      ++seen[output.component()];
      verify_output(output, "output " + names[output.component()]);
    }
    for (std::size_t i = 0; i < seen.size(); ++i) {
      if (seen[i] != 1) refuse("output ", names[i], " occurs ", seen[i], " times, expected once");
    }
  }

  /// The greatest value that the device can give for an output, rounded to a float as a program's constants are.
  float device_limit(const Output& output) const {
    const DeviceProfile& device = program_.device;
    return static_cast<float>(output.quantity == OutputQuantity::frequency ? device.shaker->frequency_high
                                                                           : device.most());
  }

  void verify_output(const Output& output, const std::string& name) const {
    const Instructions code = program_.tick;
    const auto last = last_writer(code, code.size(), output.value);
    if (!last) refuse(name, " is register ", output.value, ", which tick does not write");
    const Section tick{"tick", CodeSection::tick};
    const Instruction& limit = code[*last];
    if (limit.operation != static_cast<std::uint8_t>(Operation::limit)) {
      refuse_at(tick, code, *last, name, " is written last by ", place(tick, *last, limit), ", expected a `limit`");
    }
    if (limit.b != output.ceiling) {
      refuse_at(tick, code, *last, name, " is limited by register ", limit.b, " but declares register ", output.ceiling,
                " as its ceiling");
    }
    const float most = device_limit(output),
                ceiling_value = std::max(ceiling_constant(output.ceiling), proved(output.ceiling));
    if (ceiling_value > 0 && ceiling_value <= most) return;
    const auto ceiling = [&](const auto&... parts) {
      // If setup computes the ceiling, the fault is in setup.
      const auto made = last_writer(program_.setup, program_.setup.size(), output.ceiling);
      if (made) refuse_at({"setup"}, program_.setup, *made, parts...);
      refuse_at(tick, code, *last, parts...);
    };
    ceiling(name, " has register ", output.ceiling, " as its ceiling, expected a constant above 0 and up to ", most,
            unit_of(output.quantity), ", or a register that setup limits by such a constant");
  }

  static std::string_view unit_of(OutputQuantity quantity) {
    return quantity == OutputQuantity::force ? " N" : quantity == OutputQuantity::frequency ? " Hz" : " m/s^2";
  }

  static std::string place(const Section& section, std::size_t number, const Instruction& instruction) {
    const OperationFacts* known = operation_facts(instruction.operation);
    return section.name + " " + std::to_string(number) + " `" +
           (known != nullptr ? std::string(known->name) : "operation " + std::to_string(instruction.operation)) + "`";
  }

  /// The last instruction before number `end` that writes the register.
  static std::optional<std::size_t> last_writer(Instructions code, std::size_t end, RegisterNumber number) {
    for (std::size_t i = end; i-- > 0;) {
      const Instruction& instruction = code[i];
      if (number >= instruction.destination &&
          number < instruction.destination + legal_fields[instruction.operation].results) {
        return i;
      }
    }
    return std::nullopt;
  }

  /// Refuses an instruction, and shows it with those that its operands come from, nearest first up to the limit.
  template <typename... Parts>
  [[noreturn]] void refuse_at(const Section& section, Instructions code, std::size_t number,
                              const Parts&... parts) const {
    std::vector<std::size_t> shown = {number};
    for (std::size_t next = 0; next < shown.size() && shown.size() < shown_instructions; ++next) {
      const Instruction& instruction = code[shown[next]];
      const std::array<RegisterNumber, 3> operands = {instruction.a, instruction.b, instruction.c};
      for (std::size_t i = 0; i < operands.size() && shown.size() < shown_instructions; ++i) {
        if (legal_fields[instruction.operation].operands[i] != Field::reg) continue;
        const auto made = last_writer(code, shown[next], operands[i]);
        if (made && std::find(shown.begin(), shown.end(), *made) == shown.end()) shown.push_back(*made);
      }
    }
    std::sort(shown.begin(), shown.end());
    const auto at = [&](std::size_t each) {
      return Place{section.name, each, listed(code[each]), line_of(section, each)};
    };
    Error error{.code = Code::refused_program, .sentence = sentence(parts...), .place = at(number)};
    for (const std::size_t each : shown) error.led_to.push_back(at(each));
    throw error;
  }

  /// "corduroy.wale:9", or empty if the program does not record it.
  std::string line_of(const Section& section, std::size_t number) const {
    const auto line = program_.place_of(section.kind, section.index, number);
    return line ? line->file + ":" + std::to_string(line->line) : std::string();
  }

  /// "r45 = multiply r45 r41"; an unknown operation is shown by its number.
  static std::string listed(const Instruction& instruction) {
    const LegalFields& legal = legal_fields[instruction.operation];
    std::string text = "r" + std::to_string(instruction.destination) + " = ";
    text += legal.known ? std::string(operation_table[instruction.operation].name)
                        : "operation " + std::to_string(instruction.operation);
    const std::array<RegisterNumber, 3> operands = {instruction.a, instruction.b, instruction.c};
    for (std::size_t i = 0; i < operands.size(); ++i) {
      if (legal.operands[i] == Field::nothing && operands[i] == 0) continue;
      text += legal.operands[i] == Field::reg ? " r" : " ";
      text += std::to_string(operands[i]);
    }
    return text;
  }

  static constexpr std::uint32_t never = 0, always = ~std::uint32_t{0};

  const PatchProgram& program_;
  const RegisterNumber first_setup_, first_state_, first_temporary_;
  const std::size_t register_count_;
  /// Which sections may read a register: all if `always` (constants, parameters, registers that setup wrote), otherwise
  /// the one with that stamp. Later sections have higher stamps, so nothing need be cleared in between.
  std::vector<std::uint32_t> readable_;
  std::array<std::size_t, field_kinds> ends_{};  ///< by field: operands of the current section are less
  std::uint32_t stamp_ = never;
  std::vector<float> proved_;  ///< by setup register: its proved bound, 0 for none
};

}  // namespace

Result<> verify(const PatchProgram& program) {
  try {
    verify_figures(program);
    Verifier(program).verify_program();
    return {};
  } catch (const Error& error) {
    return error;
  }
}

}  // namespace wale
