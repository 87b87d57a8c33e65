#include "compiler/grade/own_rate.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <vector>

#include "compiler/grade/lift.hpp"

namespace wale {
namespace {

bool is_operation(const Node& node, Operation operation) {
  return node.kind == Node::Kind::operation && node.operation == operation;
}

/// The constant that a tick adds to a state, modulo 1: `next = sum - floor(sum)`, where `sum` is the state and a
/// number.
std::optional<double> turns_in_a_tick(const Graph& graph, NodeId next, std::uint32_t state) {
  const Node& difference = graph[next];
  if (!is_operation(difference, Operation::subtract)) return std::nullopt;
  const Node& whole = graph[difference.b];
  if (!is_operation(whole, Operation::floor) || whole.a != difference.a) return std::nullopt;
  const Node& sum = graph[difference.a];
  if (!is_operation(sum, Operation::add)) return std::nullopt;
  for (const auto& [now, step] : {std::pair(sum.a, sum.b), std::pair(sum.b, sum.a)})
    if (graph[now].kind == Node::Kind::state && graph[now].index == state && graph[step].kind == Node::Kind::constant)
      return std::abs(static_cast<double>(graph[step].value()));
  return std::nullopt;
}

/// What lattice noise takes its cells from. Noise that is sampled seldom is noise still, of the same size.
std::vector<bool> of_noise(const Graph& graph) {
  std::vector<bool> found(graph.size());
  for (NodeId id = static_cast<NodeId>(graph.size()); id-- > 0;) {
    const Node& node = graph[id];
    if (node.kind != Node::Kind::operation || !(found[id] || node.operation == Operation::hash)) continue;
    const int operands = facts(node.operation).operands;
    const NodeId from[] = {node.a, node.b, node.c};
    for (int i = 0; i < operands; ++i) found[from[i]] = true;
  }
  return found;
}

}  // namespace

double fastest_own_rate(const Bank& bank) {
  const PatchProgram& program = bank.program().description();
  const auto is_time = [](RegisterNumber number) { return number == static_cast<RegisterNumber>(Input::time); };
  const bool reads_time = std::ranges::any_of(program.tick, [&](const Instruction& instruction) {
    return is_time(instruction.a) || is_time(instruction.b) || is_time(instruction.c);
  });
  if (program.states.empty() && !reads_time) return 0;
  LiftedTick lifted = lift(bank);
  double fastest = 0;
  for (std::uint32_t state = 0; state < program.states.size(); ++state)
    if (const auto turns = turns_in_a_tick(lifted.graph, lifted.next[state], state))
      fastest = std::max(fastest, *turns * program.device.rate);
  if (!reads_time) return fastest;
  Derivatives by_time(lifted.graph, {.inputs = {Input::time}, .state = {}});
  const auto size = static_cast<NodeId>(lifted.graph.size());
  const std::vector<bool> noise = of_noise(lifted.graph);
  for (NodeId id = 0; id < size; ++id) {
    const Node node = lifted.graph[id];  // a copy: the graph grows
    const bool turns = is_operation(node, Operation::sine) || is_operation(node, Operation::cosine);
    if (!turns && !is_operation(node, Operation::floor)) continue;
    if (!turns && (noise[id] || noise[node.a])) continue;
    const Node& change = lifted.graph[by_time(node.a)];
    if (change.kind != Node::Kind::constant) continue;
    const double cycle = turns ? 2 * std::numbers::pi : 1;
    fastest = std::max(fastest, std::abs(static_cast<double>(change.value())) / cycle);
  }
  return fastest;
}

}  // namespace wale
