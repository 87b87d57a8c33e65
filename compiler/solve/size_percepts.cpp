#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "compiler/declarations/discrimination.hpp"
#include "compiler/expression/check_expression.hpp"
#include "compiler/solve/basis.hpp"
#include "compiler/solve/saturation.hpp"
#include "compiler/solve/solve_percepts.hpp"
#include "compiler/text/readable.hpp"

// Sizes of carriers: as numbers at the parameters' defaults, and as expressions of the program.

namespace wale {

void PerceptSolver::solve_size(Told& told, std::vector<Parameter>& parameters) {
  const AskedPercept& asked = *told.asked;
  for (std::size_t i = 0; i < material_.parameters.size(); ++i)
    if (material_.parameters[i].name == asked.name)
      report(
          Code::declared_twice, material_.parameter_spans[i],
          fmt::format("the parameter `{}` has the same name as a percept, whose level is a parameter too", asked.name),
          Advice("give the parameter another name").see(asked.span, "asked for here"));
  told.parameter = static_cast<std::uint32_t>(parameters.size());
  if (!asked.blended) add_level(asked.name, asked.level, asked.name, parameters);
  for (const LevelShare& share : asked.shares)
    add_level(share.component + "_" + asked.name, share.level, fmt::format("{} in {}", asked.name, share.component),
              parameters);
}

/// Adds a parameter for a level; if the name is taken, a number is appended.
void PerceptSolver::add_level(const std::string& name, double level, const std::string& of,
                              std::vector<Parameter>& parameters) {
  parameters.push_back({.name = names_.free(parameters, name),
                        .unit = "",
                        .unit_in_si = 1,
                        .value = static_cast<float>(level),
                        .low = 0,
                        .high = 1,
                        .soft_low = 0,
                        .soft_high = 1,
                        .description = fmt::format("level of {}: 0 none, 1 its reference stimulus", of)});
}

/// The level of a solved percept: a parameter, or in a blend the weighted sum of its components' levels.
TermId PerceptSolver::level_term(const Told& told, Terms& terms, TermCopier& copy) const {
  if (!told.asked->blended) return terms.parameter(told.parameter);
  TermId level = terms.literal(0);
  for (std::uint32_t i = 0; i < told.asked->shares.size(); ++i)
    level = terms.apply(
        Operation::add, level,
        terms.apply(Operation::multiply, copy(told.asked->shares[i].share), terms.parameter(told.parameter + i)));
  return level;
}

void PerceptSolver::work_out_sizes() {
  for (const std::size_t index : order_) {
    Told& told = told_[index];
    if (!told.solved) {
      if (told.asked) check_conflict(told);
      told.size =
          told.shares != none
              ? told_[told.shares].size
              : constant_value(*terms_, (*carriers_)[told.carrier].size, &material_.parameters).value_or(std::nan(""));
      continue;
    }
    const Law& law = *told.law;
    const std::vector<double> couples = coupled_sizes(told);
    told.size = law.carrier_of(told.asked->level, couples);
    if (!law.has_inverse()) {
      report(Code::unsolvable_law, told.map->span,
             fmt::format("the law of {} from {} cannot be solved for `{}`", told.map->percept, told.map->from,
                         told.map->from),
             "use one `magnitude` and one carrier with + - * / ^ log exp sqrt, or a quadratic with a `branch`");
    } else if (told.asked->level > 0 && !law.reaches(told.asked->level, couples)) {
      report(Code::inverse_out_of_range, told.asked->span,
             readable("no {} gives {} {:.3g} by this law ({})", told.percept->argument(), told.asked->name,
                      told.asked->level, told.map->source),
             Advice(readable("its measured levels are {:.2g} to {:.2g}", law.level_of(told.map->valid_low, couples),
                             law.level_of(told.map->valid_high, couples)))
                 .see(told.map->span, "the map"));
    } else {
      warn_of_range(told);
    }
  }
}

/// The levels that a map's range of sizes covers: "from 0.04 to 0.99"; "from 0.13 on" where it goes beyond level 1.
static std::string levels_of_range(const Law& law, const Map& map) {
  const auto [low, high] = std::minmax({law.level_of(map.valid_low), law.level_of(map.valid_high)});
  return high > 1.005 ? readable("from {:.2g} on", low) : readable("from {:.2g} to {:.2g}", low, high);
}

static double lowest_level(const Law& law, const Map& map) {
  return std::min(law.level_of(map.valid_low), law.level_of(map.valid_high));
}

/// "ask for roughness 0.1 or more (smoothness 0.9 or less); ": the least level that is felt and in the map's range.
static std::string least_felt(const AskedPercept& asked, const Percept& percept, const Law& law, const Map& map) {
  // Upwards to hundredths, so that what is proposed is inside.
  const double least = std::ceil(100 * std::max(percept.near_threshold, lowest_level(law, map)) - 1e-6) / 100;
  if (least > 1) return {};
  const std::string other =
      percept.antonym.empty() ? "" : readable(" ({} {:.2g} or less)", percept.antonym, 1 - least);
  return readable("ask for {} {:.2g} or more{}; ", asked.name, least, other);
}

void PerceptSolver::warn_of_range(const Told& told) {
  const Law& law = *told.law;
  const AskedPercept& asked = *told.asked;
  const Percept& percept = *told.percept;
  const Map& map = *told.map;
  const std::string of_carrier = unit(percept);
  const double most = percept.exerts > 0 ? this->most(told) / percept.exerts : HUGE_VAL;
  const double size = told.size;
  constexpr double rounding = 1e-6;  // a reference stimulus exactly at the end of the range is inside it
  if (size > most)
    report(
        Code::saturates, asked.place(),
        readable("{} {:.3g} needs {:.3g} {}, and `{}` {} {:.3g} {} at most", asked.name, asked.level, size, of_carrier,
                 device_.profile.name, device_.profile.shaker ? "shakes with" : "pushes", most, of_carrier),
        Advice(readable("the most it can render is {:.2g}", law.level_of(most)))
            .fact("most_level", law.level_of(most))
            .fact("needed", size, of_carrier)
            .fact("most", most, of_carrier));
  // Level 0 is nothing, which everybody feels; and `smoothness 0.9` is roughness 0.1 but for rounding.
  constexpr double rounding_of_level = 1e-9;
  const bool is_nothing = asked.level < rounding_of_level;
  const bool is_faint = asked.level < percept.near_threshold - rounding_of_level;
  const bool is_low = is_faint || asked.level < lowest_level(law, map);
  if (!is_nothing && (is_faint || size < map.valid_low * (1 - rounding) || size > map.valid_high * (1 + rounding)))
    report(Code::beyond_validity, asked.place(),
           is_faint
               ? readable("expected {} {:.2g} or more, found {:.3g}, which few people can feel", asked.name,
                          percept.near_threshold, asked.level)
               : readable("expected {} {}, {}, found {:.3g} ({})", asked.name, levels_of_range(law, map),
                          map.valid_assumed ? "the range assumed for its map" : "the measured range", asked.level,
                          map.source),
           readable("{}{}: levels {}, {:.3g} to {:.3g} {}", is_low ? least_felt(asked, percept, law, map) : "",
                    map.valid_assumed ? "assumed" : "measured", levels_of_range(law, map), map.valid_low,
                    map.valid_high, of_carrier));
  if (map.recalled())
    report(Code::unverified_basis, asked.place(),
           readable("{} rests on a figure that was recalled and not looked up ({})", asked.name, map.source),
           Advice("take it as a guess until somebody has seen the source").see(map.span, "the map"));
}

double PerceptSolver::most_size(const Told& told) const { return std::max(told.size, told.law->carrier_of(1)); }

/// Whether the forces of all percepts could together exceed the device's for any setting of the sliders, and one of
/// them is solved. One percept alone counts too: its size is reduced to what the device gives, so that its force keeps
/// its shape; cut at the device's limit, it would have another shape than the one that its map was measured with.
bool PerceptSolver::may_exceed() const {
  double sum = 0;
  bool solved = false;
  for (const Told& told : told_) {
    if (exertion(told) == 0) continue;
    solved = solved || told.solved;
    const bool live =
        told.solved ? !told.map->couples.empty() : !constant_value(*terms_, (*carriers_)[told.carrier].size);
    sum += live ? HUGE_VAL : told.percept->exerts * (told.solved ? most_size(told) : told.size);
  }
  return solved && !(sum <= most());
}

double PerceptSolver::most_at(const std::optional<double>& rate) const {
  const double peak = device_.profile.most();
  const auto& shaker = device_.profile.shaker;
  if (!shaker || !rate) return peak;
  return std::min(peak, shaker->acceleration(1, std::clamp(*rate, shaker->frequency_low, shaker->frequency_high)));
}

double PerceptSolver::most(const Told& told) const {
  return most_at(constant_value(*terms_, (*carriers_)[told.carrier].force_y, &material_.parameters));
}

void PerceptSolver::find_most() {
  most_ = device_.profile.most();
  double strongest = 0;
  for (const Told& told : told_) {
    const double force = exertion(told) * told.size;
    if (!(force > strongest)) continue;
    strongest = force;
    most_ = most_at(constant_value(*terms_, (*carriers_)[told.carrier].force_y));
  }
}

// ---- expressions ----------------------------------------------------------------------------------------------------

Law::Sizes PerceptSolver::coupled_terms(const Told& told, SolvedMaterial& solved) const {
  Law::Sizes sizes;
  for (const std::size_t other : told.couples)
    sizes.push_back(other == none ? solved.terms.literal(0) : *told_[other].term);
  return sizes;
}

std::map<std::uint32_t, TermId> PerceptSolver::sizes(SolvedMaterial& solved, TermCopier& copy) {
  Terms& terms = solved.terms;
  for (const std::size_t index : order_) {
    Told& told = told_[index];
    if (!told.solved) {
      told.term = told.shares != none ? *told_[told.shares].term : copy((*carriers_)[told.carrier].size);
      continue;
    }
    told.term = asked_size(told, solved, copy);
  }
  if (may_exceed()) reduce(solved, copy);
  terms.attribute({});
  std::map<std::uint32_t, TermId> sizes;
  for (const Told& told : told_) {
    if (!told.solved) continue;
    // Where a part of the relief counts for another percept, the whole is larger.
    const double share = band_share(told);
    const TermId whole =
        share == 1 ? *told.term : terms.apply(Operation::multiply, terms.literal(1 / share), *told.term);
    sizes[(*terms_)[(*carriers_)[told.carrier].size].index] = whole;
  }
  return sizes;
}

PerceptRecord PerceptSolver::record(const Told& told) {
  const Percept& percept = *told.percept;
  const Carrier& carrier = (*carriers_)[told.carrier];
  PerceptRecord record = record_by(*told.map, percept, device_, declarations_);
  const Told& setting = told.shares == none ? told : told_[told.shares];
  record.blended = setting.solved && setting.asked->blended;
  if (setting.solved && !record.blended) record.parameter = static_cast<std::uint16_t>(setting.parameter);
  record.alone = is_only_force(carrier);
  record.basis.summand = is_whole(carrier);
  const double share = band_share(setting);
  record.basis.share = static_cast<float>(share);
  if (told.asked) record.basis.tolerance = static_cast<float>(told.asked->tolerance);
  const Discrimination people(declarations_, percept.cue, device_.profile.name, share * percept.exerts);
  if (const Threshold* threshold = people.threshold(told.size, told.size)) {
    record.weber = static_cast<float>(threshold->weber);
    record.floor = static_cast<float>(people.floor(*threshold));
    record.weber_evidence = people.evidence(*threshold);
    record.weber_source = threshold->source;
  }
  if (const auto rule = realised_.find(percept.name); rule != realised_.end()) record.realisation = rule->second;
  return record;
}

FateRecord PerceptSolver::fate(const AskedPercept& asked) const {
  FateRecord record{.name = asked.name, .percept = true, .asked = static_cast<float>(asked.level), .reason = {}};
  const auto found = std::ranges::find(told_, &asked, &Told::asked);
  if (found == told_.end()) {
    record.fate = Fate::lost;
    return record;
  }
  const Map& map = *found->map;
  const auto rule = realised_.find(asked.name);
  // The level follows from the size, which may have been reduced.
  const double most = found->percept->exerts > 0 ? this->most(*found) / found->percept->exerts : HUGE_VAL;
  const double given = found->law->level_of(std::min(found->size, most), coupled_sizes(*found));
  record.given = std::isfinite(given) ? static_cast<float>(std::clamp(given, 0.0, 1.0)) : record.asked;
  constexpr double rounding = 1e-4;
  const bool foreign = !is_of(map, device_);
  // A size that the author fixed gives its own level, which may differ from the one asked for by the tolerance.
  const double aimed = found->solved ? asked.level : found->law->level_of(found->size, coupled_sizes(*found));
  if (given < aimed * (1 - rounding)) {
    record.fate = Fate::saturated;
    record.reason = saturation_reason(device_.profile.name, found->size < most * (1 - rounding));
  } else if (rule != realised_.end() || foreign) {
    record.fate = Fate::approximated;
  }
  const std::string how = realisation_reason(rule == realised_.end() ? "" : rule->second,
                                             !foreign           ? ""
                                             : map.name.empty() ? map.source
                                                                : map.name,
                                             map.device);
  if (!how.empty()) record.reason += (record.reason.empty() ? "" : "; ") + how;
  return record;
}

void PerceptSolver::describe(SolvedMaterial& solved) {
  solved.percepts.reserve(told_.size());
  for (Told& told : told_) {
    const Law& law = *told.law;
    SolvedPercept each;
    each.amplitude = *told.term;
    solved.terms.attribute(told.map->span);
    const TermId probe = solved.terms.input(Input::probe);
    const Law::Sizes couples = coupled_terms(told, solved);
    const auto magnitude = law.magnitude(solved.terms, probe, couples);
    const auto level = magnitude ? law.level_of_magnitude(solved.terms, *magnitude) : std::nullopt;
    if (!magnitude || !level) {
      report(Code::unsolvable_law, told.map->span,
             fmt::format("the law of {} cannot be solved for its magnitude", told.percept->name),
             "use one `magnitude` and one carrier with + - * / ^ log exp sqrt");
      continue;
    }
    each.magnitude = *magnitude;
    each.level = *level;
    if (told.asked) each.asked = told.asked->level;
    const Carrier& carrier = (*carriers_)[told.carrier];
    each.force = {solved.solutions_end + carrier.force_x, solved.solutions_end + carrier.force_y};
    each.record = record(told);
    solved.percepts.push_back(std::move(each));
  }
}

}  // namespace wale
