#include "compiler/listing/cpp_code.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <string_view>

#include "compiler/listing/cpp_names.hpp"
#include "compiler/listing/figures.hpp"
#include "runtime/machine/arithmetic.hpp"

namespace wale {
namespace {

constexpr std::size_t comment_column = 84;

/// The column `meaning` of schema/instruction.def as written there; empty for special operations.
constexpr std::string_view meaning_of(Operation operation) {
  // clang-format off
  switch (operation) {
#define INSTRUCTION(number, name, fields, results, cost, meaning, ...) \
  case Operation::name: return #meaning;
#define SPECIAL(number, name, fields, results, cost, ...) \
  case Operation::name: break;
#include "schema/instruction.def"
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

}  // namespace

std::string cpp_literal(float number) {
  const float value = arithmetic::flushed(number);
  if (std::isnan(value)) return fmt::format("arithmetic::float_of(0x{:08x}u)", std::bit_cast<std::uint32_t>(value));
  if (std::isinf(value)) return value > 0 ? "arithmetic::infinity" : "(-arithmetic::infinity)";
  std::string digits = figure(value);
  if (digits.find_first_of(".e") == std::string::npos) digits += ".0";
  return std::signbit(value) ? fmt::format("({}f)", digits) : digits + "f";
}

std::string cpp_hidden(float value) { return fmt::format("hidden({})", cpp_literal(value)); }

CppCode::CppCode(const PatchProgram& program, CodeSection section, std::size_t index, std::string prefix,
                 std::vector<RegisterNumber> roots)
    : program_(program),
      section_(section),
      index_(index),
      prefix_(std::move(prefix)),
      code_(program.code(section, index)),
      needed_(code_.size(), false),
      names_(program.register_count()) {
  find_needed(roots);
}

std::vector<RegisterNumber> CppCode::reads(const Instruction& instruction) const {
  const OperationFacts& known = facts(static_cast<Operation>(instruction.operation));
  const std::array fields{instruction.a, instruction.b, instruction.c};
  std::vector<RegisterNumber> read(fields.begin(), fields.begin() + known.operands);
  if (known.fields[0] == 'p') {
    const Peak& peak = program_.peaks[instruction.a];
    read = CppCode(program_, CodeSection::peak, instruction.a, "t", {peak.value}).read_from_outside();
    const auto reads = [&](Input input) {
      return std::ranges::binary_search(read, static_cast<RegisterNumber>(input));
    };
    const bool along_x = reads(Input::x), along_y = reads(Input::y);
    if (along_x) read.push_back(peak.half_width);
    if (along_y) read.push_back(peak.half_height);
  }
  return read;
}

void CppCode::find_needed(const std::vector<RegisterNumber>& roots) {
  std::vector<char> wanted(program_.register_count(), false);
  for (const RegisterNumber root : roots) wanted[root] = true;
  for (std::size_t i = code_.size(); i-- > 0;) {
    const int results = facts(static_cast<Operation>(code_[i].operation)).results;
    for (int k = 0; k < results; ++k) {
      char& of_result = wanted[static_cast<std::size_t>(code_[i].destination + k)];
      needed_[i] |= of_result;
      of_result = false;
    }
    if (!needed_[i]) continue;
    for (const RegisterNumber number : reads(code_[i])) wanted[number] = true;
  }
  for (std::size_t number = 0; number < wanted.size(); ++number)
    if (wanted[number]) outside_.push_back(static_cast<RegisterNumber>(number));
}

std::string CppCode::operand(RegisterNumber number) const {
  if (!names_[number].empty()) return names_[number];
  if (number >= first_constant && number < program_.first_parameter()) {
    return cpp_literal(program_.constants[number - first_constant]);
  }
  return kept_.outside(number);
}

std::string CppCode::result(RegisterNumber number) const { return operand(number); }

std::string CppCode::expression(const Instruction& instruction) const {
  const auto operation = static_cast<Operation>(instruction.operation);
  const OperationFacts& known = facts(operation);
  const std::array fields{instruction.a, instruction.b, instruction.c};
  std::array<std::string, 3> operands;
  bool all_constant = true;
  for (std::size_t i = 0; i < static_cast<std::size_t>(known.operands); ++i) {
    const bool constant =
        names_[fields[i]].empty() && fields[i] >= first_constant && fields[i] < program_.first_parameter();
    all_constant = all_constant && constant;
    operands[i] = operand(fields[i]);
  }
  if (all_constant) operands[0] = cpp_hidden(program_.constants[instruction.a - first_constant]);
  switch (operation) {
    case Operation::sample:
      return fmt::format("sample_of({}, {}, {})", kept_.table(instruction.c), operands[0], operands[1]);
    case Operation::recall:
      return fmt::format("recall_of({}, {}.data(), {}, {})", kept_.grid_shape(instruction.c),
                         kept_.grid_cells(instruction.c), operands[0], operands[1]);
    case Operation::cell:
      return fmt::format("{}[cell_at({}, {}, {})]", kept_.grid_cells(instruction.c), kept_.grid_shape(instruction.c),
                         operands[0], operands[1]);
    default: return with_operands(meaning_of(operation), operands);
  }
}

std::string CppCode::lines(const Surroundings& surroundings, std::size_t indent) {
  kept_ = surroundings;
  static constexpr std::array parts{".value", ".along_a", ".along_b"};
  const std::string before(indent, ' ');
  std::string text;
  for (std::size_t i = 0; i < code_.size(); ++i) {
    if (!needed_[i]) continue;
    const Instruction& instruction = code_[i];
    const auto operation = static_cast<Operation>(instruction.operation);
    const std::string name = prefix_ + std::to_string(i);
    const std::string place = shown(program_.place_of(section_, index_, i));
    if (operation == Operation::peak) {
      kept_.peak(
          instruction, [this](RegisterNumber number) { return operand(number); }, name, text);
    } else {
      const char* type = operation == Operation::sample   ? "SplineSample"
                         : operation == Operation::recall ? "GridSample"
                                                          : "float";
      const std::string line = fmt::format("{}const {} {} = {};", before, type, name, expression(instruction));
      text += beside(line, comment_column, place.empty() ? "" : "// " + cpp_comment(place)) + '\n';
    }
    const int results = facts(operation).results;
    for (int k = 0; k < results; ++k)
      names_[static_cast<std::size_t>(instruction.destination + k)] =
          results == 1 ? name : name + parts[static_cast<std::size_t>(k)];
  }
  return text;
}

}  // namespace wale
