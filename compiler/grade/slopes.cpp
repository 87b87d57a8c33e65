#include "compiler/grade/slopes.hpp"

#include <algorithm>
#include <array>
#include <utility>

namespace wale {
namespace {

constexpr float slope_difference = 1.0f / 16;  // samples of a table

struct HandQuantity {
  Slopes HandSlopes::*slopes;
  std::array<Derivatives::By, 2> by;
};

std::vector<HandQuantity> hand_quantities() {
  const auto input = [](Input input) { return Derivatives::By{.inputs = {input}, .state = {}}; };
  return {{&HandSlopes::place, {Derivatives::place(0), Derivatives::place(1)}},
          {&HandSlopes::velocity, {input(Input::velocity_x), input(Input::velocity_y)}},
          {&HandSlopes::raw_velocity, {input(Input::raw_velocity_x), input(Input::raw_velocity_y)}},
          {&HandSlopes::acceleration, {input(Input::acceleration_x), input(Input::acceleration_y)}},
          {&HandSlopes::raw_acceleration, {input(Input::raw_acceleration_x), input(Input::raw_acceleration_y)}}};
}

/// For each node, whether it depends on a node for which `leaf` is true.
template <typename Leaf>
std::vector<char> depending(const Graph& graph, const Leaf& leaf) {
  std::vector<char> depends(graph.size(), false);
  for (NodeId id = 0; id < graph.size(); ++id) {
    depends[id] = leaf(graph[id]);
    for (const NodeId operand : graph.operands(id)) depends[id] = depends[id] || depends[operand];
  }
  return depends;
}

bool is_input(const Node& node, std::initializer_list<Input> inputs) {
  return node.kind == Node::Kind::input && std::ranges::find(inputs, static_cast<Input>(node.index)) != inputs.end();
}

bool is_of_the_hand(const Node& node) { return node.kind == Node::Kind::input && !is_input(node, {Input::time}); }

}  // namespace

void ProgramSlopes::find_dependences(const std::vector<char>& changing) {
  const Graph& graph = lifted_.graph;
  const auto either = [&](const std::vector<char>& depends) {
    return depends[lifted_.force[0]] || depends[lifted_.force[1]];
  };
  depends_on_motion_ = either(depending(graph, [](const Node& node) {
    return is_input(
        node, {Input::velocity_x, Input::velocity_y, Input::raw_velocity_x, Input::raw_velocity_y,
               Input::acceleration_x, Input::acceleration_y, Input::raw_acceleration_x, Input::raw_acceleration_y});
  }));

  // A state is driven if its new value depends on the hand or on a driven state.
  std::vector<char> driven(states_, false);
  for (bool more = true; std::exchange(more, false);) {
    const auto depends = depending(graph, [&](const Node& node) {
      return is_of_the_hand(node) || (node.kind == Node::Kind::state && driven[node.index]);
    });
    for (std::size_t state = 0; state < states_; ++state)
      if (!driven[state] && depends[lifted_.next[state]]) driven[state] = more = true;
  }
  const auto is_source = [&](const Node& node) {
    if (is_input(node, {Input::time})) return true;
    return node.kind == Node::Kind::state && !driven[node.index] && changing[node.index];
  };
  moves_by_itself_ = either(depending(graph, is_source));
  // A driven state may also depend on a source.
  const auto by_itself = depending(graph, is_source);
  const auto through_states =
      depending(graph, [&](const Node& node) { return node.kind == Node::Kind::state && driven[node.index]; });
  if (either(through_states))
    for (std::size_t state = 0; state < states_; ++state)
      moves_by_itself_ = moves_by_itself_ || (driven[state] && by_itself[lifted_.next[state]]);
}

ProgramSlopes::ProgramSlopes(const Bank& bank, const std::vector<char>& changing)
    : bank_(bank), states_(bank.program().description().states.size()) {
  if (states_ > most_graded_states) return;
  lifted_ = lift(bank);
  find_dependences(changing);
  std::vector<NodeId> roots(lifted_.force.begin(), lifted_.force.end());
  for (int axis = 0; axis < 2; ++axis) {
    Derivatives derivative(lifted_.graph, Derivatives::place(axis), slope_difference);
    for (const NodeId force : lifted_.force) roots.push_back(derivative(force));
  }
  place_field_.emplace(lifted_.graph, roots, bank_);
}

/// Derives the force and the new value of each state by all quantities on which they depend.
void ProgramSlopes::derive_all() {
  Graph& graph = lifted_.graph;
  std::vector<NodeId> results(lifted_.force.begin(), lifted_.force.end());
  results.insert(results.end(), lifted_.next.begin(), lifted_.next.end());
  std::vector<NodeId> roots(lifted_.force.begin(), lifted_.force.end());
  const NodeId size = static_cast<NodeId>(graph.size());
  const auto reads = [&](const Derivatives::By& by) {
    for (NodeId id = 0; id < size; ++id)
      if (graph[id].kind == Node::Kind::input &&
          std::ranges::find(by.inputs, static_cast<Input>(graph[id].index)) != by.inputs.end())
        return true;
    return false;
  };
  const auto derive = [&](const Derivatives::By& by) {
    Derivatives derivative(graph, by, slope_difference);
    for (const NodeId result : results) roots.push_back(derivative(result));
  };
  for (const HandQuantity& quantity : hand_quantities()) {
    if (!reads(quantity.by[0]) && !reads(quantity.by[1])) continue;
    quantities_.push_back(quantity.slopes);
    derive(quantity.by[0]);
    derive(quantity.by[1]);
  }
  for (std::uint32_t state = 0; state < states_; ++state) derive({.inputs = {}, .state = state});
  field_.emplace(graph, roots, bank_);
}

std::vector<ProgramSlopes::At> ProgramSlopes::at(std::span<const Hand> hands, std::span<const float> states) {
  if (!field_) derive_all();
  if (!field_->fits()) return {};
  field_->evaluate(hands, states, values_);
  const std::size_t results = 2 + states_;
  std::vector<At> all(hands.size());
  for (std::size_t hand = 0; hand < hands.size(); ++hand) {
    std::size_t root = 0;
    const auto next = [&] { return static_cast<double>(values_[root++ * hands.size() + hand]); };
    At& here = all[hand];
    LinearProgram& linear = here.linear;
    linear.states = states_;
    here.force.x = next(), here.force.y = next();
    linear.input.resize((states_ + 1) / 2);
    for (const auto quantity : quantities_)
      for (std::size_t column = 0; column < 2; ++column)
        for (std::size_t result = 0; result < results; ++result) {
          HandSlopes& slopes = result < 2 ? linear.direct : linear.input[(result - 2) / 2];
          (slopes.*quantity)[result % 2][column] = next();
        }
    linear.output.resize(2 * states_);
    linear.carry.resize(states_ * states_);
    for (std::size_t state = 0; state < states_; ++state)
      for (std::size_t result = 0; result < results; ++result)
        (result < 2 ? linear.output[result * states_ + state] : linear.carry[(result - 2) * states_ + state]) = next();
  }
  return all;
}

std::vector<ProgramSlopes::ByPlace> ProgramSlopes::by_place(std::span<const Hand> hands,
                                                            std::span<const float> states) {
  place_field_->evaluate(hands, states, values_);
  std::vector<ByPlace> all(hands.size());
  for (std::size_t hand = 0; hand < hands.size(); ++hand) {
    const auto value = [&](std::size_t root) { return static_cast<double>(values_[root * hands.size() + hand]); };
    all[hand].force = {value(0), value(1)};
    all[hand].place = {{{value(2), value(4)}, {value(3), value(5)}}};
  }
  return all;
}

}  // namespace wale
