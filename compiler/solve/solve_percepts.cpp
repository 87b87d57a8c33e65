#include "compiler/solve/solve_percepts.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "compiler/declarations/discrimination.hpp"
#include "compiler/diagnostics/advice.hpp"
#include "compiler/expression/check_expression.hpp"
#include "compiler/solve/only_compared.hpp"
#include "compiler/text/readable.hpp"

namespace wale {

namespace {

/// The advice for several open sizes. The error is reported at the second.
Advice left_open(const std::vector<const Carrier*>& open) {
  Advice advice = "add the heights up in one `lateral(a + b)`, or give all but one an amplitude";
  for (std::size_t i = 0; i < open.size(); ++i)
    if (i != 1) advice = std::move(advice).see(open[i]->span, "this one is open too");
  return advice;
}

std::string sources_of(const std::vector<const Map*>& maps) {
  std::vector<std::string> all;
  for (const Map* map : maps) all.push_back(map->source);
  return fmt::format("{}", fmt::join(all, "; "));
}

/// "lateral" for "lateral amplitude".
std::string function_of(const std::string& carrier) { return carrier.substr(0, carrier.find(' ')); }

/// "`lateral`, by its amplitude" for "lateral amplitude".
std::string carrier_words(const std::string& carrier) {
  const std::size_t space = carrier.find(' ');
  if (space == std::string::npos) return fmt::format("`{}`", carrier);
  return fmt::format("`{}`, by its {}", carrier.substr(0, space), carrier.substr(space + 1));
}

}  // namespace

/// Finds the terms of the total force: what is added up, unchanged. A sum that is used twice is read once.
void PerceptSolver::find_summands() {
  std::vector<std::array<TermId, 2>> waiting{force_};
  while (!waiting.empty() && diagnostics_.charge(1, material_.span, Work::solving)) {
    const auto [x, y] = waiting.back();
    waiting.pop_back();
    if (!summands_.insert(std::uint64_t{x} << 32 | y).second) continue;
    const Term &of_x = (*terms_)[x], &of_y = (*terms_)[y];
    const auto is_sum = [](const Term& term) {
      return term.kind == TermKind::operation && term.operation == Operation::add;
    };
    if (!is_sum(of_x) || !is_sum(of_y)) continue;
    waiting.push_back({of_x.a, of_y.a});
    waiting.push_back({of_x.b, of_y.b});
  }
}

/// Whether the carrier's force is whole in the total force, whatever is added to it or taken from it.
bool PerceptSolver::is_whole(const Carrier& carrier) {
  std::vector<std::array<TermId, 2>> waiting{force_};
  std::unordered_set<std::uint64_t> seen;
  while (!waiting.empty() && diagnostics_.charge(1, material_.span, Work::solving)) {
    const auto [x, y] = waiting.back();
    waiting.pop_back();
    if (x == carrier.force_x && y == carrier.force_y) return true;
    if (!seen.insert(std::uint64_t{x} << 32 | y).second) continue;
    const Term &of_x = (*terms_)[x], &of_y = (*terms_)[y];
    if (of_x.kind != TermKind::operation || of_y.kind != TermKind::operation || of_x.operation != of_y.operation)
      continue;
    if (of_x.operation != Operation::add && of_x.operation != Operation::subtract) continue;
    waiting.push_back({of_x.a, of_y.a});
    if (of_x.operation == Operation::add) waiting.push_back({of_x.b, of_y.b});
  }
  return false;
}

/// Whether no other force than the carrier's pushes: the total force is the carrier's, as it is or after limits and
/// factors.
bool PerceptSolver::is_only_force(const Carrier& carrier) {
  const auto comes_from = [&](TermId total, TermId force) {
    std::vector<TermId> waiting{total};
    std::unordered_set<TermId> seen;
    while (!waiting.empty() && diagnostics_.charge(1, material_.span, Work::solving)) {
      const TermId current = waiting.back();
      waiting.pop_back();
      if (current == force) return true;
      if (!seen.insert(current).second) continue;
      const Term& term = (*terms_)[current];
      if (term.kind != TermKind::operation) continue;
      const bool product = term.operation == Operation::multiply;
      if (product) waiting.push_back(term.b);
      if (product || term.operation == Operation::divide || term.operation == Operation::negate ||
          term.operation == Operation::limit)
        waiting.push_back(term.a);
    }
    return false;
  };
  return comes_from(force_[0], carrier.force_x) && comes_from(force_[1], carrier.force_y);
}

/// Whether the carrier's force is a term of the total force, unchanged: neither scaled nor limited nor switched.
bool PerceptSolver::is_summand(const Carrier& carrier) {
  if (summands_.empty()) find_summands();
  return summands_.contains(std::uint64_t{carrier.force_x} << 32 | carrier.force_y);
}

const Percept& PerceptSolver::percept(const std::string& name) {
  const auto share = shares_.find(name);
  if (!device_.profile.shaker && share == shares_.end()) return *declarations_.percepts.find(name);
  const auto found = percepts_.find(name);
  if (found != percepts_.end()) return found->second;
  Percept carried = carried_on(device_, *declarations_.percepts.find(name), declarations_);
  if (share != shares_.end()) carried.exerts /= share->second;
  return percepts_.emplace(name, std::move(carried)).first->second;
}

void PerceptSolver::find_told_carriers() {
  for (std::size_t i = 0; i < carriers_->size(); ++i) {
    const Carrier& carrier = (*carriers_)[i];
    // An open size is meant to be felt. A fixed one may be part of something else: the viscous onset of a dry friction
    // is not felt as viscosity.
    if (carrier.open || (!terms_->dependence(carrier.size).in_tick() && is_summand(carrier))) candidates_.push_back(i);
  }
}

void PerceptSolver::plan(const Terms& terms, const std::vector<Carrier>& carriers, const std::array<TermId, 2>& force,
                         const std::map<std::string, std::string>& realised,
                         const std::map<std::string, std::string>& lost, std::vector<Parameter>& parameters) {
  terms_ = &terms;
  carriers_ = &carriers;
  force_ = force;
  realised_ = realised;
  const std::size_t errors_before = diagnostics_.error_count();
  find_told_carriers();
  for (const auto& asked : material_.percepts)
    if (!lost.contains(asked.name)) match(asked);
  // A percept that was not asked for is told too, if only one carrier tells of it and there is a map.
  declarations_.percepts.each([&](const std::string& name, const Percept& declared) {
    if (!declared.has_reference) return;
    const Percept& percept = this->percept(name);
    if (std::ranges::any_of(told_, [&](const Told& told) { return told.percept == &percept; })) return;
    std::vector<std::size_t> mine;
    for (const std::size_t i : candidates_)
      if (carriers[i].name == percept.carrier) mine.push_back(i);
    const auto open = std::ranges::find_if(mine, [&](std::size_t i) { return carriers[i].open; });
    if (mine.size() != 1 && open == mine.end()) return;
    const std::size_t index = open == mine.end() ? mine[0] : *open;
    if (carriers[index].open && std::ranges::find(told_, index, &Told::carrier) == told_.end()) return;
    if (std::ranges::any_of(material_.percepts, [&](const auto& asked) { return asked.name == name; })) return;
    if (const Map* map = choose_map(percept, device_, declarations_, chosen_by(percept.name)).map)
      tell({.percept = &percept, .map = map, .carrier = index});
  });
  couple();
  if (diagnostics_.error_count() > errors_before) return;
  for (Told& told : told_)
    if (told.solved) solve_size(told, parameters);
  if (diagnostics_.error_count() > errors_before) return;
  work_out_sizes();
  find_most();
  reduce();
  mark_decalibrating(parameters);
}

/// The author's parameters that a term depends on by itself, and not through one of the terms in `beyond`.
std::set<std::uint32_t> PerceptSolver::parameters_of(TermId id, const std::array<TermId, 2>& beyond) const {
  std::set<std::uint32_t> found;
  std::set<TermId> seen(beyond.begin(), beyond.end());
  std::vector<TermId> waiting{id};
  while (!waiting.empty()) {
    const TermId current = waiting.back();
    waiting.pop_back();
    if (!seen.insert(current).second) continue;
    if (!diagnostics_.charge(4, material_.span, Work::solving)) break;
    const Term& term = (*terms_)[current];
    if (term.kind == TermKind::parameter) found.insert(term.index);
    for (const TermId operand : operands(term)) waiting.push_back(operand);
  }
  return found;
}

/// Whether a term is made of one of these.
bool PerceptSolver::is_made_of(TermId id, const std::array<TermId, 2>& parts) const {
  std::set<TermId> seen;
  std::vector<TermId> waiting{id};
  const TermId first = std::min(parts[0], parts[1]);
  while (!waiting.empty()) {
    const TermId current = waiting.back();
    waiting.pop_back();
    if (current == parts[0] || current == parts[1]) return true;
    // Operands precede their users.
    if (current < first || !seen.insert(current).second) continue;
    if (!diagnostics_.charge(4, material_.span, Work::solving)) break;
    for (const TermId operand : operands((*terms_)[current])) waiting.push_back(operand);
  }
  return false;
}

/// Marks the parameters that scale the force of a solved carrier: they move the percept away from its level. A limit is
/// a factor that is made of the force itself. Of what it is made, only the limit is no part of the force; and a spring
/// or a wall is as stiff as before where it grows no more.
void PerceptSolver::mark_decalibrating(std::vector<Parameter>& parameters) const {
  for (const Told& told : told_) {
    if (!told.solved) continue;
    const Carrier& carrier = (*carriers_)[told.carrier];
    const std::array<TermId, 2> whole{carrier.force_x, carrier.force_y};
    const TermId force = carrier.force_x;
    const Extractor extractor = told.percept->extractor;
    const bool keeps_its_law = extractor == Extractor::stiffness || extractor == Extractor::wall_stiffness;
    if (!diagnostics_.charge(terms_->size() / 8, material_.span, Work::solving)) return;
    for (TermId id = force + 1; id < terms_->size(); ++id) {
      const Term& term = (*terms_)[id];
      const bool product = term.operation == Operation::multiply && (term.a == force || term.b == force);
      const bool quotient = term.operation == Operation::divide && term.a == force;
      if (term.kind != TermKind::operation || !(product || quotient)) continue;
      const TermId factor = term.a == force ? term.b : term.a;
      if (keeps_its_law && is_made_of(factor, whole)) continue;
      for (const std::uint32_t index : parameters_of(factor, whole)) {
        std::string& description = parameters[index].description;
        const std::string mark = fmt::format("(decalibrates {})", told.percept->name);
        if (!description.ends_with(mark)) description += (description.empty() ? "" : " ") + mark;
      }
    }
  }
}

void PerceptSolver::match(const AskedPercept& asked) {
  if (!diagnostics_.charge(1 + candidates_.size() / 4, asked.span, Work::solving)) return;
  const Percept& percept = this->percept(asked.name);
  std::vector<std::size_t> mine;
  std::vector<const Carrier*> open;
  for (const std::size_t i : candidates_) {
    const Carrier& carrier = (*carriers_)[i];
    if (percept.carrier.empty() || carrier.name != percept.carrier) continue;
    mine.push_back(i);
    if (carrier.open) open.push_back(&carrier);
  }
  const auto settle_all = [&] {
    for (const Carrier* carrier : open) settle(*carrier);
  };
  if (!percept.has_reference) {
    settle_all();
    return report(Code::untied_map, asked.place(),
                  fmt::format("expected a percept that has levels, found {}, which can only be compared", asked.name),
                  Advice(instead_of_a_level(percept))
                      .see(percept.span, "declared here"));
  }
  if (mine.empty()) {
    const std::string message = fmt::format("expected a force that carries {}, found none", asked.name);
    // Its author meant a force whose size is open for it: that is one mistake.
    const Carrier* meant = nullptr;
    for (const Carrier& carrier : *carriers_) {
      const auto tells = [&](const AskedPercept& each) {
        const Percept* of = declarations_.percepts.find(each.name);
        return of && of->carrier == carrier.name;
      };
      const bool fits = carrier.open && carrier.dimension == percept.carrier_dimension;
      if (fits && std::ranges::none_of(material_.percepts, tells)) meant = &carrier;
    }
    if (meant) {
      settle(*meant);
      return report(Code::percept_unrealised, asked.place(), message,
                    Advice(fmt::format("{} is carried by {}; write `{}` instead of `{}`", asked.name,
                                       carrier_words(percept.carrier), function_of(percept.carrier),
                                       function_of(meant->name)))
                        .see(meant->span, "this force has no size yet"));
    }
    return report(Code::percept_unrealised, asked.place(), message,
                  fmt::format("{} is carried by {}; add such a force", asked.name, carrier_words(percept.carrier)));
  }
  if (open.size() > 1) {
    settle_all();
    return report(Code::several_open, open[1]->span,
                  fmt::format("{} sizes are left open for one percept, {}", open.size(), asked.name), left_open(open));
  }
  settle_all();
  const Map* map = map_for(percept, asked);
  if (!map) return;
  const std::size_t index = open.empty() ? mine.front() : static_cast<std::size_t>(open[0] - carriers_->data());
  tell({.percept = &percept, .asked = &asked, .map = map, .carrier = index, .solved = !open.empty()});
}

/// Adds a percept. If several are told by the same carrier, the first one sets its size.
void PerceptSolver::tell(Told told) {
  constexpr std::size_t operations_of_a_law = 128, evaluations = 64;
  if (!diagnostics_.charge(operations_of_a_law + evaluations * told.map->terms.size(), material_.force_span,
                           Work::solving))
    return;
  const auto first = std::ranges::find(told_, told.carrier, &Told::carrier);
  if (first != told_.end()) {
    told.shares = static_cast<std::size_t>(first - told_.begin());
    told.solved = false;
  }
  told.law.emplace(*told.map, *told.percept);
  told_.push_back(std::move(told));
}

std::string PerceptSolver::chosen_by(const std::string& percept) const {
  const auto rule = device_.realise.find(percept);
  return rule == device_.realise.end() ? "" : rule->second.by;
}

const Map* PerceptSolver::map_for(const Percept& percept, const AskedPercept& asked) {
  const std::string by = asked.by.empty() ? chosen_by(asked.name) : asked.by;
  const MapChoice choice = choose_map(percept, device_, declarations_, by);
  if (!choice.map) report_choice(percept, asked, choice, by);
  return choice.map;
}

void PerceptSolver::report_choice(const Percept& percept, const AskedPercept& asked, const MapChoice& choice,
                                  const std::string& by) {
  if (!choice.rivals.empty()) {
    std::vector<std::string> names;
    for (const Map* map : choice.rivals) names.push_back(map->name.empty() ? "(no name)" : map->name);
    Advice advice = typeable("choose one after the level, as in `{} {:.2g}, by {}`: {}", asked.name, asked.level,
                             names.front(), fmt::format("{}", fmt::join(names, ", ")));
    for (const Map* map : choice.rivals) advice = std::move(advice).see(map->span, map->source);
    return report(Code::several_maps, asked.place(),
                  fmt::format("{} maps for {} fit `{}` equally well: {}", choice.rivals.size(), asked.name,
                              device_.profile.name, sources_of(choice.rivals)),
                  std::move(advice));
  }
  if (!choice.untied.empty()) {
    Advice advice = "remove the level, or measure a map with the percept's reference stimulus as its anchor";
    for (const Map* map : choice.untied) advice = std::move(advice).see(map->span, map->source);
    return report(Code::untied_map, asked.place(),
                  fmt::format("expected a map that can set a level of {}, found only maps that compare ({})",
                              asked.name, sources_of(choice.untied)),
                  std::move(advice));
  }
  if (!by.empty()) {
    std::vector<std::string> names;
    for (const Map* map : declarations_.maps())
      if (map->percept == percept.name && !map->name.empty()) names.push_back(map->name);
    const Span place = asked.by_span.value_or(asked.span);  // without one, the device's rule names the map
    return report(
        Code::unknown_name, place, fmt::format("no map for {} is called `{}`", asked.name, by),
        did_you_mean(place, by, names,
                     names.empty() ? "there is none with a name" : fmt::format("there are: {}", fmt::join(names, ", ")),
                     false));
  }
  report(Code::no_map, asked.place(),
         fmt::format("no map ties {} to a force on `{}`", percept.name, device_.profile.name),
         "declare one, as in calibration/maps/minsky1995.wale");
}

/// Reports a percept and a size in the physics that contradict each other, by more than a just noticeable difference,
/// the scatter of the map and the author's tolerance.
void PerceptSolver::check_conflict(const Told& told) {
  const Carrier& carrier = (*carriers_)[told.carrier];
  const AskedPercept& asked = *told.asked;
  const Map& map = *told.map;
  const auto size = told.shares != none ? std::optional(told_[told.shares].size)
                                        : constant_value(*terms_, carrier.size, &material_.parameters);
  if (!size || !map.couples.empty()) return;
  const Law& law = *told.law;
  const double level = law.level_of(*size), asked_size = law.carrier_of(asked.level);
  if (std::abs(std::log10(level) - std::log10(asked.level)) <= map.uncertainty.scatter) return;
  if (std::abs(level - asked.level) <= asked.tolerance) return;
  const Discrimination people(declarations_, told.percept->cue, device_.profile.name, told.percept->exerts);
  if (const Threshold* threshold = people.threshold(*size, asked_size); threshold && threshold->recalled())
    report(Code::unverified_basis, asked.place(),
           fmt::format("the threshold for {} rests on a figure that was recalled and not looked up ({})", asked.name,
                       threshold->source),
           Advice("take it as a guess until somebody has seen the source").see(threshold->span, "the threshold"));
  if (const auto apart = people.distance(*size, asked_size); apart && *apart <= 1) return;
  const std::string unit = declarations_.names().unit(carrier.dimension);
  const std::string argument = told.percept->argument();
  diagnostics_.report(
      {.code = Code::percept_conflict,
       .span = asked.place(),
       .message = readable("{} {:.3g} is asked for, but the given {} makes it {:.2g}", asked.name, asked.level,
                           argument, level),
       .expected = readable("{} {} of {:.3g} {}", std::string("aeiou").find(argument[0]) < 5 ? "an" : "a", argument,
                            asked_size, unit),
       .found = readable("{:.3g} {}", *size, unit),
       .help = readable("leave out the {}, so that it is solved from the percept; or leave out the percept", argument),
       .secondary = {{carrier.size_span, readable("gives {} {:.2g}", asked.name, level)}},
       .facts = {{"asked", NumberWithUnit{asked.level, ""}}, {"given", NumberWithUnit{level, ""}}}});
}

// ---- what couples what ----------------------------------------------------------------------------------------------

void PerceptSolver::couple() {
  for (Told& told : told_)
    for (const Coupling& coupling : told.map->couples) {
      const auto other =
          std::ranges::find_if(told_, [&](const Told& each) { return each.percept->name == coupling.percept; });
      told.couples.push_back(other == told_.end() ? none : static_cast<std::size_t>(other - told_.begin()));
    }
  std::vector<int> state(told_.size(), 0);  // 0 not seen, 1 on the way, 2 done
  for (std::size_t i = 0; i < told_.size(); ++i)
    if (!order_from(i, state)) return;
}

bool PerceptSolver::order_from(std::size_t index, std::vector<int>& state) {
  if (state[index] == 2) return true;
  const Told& told = told_[index];
  if (state[index] == 1) {
    report(Code::circular_couples, told.asked ? told.asked->span : material_.span,
           fmt::format("the maps of {} and of the percepts that it couples depend on each other ({})",
                       told.percept->name, told.map->source),
           Advice("choose another map for one of them").see(told.map->span, "couples the other"));
    return false;
  }
  state[index] = 1;
  if (told.shares != none && !order_from(told.shares, state)) return false;
  for (const std::size_t other : told.couples)
    if (other != none && !order_from(other, state)) return false;
  state[index] = 2;
  order_.push_back(index);
  return true;
}

std::vector<double> PerceptSolver::coupled_sizes(const Told& told) const {
  std::vector<double> sizes;
  for (const std::size_t other : told.couples) sizes.push_back(other == none ? 0 : told_[other].size);
  return sizes;
}

}  // namespace wale
