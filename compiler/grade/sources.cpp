#include "compiler/grade/sources.hpp"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <numbers>

#include "compiler/grade/exploring_place.hpp"
#include "compiler/measure/hands.hpp"
#include "compiler/read/dependence.hpp"

namespace wale {
namespace {

constexpr double share_of_work = 0.01;       // of the energy in both directions; smaller net energy is rounding
constexpr std::size_t places_all_over = 12;  // that are visited
constexpr float visits_apart = 0.005f;       // m
constexpr float visited_part = 0.9f;         // of the patch's half extents
constexpr std::size_t mean_moments = 12;     // over which the mean of the force at a place is taken
constexpr std::size_t most_of_run = 512;     // hands of one way whose power is summed up

glm::vec2 half_patch(const Bank& bank) { return 0.5f * glm::vec2(bank.size().width, bank.size().height); }

/// Whether what the program remembers depends on the hand.
bool is_driven(const PatchProgram& program) { return !program.states.empty() && !remembers_time_only(program); }

/// The force at each hand's place that does not move by itself, N: a spring beside a source gives back only what it
/// took. It is the mean over some of the moments of these hands, or, if the program remembers the hand, the force on
/// one that has just entered there. The hands rest, so drag is not in it.
std::vector<glm::dvec2> still_forces(const SoughtSources& sought, std::span<const Hand> hands,
                                     std::span<const float> states) {
  std::vector<Hand> rest(hands.begin(), hands.end());
  for (Hand& hand : rest)
    hand.velocity = hand.raw_velocity = hand.acceleration = hand.raw_acceleration = glm::vec2(0.0f);
  std::vector<glm::dvec2> still(hands.size(), glm::dvec2(0));
  const PatchProgram& program = sought.bank.program().description();
  if (is_driven(program)) {
    std::vector<Force> forces(rest.size());
    tick_all(sought.bank, rest, forces);
    for (std::size_t i = 0; i < rest.size(); ++i) still[i] = glm::dvec2(forces[i]);
    return still;
  }
  const std::size_t count = program.states.size();
  std::vector<float> met(rest.size() * count);
  for (std::size_t moment = 0; moment < mean_moments; ++moment) {
    // In golden sections, so that no rate meets all moments in the same phase.
    const double part = std::fmod(0.5 + static_cast<double>(moment) / std::numbers::phi, 1.0);
    const auto from = static_cast<std::size_t>(part * static_cast<double>(hands.size()));
    for (Hand& hand : rest) hand.time = hands[from].time;
    for (std::size_t i = 0; i < rest.size(); ++i)
      std::ranges::copy(states.subspan(from * count, count), met.begin() + static_cast<std::ptrdiff_t>(i * count));
    const auto there = sought.slopes.by_place(rest, met);
    for (std::size_t i = 0; i < rest.size(); ++i) still[i] += there[i].force / (1.0 * mean_moments);
  }
  return still;
}

/// The largest mean power, W, with which the force pushes the hands of a way along their motion, beside what it gives
/// at rest; also of hands that go the same way more slowly, which drag takes less from.
double given_on_way(const SoughtSources& sought, std::span<const Hand> all, std::span<const float> of_all) {
  const PatchProgram& program = sought.bank.program().description();
  const std::size_t count = program.states.size(), every = 1 + all.size() / most_of_run;
  std::vector<Hand> hands;
  std::vector<float> states;
  for (std::size_t i = 0; i < all.size(); i += every) {
    hands.push_back(all[i]);
    const auto of_it = of_all.subspan(i * count, count);
    states.insert(states.end(), of_it.begin(), of_it.end());
  }
  if (hands.empty()) return 0;
  const auto still = still_forces(sought, hands, states);
  const bool slowly = sought.slopes.depends_on_motion() && !is_driven(program);
  double most = 0;
  for (const double pace : slower_paces) {
    std::vector<Hand> slow = hands;
    for (Hand& hand : slow) hand.velocity *= static_cast<float>(pace), hand.raw_velocity *= static_cast<float>(pace);
    const auto at = sought.slopes.by_place(slow, states);
    double sum = 0;
    for (std::size_t i = 0; i < slow.size(); ++i)
      sum += std::max(0.0, glm::dot(at[i].force - still[i], glm::dvec2(slow[i].velocity)));
    if (std::isfinite(sum)) most = std::max(most, sum / static_cast<double>(slow.size()));
    if (!slowly) break;
  }
  return most;
}

/// The largest such power on the usual ways, or on the others.
double given(const SoughtSources& sought, const Exploration& found, bool usual) {
  const std::size_t count = sought.bank.program().description().states.size();
  double most = 0;
  for (const auto& [begin, end, is_usual] : found.runs)
    if (is_usual == usual)
      most = std::max(most, given_on_way(sought, std::span(found.hands).subspan(begin, end - begin),
                                         std::span(found.states).subspan(begin * count, (end - begin) * count)));
  return most;
}

/// Where the force pushes most along the hand's motion, beside what it gives at rest.
struct Push {
  double watt = 0;
  Hand hand;
};

Push strongest_push(const SoughtSources& sought) {
  const auto& [hands, states, at] = sought.looked_at;
  Push most;
  const auto look_at = [&](std::span<const Hand> all, std::span<const float> of_all,
                           std::span<const ProgramSlopes::ByPlace> there) {
    const auto still = still_forces(sought, all, of_all);
    for (std::size_t i = 0; i < all.size(); ++i) {
      const double watt = glm::dot(there[i].force - still[i], glm::dvec2(all[i].velocity));
      if (watt > most.watt) most = {watt, all[i]};
    }
  };
  look_at(hands, states, at);
  const PatchProgram& program = sought.bank.program().description();
  if (!remembers_time_only(program)) return most;
  // What it remembers goes by time alone, so any hand may meet it at any place.
  std::vector<Hand> anywhere =
      hands_in_motion(lattice_hands, half_patch(sought.bank), static_cast<float>(sought.hand.speed()));
  std::vector<float> met;
  const std::size_t count = program.states.size();
  for (std::size_t i = 0; i < anywhere.size(); ++i) {
    const std::size_t from = i * hands.size() / anywhere.size();
    anywhere[i].time = hands[from].time;
    const auto states_of = states.subspan(from * count, count);
    met.insert(met.end(), states_of.begin(), states_of.end());
  }
  look_at(anywhere, met, sought.slopes.by_place(anywhere, met));
  return most;
}

/// The hands around which others look for energy: where a step says that another program begins, where the force
/// pushes most, and some all over the patch. None for a program that is the same everywhere.
std::vector<Hand> places_to_visit(const SoughtSources& sought, const Push& push) {
  const PatchProgram& program = sought.bank.program().description();
  const bool by_place = reads(program, {Input::x, Input::y, Input::workspace_x, Input::workspace_y});
  if (!by_place && !reads(program, {Input::button})) return {};
  const glm::vec2 extent = visited_part * half_patch(sought.bank);
  std::vector<Hand> centres = hands_at_rest(by_place ? places_all_over : 1, extent);
  if (push.watt > 0) centres.push_back(push.hand);
  for (const ForceStep& step : sought.steps) {
    const auto is_near = [&](const Hand& centre) {
      return glm::distance(centre.position, step.hand.position) < visits_apart;
    };
    if (std::ranges::none_of(centres, is_near)) centres.push_back(step.hand);
  }
  for (Hand& centre : centres) centre.position = glm::clamp(centre.position, -extent, extent);
  return centres;
}

/// Sets the power of the sources if hands found any.
bool find_power(const SoughtSources& sought, const ExploredPower& found, const Push& push, double given,
                Energy& energy) {
  if (found.gained > std::max(sought.least_watt, share_of_work * found.moved)) energy.source_watt = found.gained;
  // What a bristle returns is less than it took, also if its force comes and goes by itself: the power of one moment
  // says nothing. What a hand takes that moves along whenever it is pushed is what the pushes give, less the drag.
  if (push.watt > sought.least_watt && given > sought.least_watt) {
    energy.reasons.push_back("something in it moves by itself");
    energy.source_watt = std::max(energy.source_watt, given);
  } else if (energy.source_watt > 0) {
    const PatchProgram& program = sought.bank.program().description();
    const bool remembers = !program.states.empty() || !program.grids.empty();
    energy.reasons.push_back(remembers
                                 ? "its memory returns more energy than it received"
                                 : "it goes by the hand's acceleration, and returns more energy than it received");
  }
  return energy.source_watt > 0;
}

}  // namespace

Exploration explore_with_button(const Bank& bank, const GradingHand& hand) {
  Exploration found = explore(bank, hand, false);
  if (reads(bank.program().description(), {Input::button})) found.add(explore(bank, hand, true));
  return found;
}

void find_sources(const SoughtSources& sought, std::optional<Exploration>& exploration, Energy& energy) {
  const PatchProgram& program = sought.bank.program().description();
  const bool own = sought.slopes.moves_by_itself();
  if (!own && !exploration) return;
  const Push push = own ? strongest_push(sought) : Push{};
  if (!exploration && push.watt <= sought.least_watt) return;
  if (!exploration) exploration = explore_with_button(sought.bank, sought.hand);
  double elsewhere = 0;
  if (const auto centres = places_to_visit(sought, push); !centres.empty()) {
    Exploration there = visit(sought.bank, sought.hand, centres, reads(program, {Input::button}));
    if (own) elsewhere = given(sought, there, false);
    there.hands.clear(), there.states.clear(), there.runs.clear();
    exploration->add(std::move(there));
  }
  // A power is that of the usual way; other ways count if that one finds none.
  if (find_power(sought, exploration->usual, push, own ? given(sought, *exploration, true) : 0, energy)) return;
  if (own) elsewhere = std::max(elsewhere, given(sought, *exploration, false));
  if (find_power(sought, exploration->beyond, push, elsewhere, energy)) return;
  // A program of places and times alone may push where no hand went: nothing that it remembers takes that back.
  if (push.watt <= sought.least_watt || is_driven(program)) return;
  energy.reasons.push_back("something in it moves by itself");
  energy.source_watt = push.watt / 2;
}

}  // namespace wale
