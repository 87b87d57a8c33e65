#include "compiler/describe/fates_at.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "compiler/declarations/declarations.hpp"
#include "compiler/describe/describe.hpp"
#include "compiler/describe/describe_figure.hpp"
#include "compiler/evidence/correct_fate.hpp"
#include "compiler/grade/grade.hpp"
#include "compiler/measure/cut_force.hpp"
#include "compiler/measure/measure.hpp"
#include "compiler/solve/saturation.hpp"
#include "compiler/text/readable.hpp"
#include "runtime/machine/floating_point_mode.hpp"
#include "runtime/machine/lane.hpp"

namespace wale {
namespace {

// relative: a level asked for and the level given may differ by this in single precision
constexpr double rounding = 5e-4;
constexpr float at_the_end = 1e-3f;  // of a parameter's range: a change that near its end is not reported
constexpr int halvings = 14;         // of a parameter's range, to find where a fate changes

/// Whether each register is read later.
using LiveRegisters = std::vector<char>;

void read_operands(const Instruction& instruction, LiveRegisters& live) {
  const RegisterNumber operands[] = {instruction.a, instruction.b, instruction.c};
  const std::string_view fields = facts(static_cast<Operation>(instruction.operation)).fields;
  for (std::size_t i = 0; i < fields.size(); ++i)
    if (fields[i] == 'r') live[operands[i]] = true;
}

/// The size and the level of one solved percept as functions of the parameters: the part of the setup code that they
/// need, which seldom holds a peak.
class SolvedSize {
 public:
  SolvedSize(const Bank& bank, std::size_t index)
      : decoded_(bank.program().decoded()),
        program_(decoded_.description),
        percept_(program_.percepts[index]),
        live_(program_.register_count()) {
    live_[percept_.amplitude] = true;
    for (const Instruction& instruction : percept_.prediction) read_operands(instruction, live_);
    for (auto i = program_.setup.rbegin(); i != program_.setup.rend(); ++i) {
      const int results = facts(static_cast<Operation>(i->operation)).results;
      bool needed = false;
      for (int result = 0; result < results; ++result)
        needed |= std::exchange(live_[i->destination + result], char{false}) != 0;
      if (!needed) continue;
      read_operands(*i, live_);
      if (i->operation == static_cast<std::uint8_t>(Operation::peak))
        for (const Instruction& instruction : program_.peaks[i->a].code) read_operands(instruction, live_);
      code_.push_back(*i);
    }
    std::ranges::reverse(code_);
  }

  bool depends_on(std::size_t parameter) const { return live_[program_.first_parameter() + parameter] != 0; }

  /// The size of the carrier at these registers, in the percept's unit.
  double size(std::vector<float>& registers) const {
    run(code_, registers);
    return registers[percept_.amplitude];
  }
  /// The level of a carrier of that size. Call `size` first.
  double level(std::vector<float>& registers, double size) const {
    registers[static_cast<std::size_t>(Input::probe)] = static_cast<float>(size);
    run(percept_.prediction, registers);
    return registers[percept_.level];
  }

 private:
#if defined(__GNUC__)
  __attribute__((noinline))  // see FloatingPointMode
#endif
  void
  run(std::span<const Instruction> code, std::vector<float>& registers) const {
    const FloatingPointMode mode;
    run_lane(decoded_, code, registers.data(), nullptr);
  }

  const DecodedProgram& decoded_;
  const PatchProgram& program_;
  const PerceptRecord& percept_;
  LiveRegisters live_;  ///< read by the code before it is written
  std::vector<Instruction> code_;
};

class FateFinder {
 public:
  FateFinder(const Bank& bank, const FateRecord& record, std::size_t index, double most, std::string map)
      : bank_(bank),
        program_(bank.program().description()),
        record_(record),
        percept_(program_.percepts[index]),
        size_(bank, index),
        most_(most),
        map_(std::move(map)) {}

  DescribedFate found() const {
    const std::vector<float> registers(bank_.registers().begin(), bank_.registers().end());
    DescribedFate fate{at(registers), {}};
    for (std::size_t i = 0; i < program_.parameters.size(); ++i)
      if (size_.depends_on(i))
        for (const bool above : {false, true}) add_change(fate, registers, i, above);
    return fate;
  }

 private:
  FateRecord at(std::vector<float> registers) const {
    FateRecord now = record_;
    const double size = size_.size(registers), level = size_.level(registers, std::min(size, most_));
    now.asked = registers[program_.first_parameter() + *percept_.parameter];
    now.given = std::isfinite(level) ? static_cast<float>(std::clamp(level, 0.0, 1.0)) : now.asked;
    std::string how = realised_how();
    now.fate = how.empty() ? Fate::kept : Fate::approximated;
    if (now.given < now.asked * (1 - rounding)) {
      now.fate = Fate::saturated;
      const std::string why = saturation_reason(program_.device.name, size < most_ * (1 - rounding));
      how = how.empty() ? why : fmt::format("{}; {}", why, how);
    }
    now.reason = how;
    return now;
  }

