#include "compiler/emit/lower.hpp"

#include <algorithm>

#include "compiler/graph/term.hpp"

namespace wale {

namespace {

/// Every term that a program computes.
std::vector<TermId> roots_of(const SolvedMaterial& material) {
  std::vector<TermId> roots{material.force[0], material.force[1]};
  if (material.relief) roots.push_back(*material.relief);
  if (material.colour) roots.insert(roots.end(), material.colour->begin(), material.colour->end());
  for (const auto& state : material.states) roots.insert(roots.end(), {state.initial, state.next});
  for (const auto& write : material.writes) roots.insert(roots.end(), {write.u, write.v, write.value});
  for (const auto& mark : material.marks) roots.insert(roots.end(), mark.operands.begin(), mark.operands.end());
  for (const auto& percept : material.percepts)
    roots.insert(roots.end(), {percept.amplitude, percept.magnitude, percept.level});
  return roots;
}

/// The terms that the roots are worked out from, in the order in which they become nodes: what was solved for as it was
/// put together, then what each root needs besides. Operands stand before their users, here too.
std::vector<TermId> needed_for(const std::vector<TermId>& roots, const Terms& terms, TermId solutions_end) {
  enum class Mark : char { none, asked_for, entered };
  std::vector<Mark> marks(terms.size(), Mark::none);
  std::vector<TermId> order, others;
  others.reserve(terms.size());
  for (const TermId root : roots) {
    if (marks[root] != Mark::none) continue;
    marks[root] = Mark::asked_for;
    const auto first = static_cast<std::ptrdiff_t>(others.size());
    std::size_t waiting = root >= solutions_end ? 1 : 0;  // of what is no solution
    for (TermId id = root; waiting > 0; --id) {
      if (marks[id] != Mark::asked_for) continue;
      --waiting;
      marks[id] = Mark::entered;
      others.push_back(id);
      for (const TermId operand : operands(terms[id])) {
        if (marks[operand] != Mark::none) continue;
        marks[operand] = Mark::asked_for;
        if (operand >= solutions_end) ++waiting;
      }
    }
    std::reverse(others.begin() + first, others.end());
  }
  // By now it is known which of the solutions anybody needs.
  order.reserve(terms.size());
  for (TermId id = solutions_end; id-- > 0;) {
    if (marks[id] != Mark::asked_for) continue;
    order.push_back(id);
    for (const TermId operand : operands(terms[id])) marks[operand] = Mark::asked_for;
  }
  std::ranges::reverse(order);
  order.insert(order.end(), others.begin(), others.end());
  return order;
}

}  // namespace

LoweredMaterial lower(const SolvedMaterial& material) {
  const Terms& terms = material.terms;
  const std::vector<TermId> needed = needed_for(roots_of(material), terms, material.solutions_end);

  LoweredMaterial lowered;
  Graph& graph = lowered.graph;
  graph.reserve(needed.size() + needed.size() / 4);  // about as many: gradients add some, constants fold
  graph.attribute(material.span);
  // The patch less its rim: where peaks are taken.
  const NodeId rim = graph.input(Input::patch_rim);
  const NodeId half_width = graph.apply(Operation::subtract, graph.input(Input::patch_half_width), rim);
  const NodeId half_height = graph.apply(Operation::subtract, graph.input(Input::patch_half_height), rim);

  std::vector<NodeId> nodes(terms.size(), 0);
  std::array derivative{Derivatives(graph, Derivatives::place(0)), Derivatives(graph, Derivatives::place(1))};
  for (const TermId id : needed) {
    const Term& term = terms[id];
    graph.attribute(term.span == Span{} ? material.span : term.span);
    switch (term.kind) {
      case TermKind::literal: nodes[id] = graph.constant(static_cast<float>(term.value)); break;
      case TermKind::input: nodes[id] = graph.input(term.input(), term.span); break;
      case TermKind::parameter: nodes[id] = graph.parameter(term.index, term.span); break;
      case TermKind::state: nodes[id] = graph.state(term.index, term.span); break;
      case TermKind::operation:
        nodes[id] = graph.apply(term.operation, nodes[term.a], nodes[term.b], nodes[term.c], term.index, term.span);
        break;
      case TermKind::settled: nodes[id] = nodes[term.a]; break;
      case TermKind::component: nodes[id] = graph.component(nodes[term.a], term.index, term.span); break;
      case TermKind::gradient: nodes[id] = derivative[term.index](nodes[term.a]); break;
      case TermKind::peak: nodes[id] = graph.peak(nodes[term.a], half_width, half_height, term.span); break;
      case TermKind::open:
      case TermKind::cells:
      case TermKind::magnitude:
      case TermKind::carrier: break;  // solved away
    }
  }

  const auto& vibration = material.device.shaker;
  lowered.ceiling.fill(graph.constant(static_cast<float>(material.device.most())));
  if (vibration) lowered.ceiling[1] = graph.constant(static_cast<float>(vibration->frequency_high));
  for (std::size_t axis = 0; axis < 2; ++axis)
    lowered.force[axis] = graph.output_limit(nodes[material.force[axis]], lowered.ceiling[axis], material.force_span);
  const auto node_of = [&](TermId id) { return nodes[id]; };
  if (material.relief) lowered.relief = node_of(*material.relief);
  if (material.colour)
    lowered.colour = {node_of((*material.colour)[0]), node_of((*material.colour)[1]), node_of((*material.colour)[2])};
  for (const auto& state : material.states) lowered.states.push_back({node_of(state.initial), node_of(state.next)});
  for (const auto& write : material.writes)
    lowered.writes.push_back({node_of(write.u), node_of(write.v), node_of(write.value)});
  for (const auto& mark : material.marks) {
    auto& operands = lowered.marks.emplace_back();
    for (const TermId operand : mark.operands) operands.push_back(node_of(operand));
  }
  for (const auto& percept : material.percepts)
    lowered.percepts.push_back({node_of(percept.amplitude), node_of(percept.magnitude), node_of(percept.level)});
  return lowered;
}

}  // namespace wale
