#include "compiler/describe/describe_percept.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "compiler/evidence/domain.hpp"
#include "compiler/measure/coarseness.hpp"
#include "compiler/read/proportional.hpp"
#include "runtime/machine/parallel.hpp"

namespace wale {
namespace {

/// The level that the author asked for at these parameters, if any.
std::optional<double> asked_of(const Bank& bank, const PerceptRecord& record, const PerceptReading& told) {
  const PatchProgram& program = bank.program().description();
  if (record.parameter) return bank.registers()[program.first_parameter() + *record.parameter];
  if (record.blended) return told.aimed_level;
  const auto fate = std::ranges::find_if(
      program.fates, [&](const FateRecord& each) { return each.percept && each.name == record.name; });
  return fate == program.fates.end() ? std::nullopt : std::optional<double>(fate->asked);
}

/// How well the author knows the level that was asked for; nothing if a slider has moved it, or if it is not stated.
std::optional<Evidence> claimed_of(const PatchProgram& program, const std::string& percept,
                                   const std::optional<double>& asked) {
  constexpr double moved = 1e-6;
  const auto claim = std::ranges::find(program.claims, percept, &LevelClaim::percept);
  const auto fate = std::ranges::find_if(
      program.fates, [&](const FateRecord& each) { return each.percept && each.name == percept; });
  if (claim == program.claims.end() || fate == program.fates.end() || !asked) return std::nullopt;
  return std::abs(*asked - fate->asked) > moved ? std::nullopt : std::optional(claim->evidence);
}

/// `given` is the largest output of the device.
DescribedPercept recorded_percept(const Bank& bank, std::size_t index, const ForceReading& found, double given,
                                  const Declarations& declarations) {
  const PatchProgram& program = bank.program().description();
  const PerceptRecord& record = program.percepts[index];
  const PerceptReading told = percept_reading(bank, index, found, declarations);
  DescribedPercept percept;
  percept.asked = asked_of(bank, record, told);
  percept.claimed = claimed_of(program, record.name, percept.asked);
  percept.aimed = told.aimed;
  percept.blended = record.blended, percept.solved = record.parameter || record.blended;
  percept.realisation = record.realisation;
  percept.alone = record.alone, percept.changed = percept.solved && !record.basis.summand;
  percept.readable = told.readable, percept.unknown = told.unknown;
  percept.amplitude = told.size, percept.level = told.level, percept.magnitude = told.magnitude;
  const bool limited = record.unit == (program.vibrates() ? "m/s^2" : "N");
  percept.saturated = limited && told.aimed > given * record.basis.share;
  // The program itself reduces the size of a percept that needs more than the device gives.
  constexpr double single_precision = 5e-4;
  if (percept.asked && percept.solved && told.aimed_level < *percept.asked * (1 - single_precision))
    percept.saturated = true;
  tell_evidence(percept, record, bank, found, declarations);
  return percept;
}

}  // namespace

Evidence DescribedPercept::evidence() const { return std::max({slope, anchor, handle, domain.value_or(slope)}); }

void tell_evidence(DescribedPercept& percept, const PerceptRecord& record, const Bank& bank, const ForceReading& found,
                   const Declarations& declarations) {
  percept.name = record.name, percept.carrier = record.carrier, percept.unit = record.unit;
  percept.slope = record.slope, percept.anchor = record.anchor, percept.handle = record.handle;
  percept.map = record.map, percept.device = record.device, percept.source = record.source;
  percept.uncertainty = record.uncertainty;
  percept.effective = record.extractor == Extractor::lateral_force && !percept.solved;
  percept.intervals =
      level_intervals(record.uncertainty, percept.level, record.one > 0 ? percept.amplitude / record.one : 0);
  percept.near_threshold = percept.level < record.near_threshold;
  percept.outside = outside_of(record, percept.amplitude, bank, found, declarations);
  const DomainJudgement judgement = judge_domain(record, percept.amplitude, bank, found);
  if (record.basis.domain.stated) percept.domain = record.slope;
  if (!judgement.inside || !percept.outside.empty()) percept.domain = Evidence::extrapolated;
  if (percept.amplitude != 0) percept.domain_why = judgement.why;
  const Basis& basis = record.basis;
  if (basis.valid_assumed) percept.assumed.push_back(record.carrier.substr(record.carrier.find(' ') + 1));
  for (const MeasuredRange& range : basis.ranges)
    if (range.assumed) percept.assumed.push_back(range.quantity);
  if (basis.domain.crest_assumed) percept.assumed.emplace_back("crest");
  const LawUncertainty& law = record.uncertainty;
  for (const auto& [is_assumed, name] :
       {std::pair{law.scatter_assumed, "scatter"}, {law.spread_assumed, "spread"}, {law.noise_assumed, "noise"}})
    if (is_assumed) percept.assumed.emplace_back(name);
}

std::vector<DescribedPercept> recorded_percepts(const Bank& bank, const ForceReading& found,
                                                const Declarations& declarations) {
  std::vector<DescribedPercept> percepts;
  const double given = most_given(bank, declarations);
  for (std::size_t i = 0; i < bank.program().description().percepts.size(); ++i) {
    DescribedPercept percept = recorded_percept(bank, i, found, given, declarations);
    // A parameter may make a viscosity or a spring push along instead of against the hand, and no map covers that.
    if (!std::isfinite(percept.level) && !percept.unknown) continue;
    // What nobody asked for and nothing reads is not there.
    if (!percept.asked && percept.amplitude == 0) continue;
    percepts.push_back(std::move(percept));
  }
  return percepts;
}

void tell_ends(std::vector<DescribedPercept>& percepts, const Bank& bank, const ForceReading& found,
               const Declarations& declarations) {
  const PatchProgram& program = bank.program().description();
  if (coarseness_of(program) > 1) return;  // a reading takes long
  struct Task {
    std::size_t parameter = 0;
    float value = 0;
    std::vector<std::optional<double>> reads;  ///< for each percept, where it is another level
  };
  std::vector<Task> tasks;
  const auto is_level = [&](std::size_t i) {
    return std::ranges::any_of(program.percepts, [&](const PerceptRecord& each) { return each.parameter == i; });
  };
  const bool asks =
      std::ranges::any_of(percepts, [](const DescribedPercept& each) { return each.asked && each.readable; });
  std::vector<float> values;
  for (std::size_t i = 0; i < program.parameters.size(); ++i)
    values.push_back(bank.registers()[program.first_parameter() + i]);
  const std::size_t searched = 2 * parameters_searched(program);
  for (std::size_t i = 0; asks && i < program.parameters.size() && tasks.size() < searched; ++i)
    for (const float end : {program.parameters[i].low, program.parameters[i].high})
      if (!is_level(i) && end != values[i]) tasks.push_back({i, end, {}});
  in_parallel(tasks.size(), [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      Task& task = tasks[i];
      task.reads.resize(percepts.size());
      std::vector<float> there_values = values;
      there_values[task.parameter] = task.value;
      const Bank there(bank.program(), there_values, bank.size());
      const auto times = times_as_strong(bank, there);
      const ForceReading reading =
          times ? times_as_strong(found, *times) : read(there, declarations, parts_for(program));
      for (std::size_t j = 0; j < percepts.size(); ++j) {
        const DescribedPercept& percept = percepts[j];
        const auto record = std::ranges::find(program.percepts, percept.name, &PerceptRecord::name);
        if (record == program.percepts.end() || !percept.asked || percept.blended) continue;
        const auto index = static_cast<std::size_t>(record - program.percepts.begin());
        const PerceptReading told = percept_reading(there, index, reading, declarations);
        // What is another level only because this one is already is no news.
        const bool otherwise = told.unknown || differs(*record, told.aimed, *percept.asked, told.size, told.level);
        const bool news = told.unknown ? !percept.unknown : !(std::abs(told.level - percept.level) < 0.005);
        if (told.readable && otherwise && news) task.reads[j] = told.level;
      }
    }
  });
  for (const Task& task : tasks)
    for (std::size_t j = 0; j < percepts.size(); ++j)
      if (task.reads[j]) percepts[j].ends.push_back({task.parameter, task.value, *task.reads[j]});
}

