#include "compiler/grade/steps.hpp"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <iterator>

namespace wale {
namespace {

constexpr std::size_t most_switches = 64;  // of a program that are followed
constexpr std::size_t switch_seeds = 2048, seeds_in_all = 2048, fewest_seeds = 24;
constexpr int approaches = 14;            // steps of Newton's method to the line of a switch
constexpr double near_line = 0.02;        // of a step: the distance at which a hand is on the line
constexpr double at_least_near = 0.2;     // of a step: the same after all approaches
constexpr double seeds_apart = 3.0 / 64;  // of the patch's half extent: one and a half distances between seeds
constexpr double steps_with_memory = 8;   // in a tick of a brisk hand
constexpr std::size_t lines = 16, most_intervals = 512, bisected_intervals = 48;
constexpr int halvings_of_step = 6;
constexpr std::size_t parts_of_step = 4;
constexpr double beside_line = 0.0037;  // of a step: rounding may make a spike on the line itself, as wide as a float
constexpr double larger = 1.001;        // than the step in the middle: less is rounding
constexpr double halved_width = 1.1;    // of a step: the bracket that is halved
constexpr double most_at_once = 0.5;    // of a step's change: a smooth one has a twentieth of it
constexpr std::size_t steps_kept = 8;
constexpr std::size_t climbers_along = 6;  // steps from which larger ones are searched along the line of their switch
constexpr int climbs_along = 8;            // each half as far as the one before

void move(Hand& hand, const SteppedQuantity& quantity, std::size_t axis, double by) {
  (hand.*quantity.value)[static_cast<int>(axis)] += static_cast<float>(by);
  if (quantity.value == &Hand::position) hand.workspace[static_cast<int>(axis)] += static_cast<float>(by);
}

/// Keeps a step around the hand within the quantity's reach.
void keep_in_reach(Hand& hand, const SteppedQuantity& quantity) {
  const glm::vec2 most = glm::max(quantity.reach - glm::vec2(static_cast<float>(1.1 * quantity.step)), glm::vec2(0.0f));
  const glm::vec2 before = hand.*quantity.value, kept = glm::clamp(before, -most, most);
  hand.*quantity.value = kept;
  if (quantity.value == &Hand::position) hand.workspace += kept - before;
}

/// What a node switches on: a function that is 0 where it changes, and the node that has the same derivatives.
struct Switch {
  NodeId zero, derived;
};

/// Where this node may jump.
std::vector<Switch> jumps_of(Graph& graph, const Node& node) {
  const auto whole = [&](NodeId of) {
    const NodeId nearest = graph.apply(Operation::floor, graph.apply(Operation::add, of, graph.constant(0.5f)));
    return Switch{graph.apply(Operation::subtract, of, nearest), of};
  };
  switch (node.operation) {
    case Operation::less: {
      const NodeId difference = graph.apply(Operation::subtract, node.a, node.b);
      return {{difference, difference}};
    }
    case Operation::divide: return {{node.b, node.b}};
    case Operation::select:
    case Operation::arctangent: return {{node.a, node.a}};
    case Operation::floor: return {whole(node.a)};
    case Operation::hash: return {whole(node.a), whole(node.b), whole(node.c)};
    default: return {};
  }
}

/// Where the slope of this node may change, or is steepest.
std::vector<Switch> bends_of(Graph& graph, const Node& node) {
  const auto equal = [&](NodeId a, NodeId b) {
    const NodeId difference = graph.apply(Operation::subtract, a, b);
    return Switch{difference, difference};
  };
  switch (node.operation) {
    case Operation::minimum:
    case Operation::maximum: return {equal(node.a, node.b)};
    case Operation::limit: return {equal(graph.apply(Operation::absolute, node.a), node.b)};
    case Operation::exp2:
    case Operation::normal:
    case Operation::absolute:
    case Operation::square_root:
    case Operation::log2: return {{node.a, node.a}};
    default: return {};
  }
}

/// For each node, whether the force depends on it.
std::vector<char> needed_for_force(const LiftedTick& lifted) {
  std::vector<char> needed(lifted.graph.size());
  for (const NodeId force : lifted.force) needed[force] = true;
  for (auto id = static_cast<NodeId>(lifted.graph.size()); id-- > 0;)
    if (needed[id])
      for (const NodeId operand : lifted.graph.operands(id)) needed[operand] = true;
  return needed;
}

/// The change of the force over a width (m) along an axis that the slopes at both ends do not explain, N. A slope that
/// has no number, as that of a step as steep as floats allow, explains nothing.
double beyond_slopes(const ProgramSlopes::ByPlace& from, const ProgramSlopes::ByPlace& to, std::size_t axis,
                     double width) {
  glm::dvec2 beyond = to.force - from.force;
  for (const auto* end : {&from, &to}) {
    const glm::dvec2 slope(end->place[0][axis], end->place[1][axis]);
    if (std::isfinite(slope.x) && std::isfinite(slope.y)) beyond -= 0.5 * width * slope;
  }
  return glm::length(beyond);
}

bool is_larger(const ForceStep& a, const ForceStep& b) { return a.newton() > b.newton(); }

void largest_first(std::vector<ForceStep>& steps) { std::ranges::stable_sort(steps, is_larger); }

}  // namespace

std::array<SteppedQuantity, 3> stepped_quantities(const DeviceProfile& device, glm::vec2 extent, double speed) {
  const double count = device.position_step(), window = std::max(1.0, device.velocity_window);
  const glm::vec2 fast(static_cast<float>(speed));
  return {{{&HandSlopes::place, &Hand::position, {Input::x, Input::y}, count, extent},
           {&HandSlopes::velocity,
            &Hand::velocity,
            {Input::velocity_x, Input::velocity_y},
            count * device.rate / window,
            fast},
           {&HandSlopes::raw_velocity,
            &Hand::raw_velocity,
            {Input::raw_velocity_x, Input::raw_velocity_y},
            count * device.rate,
            fast}}};
}

double ForceStep::newton() const { return glm::length(change); }
bool ForceStep::jumps() const { return at_once > most_at_once * std::max(newton(), both_ways); }

void StepSearch::Hands::add(const Hand& hand, std::span<const float> of_it, std::size_t axis, std::size_t which) {
  hands.push_back(hand);
  states.insert(states.end(), of_it.begin(), of_it.end());
  axes.push_back(axis);
  switches.push_back(which);
}

StepSearch::StepSearch(const Bank& bank, ProgramSlopes& slopes)
    : bank_(bank), slopes_(slopes), state_count_(bank.program().description().states.size()), lifted_(lift(bank)) {
  force_.emplace(lifted_.graph, lifted_.force, bank_);
}

std::span<const float> StepSearch::states_of(std::span<const float> states, std::size_t hand) const {
  return states.subspan(hand * state_count_, state_count_);
}

std::vector<glm::dvec2> StepSearch::forces(std::span<const Hand> hands, std::span<const float> states) {
  force_->evaluate(hands, states, values_);
  std::vector<glm::dvec2> all(hands.size());
  for (std::size_t i = 0; i < hands.size(); ++i) {
    all[i] = {values_[i], values_[hands.size() + i]};
    if (!std::isfinite(all[i].x) || !std::isfinite(all[i].y)) all[i] = {0, 0};
  }
  return all;
}

/// Finds the switches that the force and this quantity meet in; false if there are none.
bool StepSearch::find_switches(const SteppedQuantity& quantity) {
  Graph& graph = lifted_.graph;
  const std::vector<char> needed = needed_for_force(lifted_);
  const auto by = [&](std::size_t axis) {
    return quantity.value == &Hand::position ? Derivatives::place(static_cast<int>(axis))
                                             : Derivatives::By{.inputs = {quantity.inputs[axis]}, .state = {}};
  };
  Derivatives along_x(graph, by(0), 1.0f / 16), along_y(graph, by(1), 1.0f / 16);
  std::vector<NodeId> roots;
  switch_count_ = 0;
  for (const auto& of : {jumps_of, bends_of})
    for (NodeId id = 0; id < needed.size(); ++id) {
      const Node node = graph[id];  // a copy: the graph grows
      if (!needed[id] || node.kind != Node::Kind::operation) continue;
      for (const Switch& changes : of(graph, node)) {
        const NodeId x = along_x(changes.derived), y = along_y(changes.derived);
        if (switch_count_ == most_switches || (graph.is_zero(x) && graph.is_zero(y))) continue;
        roots.insert(roots.end(), {changes.zero, x, y});
        ++switch_count_;
      }
    }
  if (switch_count_ == 0) return false;
  switches_.emplace(graph, roots, bank_);
  return switches_->fits();
}

/// The way to the line of a switch from a hand of the last evaluation, to first order; nothing where it is level.
std::optional<glm::dvec2> StepSearch::way(std::size_t which, std::size_t hand, std::size_t count) const {
  const auto value = [&](std::size_t root) { return static_cast<double>(values_[(3 * which + root) * count + hand]); };
  const glm::dvec2 slope(value(1), value(2));
  const double squares = glm::dot(slope, slope), zero = value(0);
  if (!(squares > 0) || !std::isfinite(squares) || !std::isfinite(zero)) return std::nullopt;
  return slope * (-zero / squares);
}

/// How far from a hand the line of a switch may be. A hand whose program remembers cannot be anywhere else at once.
double StepSearch::approach_from(const SteppedQuantity& quantity) const {
  const double apart = seeds_apart * std::max(quantity.reach.x, quantity.reach.y);
  return state_count_ > 0 ? std::min(apart, steps_with_memory * quantity.step) : apart;
}

/// Some of the hands that are near the line of a switch, for each switch.
StepSearch::Hands StepSearch::near_switches(const SteppedQuantity& quantity, std::span<const Hand> hands,
                                            std::span<const float> states) {
  const double reach = approach_from(quantity);
  const std::size_t every = std::max<std::size_t>(1, hands.size() / switch_seeds);
  Hands some, seeds;
  for (std::size_t i = 0; i < hands.size(); i += every) some.add(hands[i], states_of(states, i), 0);
  switches_->evaluate(some.hands, some.states, values_);
  const std::size_t most = std::max(fewest_seeds, seeds_in_all / switch_count_);
  for (std::size_t which = 0; which < switch_count_; ++which) {
    std::vector<std::size_t> near;
    for (std::size_t i = 0; i < some.hands.size(); ++i)
      if (const auto step = way(which, i, some.hands.size()); step && glm::length(*step) < reach) near.push_back(i);
    const std::size_t count = std::min(most, near.size());
    for (std::size_t i = 0; i < count; ++i) {
      const std::size_t hand = near[i * near.size() / count];
      seeds.add(some.hands[hand], states_of(some.states, hand), 0, which);
    }
  }
  return seeds;
}

/// The hands that Newton's method brings onto the line of their switch.
StepSearch::Hands StepSearch::on_lines_of_switches(const SteppedQuantity& quantity, Hands seeds) {
  const double reach = approach_from(quantity);
  Hands found;
  for (int round = 0; round < approaches && !seeds.hands.empty(); ++round) {
    switches_->evaluate(seeds.hands, seeds.states, values_);
    const std::size_t count = seeds.hands.size();
    Hands left;
    for (std::size_t i = 0; i < count; ++i) {
      const auto step = way(seeds.switches[i], i, count);
      if (!step || glm::length(*step) > reach) continue;
      const std::size_t axis = std::abs(step->y) > std::abs(step->x) ? 1 : 0;
      Hand hand = seeds.hands[i];
      const double near = round + 1 < approaches ? near_line : at_least_near;
      const bool there = glm::length(*step) < near * quantity.step;
      move(hand, quantity, 0, step->x), move(hand, quantity, 1, step->y);
      keep_in_reach(hand, quantity);
      (there ? found : left).add(hand, states_of(seeds.states, i), axis, seeds.switches[i]);
    }
    seeds = std::move(left);
  }
  return found;
}

/// The steps on the lines of switches, and larger ones further along the lines of the largest.
std::vector<ForceStep> StepSearch::at_switches(const SteppedQuantity& quantity, std::span<const Hand> hands,
                                               std::span<const float> states) {
  if (!find_switches(quantity)) return {};
  std::vector<ForceStep> steps =
      measured(quantity, on_lines_of_switches(quantity, near_switches(quantity, hands, states)));
  largest_first(steps);
  double along = approach_from(quantity);
  for (int climb = 0; climb < climbs_along && !steps.empty(); ++climb, along /= 2) {
    Hands tried;
    for (std::size_t i = 0; i < std::min(climbers_along, steps.size()); ++i)
      for (const double way : {-along, along}) {
        Hand hand = steps[i].hand;
        move(hand, quantity, 1 - steps[i].axis, way);
        keep_in_reach(hand, quantity);
        tried.add(hand, steps[i].states, 0, steps[i].which);
      }
    std::vector<ForceStep> more = measured(quantity, on_lines_of_switches(quantity, std::move(tried)));
    largest_first(more);
    const auto before = static_cast<std::ptrdiff_t>(steps.size());
    std::ranges::move(more, std::back_inserter(steps));
    std::ranges::inplace_merge(steps, steps.begin() + before, is_larger);
  }
  return steps;
}

/// Halves intervals of this width, which begin at the hands `low`, down to one step; keeps the half whose change the
/// slopes explain less. Returns the hands in the middle.
StepSearch::Hands StepSearch::bisected(const SteppedQuantity& quantity, Hands low, float width) {
  const bool has_slopes = quantity.value == &Hand::position;
  const std::size_t count = low.hands.size();
  for (; width > 1.001 * quantity.step; width /= 2) {
    Hands three;
    for (int end = 0; end < 3; ++end)
      for (std::size_t i = 0; i < count; ++i) {
        Hand hand = low.hands[i];
        move(hand, quantity, low.axes[i], 0.5 * end * width);
        three.add(hand, states_of(low.states, i), low.axes[i]);
      }
    const auto at = has_slopes ? slopes_.by_place(three.hands, three.states) : std::vector<ProgramSlopes::ByPlace>{};
    const auto force = has_slopes ? std::vector<glm::dvec2>{} : forces(three.hands, three.states);
    for (std::size_t i = 0; i < count; ++i) {
      const auto unexplained = [&](std::size_t half) {
        const std::size_t a = half * count + i, b = a + count;
        if (!has_slopes) return glm::length(force[b] - force[a]);
        return beyond_slopes(at[a], at[b], low.axes[i], 0.5 * width);
      };
      if (unexplained(1) > unexplained(0)) move(low.hands[i], quantity, low.axes[i], 0.5 * width);
    }
  }
  for (std::size_t i = 0; i < count; ++i) move(low.hands[i], quantity, low.axes[i], 0.5 * width);
  return low;
}

/// Hands in the middle of the steps that lines along both axes through some of the hands lead to, for a program without
/// states.
StepSearch::Hands StepSearch::on_lines(const SteppedQuantity& quantity, std::span<const Hand> hands) {
  const bool has_slopes = quantity.value == &Hand::position;
  const float longest = 2 * std::max(quantity.reach.x, quantity.reach.y);
  const auto intervals = static_cast<std::size_t>(
      std::clamp(std::ceil(longest / quantity.step), 1.0, static_cast<double>(most_intervals)));
  struct Interval {
    std::size_t line, number;
    double unexplained;
  };
  std::vector<Interval> found;
  Hands along;  // all hands of all lines, line by line
  for (std::size_t line = 0; line < 2 * lines; ++line) {
    const std::size_t base = (line / 2) * hands.size() / lines, axis = line % 2;
    for (std::size_t i = 0; i <= intervals; ++i) {
      Hand hand = hands[base];
      const float half = quantity.reach[static_cast<int>(axis)];
      const float at = half * (2 * static_cast<float>(i) / static_cast<float>(intervals) - 1);
      move(hand, quantity, axis, at - (hand.*quantity.value)[static_cast<int>(axis)]);
      along.add(hand, {}, axis);
    }
  }
  const auto at = has_slopes ? slopes_.by_place(along.hands, along.states) : std::vector<ProgramSlopes::ByPlace>{};
  const auto force = has_slopes ? std::vector<glm::dvec2>{} : forces(along.hands, along.states);
  for (std::size_t line = 0; line < 2 * lines; ++line)
    for (std::size_t i = 0; i < intervals; ++i) {
      const std::size_t a = line * (intervals + 1) + i, b = a + 1, axis = line % 2;
      double beyond = 0;
      if (has_slopes) {
        const double width = 2.0 * quantity.reach[static_cast<int>(axis)] / static_cast<double>(intervals);
        beyond = beyond_slopes(at[a], at[b], axis, width);
      } else {
        beyond = glm::length(force[b] - force[a]);
      }
      if (std::isfinite(beyond) && beyond > 0) found.push_back({line, i, beyond});
    }
  const std::size_t kept = std::min(bisected_intervals, found.size());
  std::ranges::partial_sort(found, found.begin() + static_cast<std::ptrdiff_t>(kept),
                            [](const Interval& a, const Interval& b) {
                              if (a.unexplained != b.unexplained) return a.unexplained > b.unexplained;
                              return a.line != b.line ? a.line < b.line : a.number < b.number;
                            });
  found.resize(kept);
  // Each axis has intervals of its own width.
  Hands middles;
  for (const std::size_t axis : {0, 1}) {
    Hands low;
    for (const Interval& each : found)
      if (each.line % 2 == axis) {
        const std::size_t a = each.line * (intervals + 1) + each.number;
        low.add(along.hands[a], {}, axis);
      }
    if (low.hands.empty()) continue;
    const float width = 2 * quantity.reach[static_cast<int>(axis)] / static_cast<float>(intervals);
    const Hands some = bisected(quantity, std::move(low), width);
    for (const Hand& hand : some.hands) middles.add(hand, {}, axis);
  }
  for (Hand& hand : middles.hands) keep_in_reach(hand, quantity);
  return middles;
}

/// The largest change over one step that begins at most a step before each hand, along its axis.
std::vector<ForceStep> StepSearch::measured(const SteppedQuantity& quantity, const Hands& middles) {
  const std::size_t count = middles.hands.size();
  std::vector<ForceStep> steps(count);
  /// The forces at places this far from hands (m or m/s), place by place.
  const auto at_all = [&](const std::vector<Hand>& from, std::span<const double> away) {
    std::vector<Hand> all;
    std::vector<float> states;
    for (const double by : away) {
      for (std::size_t i = 0; i < count; ++i) move(all.emplace_back(from[i]), quantity, middles.axes[i], by);
      states.insert(states.end(), middles.states.begin(), middles.states.end());
    }
    return forces(all, states);
  };
  std::array<double, 2 * parts_of_step + 1> around;
  for (std::size_t part = 0; part < around.size(); ++part)
    around[part] = quantity.step * (static_cast<double>(part) / parts_of_step - 1 + beside_line);
  std::vector<Hand> low = middles.hands;
  auto force = at_all(low, around);
  for (std::size_t i = 0; i < count; ++i) {
    ForceStep& step = steps[i];
    const auto change = [&](std::size_t from, std::size_t parts) {
      return force[(from + parts) * count + i] - force[from * count + i];
    };
    for (std::size_t place = 0; place < around.size(); ++place)
      step.largest = std::max(step.largest, glm::length(force[place * count + i]));
    // The step in the middle counts unless another is larger.
    std::size_t first = parts_of_step / 2;
    for (std::size_t from = 0; from <= parts_of_step; ++from)
      if (glm::length(change(from, parts_of_step)) > larger * glm::length(change(first, parts_of_step))) first = from;
    step.change = change(first, parts_of_step);
    for (std::size_t part = 0; part < parts_of_step; ++part) step.both_ways += glm::length(change(first + part, 1));
    step.hand = middles.hands[i], step.axis = middles.axes[i], step.which = middles.switches[i];
    move(step.hand, quantity, step.axis, around[first] + 0.5 * quantity.step);
    const auto states = states_of(middles.states, i);
    step.states.assign(states.begin(), states.end());
    move(low[i], quantity, step.axis, around[first]);
  }
  // A jump is often in the very middle of a step, where the halves of a bracket must not end.
  double width = halved_width * quantity.step;
  for (std::size_t i = 0; i < count; ++i) move(low[i], quantity, middles.axes[i], -0.3 * (width - quantity.step));
  for (int halving = 0; halving < halvings_of_step; ++halving, width /= 2) {
    force = at_all(low, std::array{0.0, 0.5 * width, width});
    for (std::size_t i = 0; i < count; ++i)
      if (glm::length(force[2 * count + i] - force[count + i]) > glm::length(force[count + i] - force[i]))
        move(low[i], quantity, middles.axes[i], 0.5 * width);
  }
  // Across what is left, since a spike as wide as a float is no jump, and `sign` has a value of its own at 0.
  force = at_all(low, std::array{-width, 2 * width});
  for (std::size_t i = 0; i < count; ++i) steps[i].at_once = glm::length(force[count + i] - force[i]);
  return steps;
}

std::vector<ForceStep> StepSearch::largest(const SteppedQuantity& quantity, std::span<const Hand> hands,
                                           std::span<const float> states) {
  if (!force_->fits() || hands.empty() || !(quantity.step > 0)) return {};
  std::vector<ForceStep> steps = at_switches(quantity, hands, states);
  if (state_count_ == 0)
    for (ForceStep& step : measured(quantity, on_lines(quantity, hands))) steps.push_back(std::move(step));
  largest_first(steps);
  // Of the smooth and of the sudden ones alike.
  std::vector<ForceStep> kept;
  std::array<std::size_t, 2> counts{};
  for (ForceStep& step : steps)
    if (step.newton() > 0 && counts[step.jumps()]++ < steps_kept) kept.push_back(std::move(step));
  return kept;
}

std::vector<ForceStep> StepSearch::around(const SteppedQuantity& quantity, std::span<const Hand> hands,
                                          std::span<const float> states) {
  if (!force_->fits()) return {};
  Hands both;
  for (std::size_t i = 0; i < hands.size(); ++i)
    for (const std::size_t axis : {0, 1}) {
      Hand hand = hands[i];
      keep_in_reach(hand, quantity);
      both.add(hand, states_of(states, i), axis);
    }
  return measured(quantity, both);
}

}  // namespace wale
