#include "compiler/lower.hpp"

#include "compiler/term.hpp"

namespace wale {

namespace {

std::vector<bool> reachable(const Terms& terms, const std::vector<TermId>& roots) {
  std::vector<bool> needed(terms.size(), false);
  for (const TermId root : roots) needed[root] = true;
  for (TermId id = static_cast<TermId>(terms.size()); id-- > 0;) {
    if (!needed[id]) continue;
    const Term& term = terms[id];
    const TermId operands[] = {term.a, term.b, term.c};
    int count = 0;
    if (term.kind == TermKind::operation) count = operand_count(term.operation);
    if (term.kind == TermKind::component || term.kind == TermKind::gradient || term.kind == TermKind::peak) count = 1;
    for (int i = 0; i < count; ++i) needed[operands[i]] = true;
  }
  return needed;
}

}  // namespace

LoweredMaterial lower(const SolvedMaterial& material) {
  const Terms& terms = material.terms;
  std::vector<TermId> roots{material.force[0], material.force[1]};
  if (material.relief) roots.push_back(*material.relief);
  for (const auto& percept : material.percepts)
    roots.insert(roots.end(), {percept.amplitude, percept.magnitude, percept.level});
  const auto needed = reachable(terms, roots);

  LoweredMaterial lowered;
  Graph& graph = lowered.graph;
  // The patch less its rim: where peaks are taken.
  const NodeId rim = graph.input(Input::patch_rim);
  const NodeId half_width = graph.apply(Operation::subtract, graph.input(Input::patch_half_width), rim);
  const NodeId half_height = graph.apply(Operation::subtract, graph.input(Input::patch_half_height), rim);

  std::vector<NodeId> nodes(terms.size(), 0);
  for (TermId id = 0; id < terms.size(); ++id) {
    if (!needed[id]) continue;
    const Term& term = terms[id];
    switch (term.kind) {
      case TermKind::literal: nodes[id] = graph.constant(static_cast<float>(term.value)); break;
      case TermKind::input: nodes[id] = graph.input(term.input(), term.span); break;
      case TermKind::parameter: nodes[id] = graph.parameter(term.index, term.span); break;
      case TermKind::operation:
        nodes[id] = graph.apply(term.operation, nodes[term.a], nodes[term.b], nodes[term.c], term.index, term.span);
        break;
      case TermKind::component: nodes[id] = graph.component(nodes[term.a], term.index, term.span); break;
      case TermKind::gradient: nodes[id] = derivative(graph, nodes[term.a], static_cast<int>(term.index)); break;
      case TermKind::peak: nodes[id] = graph.peak(nodes[term.a], half_width, half_height, term.span); break;
      case TermKind::open:
      case TermKind::magnitude:
      case TermKind::carrier: break;  // solved away
    }
  }

  lowered.ceiling = graph.constant(static_cast<float>(material.device.force_newton));
  for (int axis = 0; axis < 2; ++axis)
    lowered.force[axis] = graph.output_limit(nodes[material.force[axis]], lowered.ceiling, material.force_span);
  if (material.relief) lowered.relief = nodes[*material.relief];
  for (const auto& percept : material.percepts)
    lowered.percepts.push_back({nodes[percept.amplitude], nodes[percept.magnitude], nodes[percept.level]});
  return lowered;
}

}  // namespace wale