void tell_settings(std::vector<DescribedPercept>& percepts, const Bank& bank, const ForceReading& found,
                   const Declarations& declarations) {
  const PatchProgram& program = bank.program().description();
  struct Task {
    DescribedPercept* percept = nullptr;
    std::size_t index = 0;
    DescribedPercept::Setting* setting = nullptr;
  };
  std::vector<Task> tasks;
  for (DescribedPercept& percept : percepts) {
    const auto record = std::ranges::find(program.percepts, percept.name, &PerceptRecord::name);
    if (record == program.percepts.end() || !record->parameter || !percept.readable) continue;
    const Parameter& level = program.parameters[*record->parameter];
    percept.parameter = level.name;
    percept.settings = {{level.low, 0}, {0.5 * (level.low + level.high), 0}, {level.high, 0}};
    for (DescribedPercept::Setting& setting : percept.settings)
      tasks.push_back({&percept, static_cast<std::size_t>(record - program.percepts.begin()), &setting});
  }
  in_parallel(tasks.size(), [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const Task& task = tasks[i];
      const std::uint16_t parameter = *program.percepts[task.index].parameter;
      std::vector<float> values;
      for (std::size_t j = 0; j < program.parameters.size(); ++j)
        values.push_back(bank.registers()[program.first_parameter() + j]);
      const auto level = static_cast<float>(task.setting->asked);
      if (values[parameter] == level) {
        task.setting->reads = percept_reading(bank, task.index, found, declarations).level;
        continue;
      }
      values[parameter] = level;
      const Bank there(bank.program(), values, bank.size());
      // Most sliders only make the force stronger.
      const auto times = times_as_strong(bank, there);
      const ForceReading reading = times ? times_as_strong(found, *times)
                                         : read(there, declarations, parts_for(program.percepts[task.index].extractor));
      task.setting->reads = percept_reading(there, task.index, reading, declarations).level;
    }
  });
}

}  // namespace wale
