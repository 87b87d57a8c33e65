#include "compiler/cpp/cpp_code.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <string_view>

#include "compiler/cpp/cpp_names.hpp"
#include "compiler/listing/figures.hpp"
#include "runtime/machine/arithmetic.hpp"
#include "runtime/machine/decoded_program.hpp"
#include "runtime/machine/floating_point_mode.hpp"
#include "runtime/machine/peak.hpp"
#include "runtime/machine/single.hpp"

namespace wale {
namespace {

constexpr std::size_t comment_column = 84;

/// The column `meaning` of schema/include/wale/instruction.def as written there; empty for special operations.
constexpr std::string_view meaning_of(Operation operation) {
  // clang-format off
  switch (operation) {
#define INSTRUCTION(number, name, fields, results, cost, meaning, ...) \
  case Operation::name: return #meaning;
#define SPECIAL(number, name, fields, results, cost, ...) \
  case Operation::name: break;
#include "wale/instruction.def"
  }
  // clang-format on
  return {};
}

bool in_word(char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_'; }

/// The meaning with the operands in place of a, b and c.
std::string with_operands(std::string_view meaning, const std::array<std::string, 3>& operands) {
  std::string text;
  for (std::size_t at = 0; at < meaning.size();) {
    std::size_t end = at;
    while (end < meaning.size() && (in_word(meaning[end]) || meaning[end] == '.')) ++end;
    const std::string_view word = meaning.substr(at, end - at);
    if (word.empty()) {
      text += meaning[at++];
      continue;
    }
    if (word.size() == 1 && word[0] >= 'a' && word[0] <= 'c')
      text += operands[static_cast<std::size_t>(word[0] - 'a')];
    else
      text += word;
    at = end;
  }
  return text;
}

// Not inlined; see FloatingPointMode.
[[gnu::noinline]] SplineSample sample_now(const Spline& spline, float a, float b) { return sample_of(spline, a, b); }

SplineSample sample_in_mode(const Spline& spline, float a, float b) {
  const FloatingPointMode mode;
  return sample_now(spline, a, b);
}

float peak_in_mode(const Program& program, std::size_t index, const std::vector<float>& registers) {
  const FloatingPointMode mode;
  return value_of_peak(program.decoded(), index, registers);
}

}  // namespace

std::string cpp_literal(float number) {
  const float value = arithmetic::flushed(number);
  if (std::isnan(value)) return fmt::format("arithmetic::float_of(0x{:08x}u)", std::bit_cast<std::uint32_t>(value));
  if (std::isinf(value)) return value > 0 ? "arithmetic::infinity" : "(-arithmetic::infinity)";
  std::string digits = figure(value);
  if (digits.find_first_of(".e") == std::string::npos) digits += ".0";
  return std::signbit(value) ? fmt::format("({}f)", digits) : digits + "f";
}

const Proof::Ranges& ProvedSection::ranges() const {
  switch (section) {
    case CodeSection::setup: return proof.setup;
    case CodeSection::peak: return proof.peaks[index];
    case CodeSection::enter: return proof.enter;
    default: return proof.tick;
  }
}

CppCode::CppCode(const ProvedSection& proved, const RegisterFacts& facts, std::string prefix,
                 std::vector<RegisterNumber> roots)
    : proved_(proved),
      program_(proved.program.description()),
      facts_(facts),
      now_(facts),
      prefix_(std::move(prefix)),
      code_(proved_.code()),
      steps_(code_.size()),
      names_(program_.register_count()) {
  learn();
  find_needed(roots);
}

std::vector<RegisterNumber> CppCode::reads(const Instruction& instruction, const RegisterFacts& before) const {
  const OperationFacts& known = facts(static_cast<Operation>(instruction.operation));
  const std::array fields{instruction.a, instruction.b, instruction.c};
  std::vector<RegisterNumber> read(fields.begin(), fields.begin() + known.operands);
  if (known.fields[0] == 'p') {
    const Peak& peak = program_.peaks[instruction.a];
    const ProvedSection of_peak{proved_.program, proved_.proof, CodeSection::peak, instruction.a};
    read = CppCode(of_peak, before, "t", {peak.value}).read_from_outside();
    const auto reads = [&](Input input) {
      return std::ranges::binary_search(read, static_cast<RegisterNumber>(input));
    };
    const bool along_x = reads(Input::x), along_y = reads(Input::y);
    if (along_x) read.push_back(peak.half_width);
    if (along_y) read.push_back(peak.half_height);
    // The place of a point comes from the lattice.
    std::erase_if(read, [](RegisterNumber number) {
      return number == static_cast<RegisterNumber>(Input::x) || number == static_cast<RegisterNumber>(Input::y);
    });
  }
  std::erase_if(read, [&](RegisterNumber number) { return before.values[number].has_value(); });
  return read;
}

SizedOperand CppCode::sized(RegisterNumber number) const {
  const auto& value = now_.values[number];
  return {now_.smallest[number], value ? Interval::of(*value) : now_.intervals[number]};
}

std::optional<std::array<float, 3>> CppCode::values_of(const Instruction& instruction) const {
  const auto operation = static_cast<Operation>(instruction.operation);
  const OperationFacts& known = facts(operation);
  const auto value = [&](RegisterNumber number) { return now_.values[number].value_or(0.0f); };
  if (operation == Operation::recall || operation == Operation::cell) return std::nullopt;
  if (!reads(instruction, now_).empty()) return std::nullopt;
  if (operation == Operation::peak) {
    std::vector<float> registers(program_.register_count());
    for (std::size_t i = 0; i < registers.size(); ++i) registers[i] = now_.values[i].value_or(0.0f);
    return std::array{peak_in_mode(proved_.program, instruction.a, registers), 0.0f, 0.0f};
  }
  if (operation == Operation::sample) {
    const SplineSample found =
        sample_in_mode(proved_.program.decoded().splines[instruction.c], value(instruction.a), value(instruction.b));
    return std::array{found.value, found.along_a, found.along_b};
  }
  return std::array{result_of(operation, value(instruction.a), known.operands > 1 ? value(instruction.b) : 0,
                              known.operands > 2 ? value(instruction.c) : 0),
                    0.0f, 0.0f};
}

/// Reads the code once from the first instruction to the last.
void CppCode::learn() {
  const Proof::Ranges& ranges = proved_.ranges();
  for (std::size_t i = 0; i < code_.size(); ++i) {
    const Instruction& instruction = code_[i];
    const auto operation = static_cast<Operation>(instruction.operation);
    Step& step = steps_[i];
    const OperationFacts& known = facts(operation);
    const std::array fields{instruction.a, instruction.b, instruction.c};
    std::array<SizedOperand, 3> operands;
    for (std::size_t k = 0; k < static_cast<std::size_t>(known.operands); ++k) {
      step.known_operands[k] = now_.values[fields[k]];
      operands[k] = sized(fields[k]);
    }
    step.values = values_of(instruction);
    if (operation == Operation::peak && !step.values) step.before = now_;
    const float smallest = smallest_result(operation, operands[0], operands[1], operands[2]);
    step.flushed = smallest < arithmetic::least_normal;
    for (int k = 0; k < known.results; ++k) {
      const auto result = static_cast<std::size_t>(instruction.destination + k);
      const auto part = static_cast<std::size_t>(k);
      now_.intervals[result] = ranges[i][part];
      now_.values[result] = step.values ? std::optional((*step.values)[part]) : std::nullopt;
      now_.smallest[result] =
          step.values ? Smallest::of((*step.values)[part])
                      : Smallest{.size = std::max(smallest, arithmetic::least_normal)}.within(ranges[i][part]);
    }
  }
}

void CppCode::find_needed(const std::vector<RegisterNumber>& roots) {
  std::vector<char> wanted(program_.register_count(), false);
  for (const RegisterNumber root : roots) wanted[root] = true;
  for (std::size_t i = code_.size(); i-- > 0;) {
    Step& step = steps_[i];
    const int results = facts(static_cast<Operation>(code_[i].operation)).results;
    for (int k = 0; k < results; ++k) {
      char& of_result = wanted[static_cast<std::size_t>(code_[i].destination + k)];
      step.needed |= of_result != 0;
      of_result = false;
    }
    if (!step.needed || step.values) continue;
    const std::array fields{code_[i].a, code_[i].b, code_[i].c};
    if (static_cast<Operation>(code_[i].operation) == Operation::peak) {
      for (const RegisterNumber number : reads(code_[i], step.before)) wanted[number] = true;
      continue;
    }
    const OperationFacts& known = facts(static_cast<Operation>(code_[i].operation));
    for (std::size_t k = 0; k < static_cast<std::size_t>(known.operands); ++k)
      if (!step.known_operands[k]) wanted[fields[k]] = true;
  }
  for (std::size_t number = 0; number < wanted.size(); ++number)
    if (wanted[number] && !facts_.values[number]) outside_.push_back(static_cast<RegisterNumber>(number));
}

std::string CppCode::operand(RegisterNumber number) const {
  if (!names_[number].empty()) return names_[number];
  if (facts_.values[number]) return cpp_literal(*facts_.values[number]);
  return kept_.outside(number);
}

std::string CppCode::result(RegisterNumber number) const { return operand(number); }

std::string CppCode::expression(std::size_t number) const {
  const Instruction& instruction = code_[number];
  const auto operation = static_cast<Operation>(instruction.operation);
  const OperationFacts& known = facts(operation);
  const std::array fields{instruction.a, instruction.b, instruction.c};
  std::array<std::string, 3> operands;
  for (std::size_t i = 0; i < static_cast<std::size_t>(known.operands); ++i) operands[i] = operand(fields[i]);
  const auto flushing = [&](const char* function) {
    return fmt::format("{}({}, {})", function, operands[0], operands[1]);
  };
  switch (operation) {
    case Operation::sample:
      return fmt::format("sample_of({}, {}, {})", kept_.table(instruction.c), operands[0], operands[1]);
    case Operation::recall:
      return fmt::format("recall_of({}, {}, {}, {})", kept_.grid_shape(instruction.c), kept_.grid_cells(instruction.c),
                         operands[0], operands[1]);
    case Operation::cell:
      return fmt::format("{}[cell_at({}, {}, {})]", kept_.grid_cells(instruction.c), kept_.grid_shape(instruction.c),
                         operands[0], operands[1]);
    case Operation::add:
      if (steps_[number].flushed) return flushing("sum");
      break;
    case Operation::subtract:
      if (steps_[number].flushed) return flushing("difference");
      break;
    case Operation::multiply:
      if (steps_[number].flushed) return flushing("product");
      break;
    case Operation::divide:
      if (steps_[number].flushed) return flushing("quotient");
      break;
    default: break;
  }
  return with_operands(meaning_of(operation), operands);
}

std::string CppCode::lines(const Surroundings& surroundings, std::size_t indent) {
  kept_ = surroundings;
  static constexpr std::array parts{".value", ".along_a", ".along_b"};
  const std::string before(indent, ' ');
  std::string text;
  for (std::size_t i = 0; i < code_.size(); ++i) {
    const Step& step = steps_[i];
    const Instruction& instruction = code_[i];
    const auto operation = static_cast<Operation>(instruction.operation);
    const int results = facts(operation).results;
    if (step.values) {
      for (int k = 0; k < results; ++k)
        names_[static_cast<std::size_t>(instruction.destination + k)] =
            cpp_literal((*step.values)[static_cast<std::size_t>(k)]);
      continue;
    }
    if (!step.needed) continue;
    const std::string name = prefix_ + std::to_string(i);
    const std::string place = shown(program_.place_of(proved_.section, proved_.index, i));
    if (operation == Operation::peak) {
      kept_.peak(
          instruction, step.before, [this](RegisterNumber number) { return operand(number); }, name, text);
    } else {
      const char* type = operation == Operation::sample   ? "SplineSample"
                         : operation == Operation::recall ? "GridSample"
                                                          : "float";
      const std::string line = fmt::format("{}const {} {} = {};", before, type, name, expression(i));
      text += beside(line, comment_column, place.empty() ? "" : "// " + cpp_comment(place)) + '\n';
    }
    for (int k = 0; k < results; ++k)
      names_[static_cast<std::size_t>(instruction.destination + k)] =
          results == 1 ? name : name + parts[static_cast<std::size_t>(k)];
  }
  return text;
}

}  // namespace wale
