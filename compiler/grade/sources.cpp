#include "compiler/grade/sources.hpp"

#include <algorithm>
#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "compiler/measure/hands.hpp"
#include "compiler/read/dependence.hpp"

namespace wale {
namespace {

constexpr double share_of_work = 0.01;       // of the energy in both directions; smaller net energy is rounding
constexpr std::size_t places_all_over = 12;  // that are visited
constexpr float visits_apart = 0.005f;       // m
constexpr float visited_part = 0.9f;         // of the patch's half extents

glm::vec2 half_patch(const Bank& bank) { return 0.5f * glm::vec2(bank.size().width, bank.size().height); }

/// Where the force pushes most along the hand's motion.
struct Push {
  double watt = 0;
  Hand hand;
};

Push strongest_push(const SoughtSources& sought) {
  const auto& [hands, states, at] = sought.looked_at;
  Push most;
  const auto look = [&](const Hand& hand, glm::dvec2 force) {
    if (const double watt = glm::dot(force, glm::dvec2(hand.velocity)); watt > most.watt) most = {watt, hand};
  };
  for (std::size_t i = 0; i < hands.size(); ++i) look(hands[i], at[i].force);
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
  const auto there = sought.slopes.by_place(anywhere, met);
  for (std::size_t i = 0; i < anywhere.size(); ++i) look(anywhere[i], there[i].force);
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
bool find_power(const SoughtSources& sought, const ExploredPower& found, const Push& push, Energy& energy) {
  if (found.gained > std::max(sought.least_watt, share_of_work * found.moved)) energy.source_watt = found.gained;
  // What a bristle returns is less than it took, also if its force comes and goes by itself: of a program with a memory
  // of the hand, the power of one moment says nothing.
  const PatchProgram& program = sought.bank.program().description();
  const bool driven = !program.states.empty() && !remembers_time_only(program);
  if (push.watt > sought.least_watt && (driven ? found.pushed : found.moved / 2) > sought.least_watt) {
    energy.reasons.push_back("something in it moves by itself");
    // A hand that moved along with it could gain half of the energy in both directions.
    energy.source_watt = std::max(energy.source_watt, found.moved / 2);
  } else if (energy.source_watt > 0) {
    energy.reasons.push_back("its memory returns more energy than it received");
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
  if (const auto centres = places_to_visit(sought, push); !centres.empty()) {
    Exploration there = visit(sought.bank, sought.hand, centres, reads(program, {Input::button}));
    there.hands.clear(), there.states.clear();
    exploration->add(std::move(there));
  }
  // A power is that of the usual way; other ways count if that one finds none.
  if (find_power(sought, exploration->usual, push, energy) || find_power(sought, exploration->beyond, push, energy))
    return;
  // A program of places and times alone may push where no hand went: nothing that it remembers takes that back.
  if (push.watt <= sought.least_watt || (!program.states.empty() && !remembers_time_only(program))) return;
  energy.reasons.push_back("something in it moves by itself");
  energy.source_watt = push.watt / 2;
}

}  // namespace wale