  /// How the percept is realised, which is the same at all parameters.
  std::string realised_how() const {
    const bool foreign = percept_.handle == Evidence::transferred && percept_.device != program_.device.name;
    return realisation_reason(percept_.realisation, foreign ? map_ : "", percept_.device);
  }

  FateRecord with(const std::vector<float>& registers, std::size_t parameter, float value) const {
    std::vector<float> changed = registers;
    changed[program_.first_parameter() + parameter] = value;
    return at(std::move(changed));
  }

  /// Finds where the fate changes towards one end of a parameter's range, if it is another at that end.
  void add_change(DescribedFate& fate, const std::vector<float>& registers, std::size_t index, bool above) const {
    const Parameter& parameter = program_.parameters[index];
    float same = registers[program_.first_parameter() + index], other = above ? parameter.high : parameter.low;
    if (same == other) return;
    const FateRecord there = with(registers, index, other);
    if (there.fate == fate.record.fate) return;
    const float end = other;
    for (int i = 0; i < halvings; ++i) {
      const float middle = 0.5f * (same + other);
      (with(registers, index, middle).fate == fate.record.fate ? same : other) = middle;
    }
    if (std::abs(other - end) <= at_the_end * (parameter.high - parameter.low)) return;
    fate.changes.push_back({parameter.name, shown(other, parameter.unit_in_si), parameter.unit, above, there.fate});
  }

  const Bank& bank_;
  const PatchProgram& program_;
  const FateRecord& record_;
  const PerceptRecord& percept_;
  SolvedSize size_;
  double most_;      ///< of the carrier, in its own unit
  std::string map_;  ///< that solved the percept: its name
};

/// The percept of a fate if its level is a parameter of its own, and not if it only shares a carrier.
std::optional<std::size_t> solved_percept(const PatchProgram& program, const FateRecord& fate) {
  if (!fate.percept || fate.fate == Fate::lost) return std::nullopt;
  for (std::size_t i = 0; i < program.percepts.size(); ++i) {
    const PerceptRecord& percept = program.percepts[i];
    if (percept.name != fate.name || !percept.parameter || percept.blended) continue;
    const auto first = std::ranges::find(program.percepts, percept.parameter, &PerceptRecord::parameter);
    return &*first == &percept ? std::optional(i) : std::nullopt;
  }
  return std::nullopt;
}

/// The largest size of a percept's carrier that an output of `given` allows, in the percept's unit.
double most_of(const PatchProgram& program, const PerceptRecord& percept, const Declarations& declarations,
               double given) {
  if (percept.unit == (program.vibrates() ? "m/s^2" : "N")) return given * percept.basis.share;
  const Percept* declared = declarations.percepts.find(percept.name);
  return declared && declared->exerts > 0 ? given / declared->exerts : HUGE_VAL;
}

/// The map that solved a percept, by its name, or by its source where it has none or is not declared here: the program
/// keeps the source only.
std::string map_of(const PerceptRecord& percept, const Declarations& declarations) {
  for (const Map* map : declarations.maps())
    if (map->percept == percept.name && map->source == percept.source && !map->name.empty()) return map->name;
  return percept.source;
}

}  // namespace

std::vector<DescribedFate> fates_at(const Bank& bank, const ForceReading& found, const Declarations& declarations) {
  const PatchProgram& program = bank.program().description();
  const double given = most_given(bank, declarations);
  const auto speed = static_cast<float>(normal_hand(declarations).speed());
  std::vector<DescribedFate> all;
  for (const FateRecord& record : program.fates) {
    const auto index = solved_percept(program, record);
    if (!index) {
      all.push_back({is_of_force(record) ? fate_of_force(record, bank, speed) : record, {}});
      continue;
    }
    const double most = most_of(program, program.percepts[*index], declarations, given);
    all.push_back(FateFinder(bank, record, *index, most, map_of(program.percepts[*index], declarations)).found());
    correct_fate(all.back().record, bank, *index, all.back().record.asked, found, declarations);
  }
  return all;
}

std::vector<DescribedFate> fates_at(const Bank& bank, const Declarations& declarations) {
  return fates_at(bank, read(bank, declarations, parts_for(bank.program().description())), declarations);
}

std::string changes_text(const DescribedFate& fate) {
  std::string text;
  for (const FateChange& each : fate.changes)
    text +=
        readable("{}{} {} {} {:.3g}{}{}", text.empty() ? "" : "; ", fate_word(each.fate),
                 each.above ? "above" : "below", each.parameter, each.value, each.unit.empty() ? "" : " ", each.unit);
  return text;
}

}  // namespace wale
