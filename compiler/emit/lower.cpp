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

/// The terms that the roots need, in the order in which they become nodes: first the solutions in their own order, then
/// the other terms of each root. Operands come before their users. Nothing if that takes too much work, which is
/// reported.
std::optional<std::vector<TermId>> needed_for(const std::vector<TermId>& roots, const SolvedMaterial& material,
                                              Diagnostics& diagnostics) {
  const Terms& terms = material.terms;
  const TermId solutions_end = material.solutions_end;
  enum Mark : char { none, asked_for, entered };
  std::vector<char> marks(terms.size(), none);
  std::vector<TermId> others(terms.size());
  std::size_t count = 0, waiting = 0;  // counts terms that are not solutions
  char* const mark = marks.data();
  const auto ask = [&](TermId id) {
    waiting += mark[id] == none && id >= solutions_end ? 1 : 0;
    mark[id] = std::max<char>(mark[id], asked_for);
  };
  const auto ask_for_operands = [&](const Term& term) {
    if (term.operands > 0) ask(term.a);
    if (term.operands > 1) ask(term.b);
    if (term.operands > 2) ask(term.c);
  };
  for (const TermId root : roots) {
    const std::size_t first = count;
    ask(root);
    TermId id = root;
    for (; waiting > 0; --id) {
      if (mark[id] != asked_for) continue;
      --waiting;
      mark[id] = entered;
      others[count++] = id;
      ask_for_operands(terms[id]);
    }
    std::reverse(others.data() + first, others.data() + count);
    constexpr std::size_t looks_of_an_operation = 8;
    const std::size_t looked_at = root - id;
    if (!diagnostics.charge(2 * (count - first) + looked_at / looks_of_an_operation, material.span, Work::program))
      return std::nullopt;
  }
  // Now it is known which solutions are needed.
  std::vector<TermId> order;
  order.reserve(terms.size());
  for (TermId id = solutions_end; id-- > 0;) {
    if (mark[id] != asked_for) continue;
    order.push_back(id);
    ask_for_operands(terms[id]);
  }
  std::ranges::reverse(order);
  order.insert(order.end(), others.begin(), others.begin() + static_cast<std::ptrdiff_t>(count));
  return order;
}

}  // namespace

LoweredMaterial lower(const SolvedMaterial& material, Diagnostics& diagnostics) {
  const Terms& terms = material.terms;
  LoweredMaterial lowered;
  const auto needed = needed_for(roots_of(material), material, diagnostics);
  if (!needed) return lowered;

  Graph& graph = lowered.graph;
  // about as many nodes as terms: gradients add some, constant folding removes some
  graph.reserve(needed->size() + needed->size() / 4);
  graph.attribute(material.span);
  // The patch without its rim, over which peaks are evaluated.
  const NodeId rim = graph.input(Input::patch_rim);
  const NodeId half_width = graph.apply(Operation::subtract, graph.input(Input::patch_half_width), rim);
  const NodeId half_height = graph.apply(Operation::subtract, graph.input(Input::patch_half_height), rim);

  std::vector<NodeId> nodes(terms.size(), 0);
  std::array derivative{Derivatives(graph, Derivatives::place(0)), Derivatives(graph, Derivatives::place(1))};
  for (const TermId id : *needed) {
    const Term& term = terms[id];
    graph.attribute(term.span == Span{} ? material.span : term.span);
    if (term.kind == TermKind::operation) {  // the most frequent kind
      nodes[id] = graph.apply(term.operation, nodes[term.a], nodes[term.b], nodes[term.c], term.index);
      continue;
    }
    switch (term.kind) {
      case TermKind::literal: nodes[id] = graph.constant(static_cast<float>(term.value)); break;
      case TermKind::input: nodes[id] = graph.input(term.input()); break;
      case TermKind::parameter: nodes[id] = graph.parameter(term.index); break;
      case TermKind::state: nodes[id] = graph.state(term.index); break;
      case TermKind::settled: nodes[id] = nodes[term.a]; break;
      case TermKind::component: nodes[id] = graph.component(nodes[term.a], term.index); break;
      case TermKind::gradient: {
        Derivatives& derived = derivative[term.index];
        if (!diagnostics.charge(derived.operations(nodes[term.a]), term.span, Work::gradient)) return lowered;
        nodes[id] = derived(nodes[term.a]);
        break;
      }
      case TermKind::peak:
        nodes[id] = graph.peak(nodes[term.a], half_width, half_height);
        lowered.flat = lowered.flat || graph.is_zero(nodes[id]);
        break;
      case TermKind::operation:
      case TermKind::open:
      case TermKind::cells:
      case TermKind::magnitude:
      case TermKind::carrier: break;  // replaced by its solution
    }
  }

  const auto& vibration = material.device.shaker;
  const double most = material.limited || vibration ? material.device.most() : unlimited_newton;
  lowered.ceiling.fill(graph.constant(static_cast<float>(most)));
  if (vibration) lowered.ceiling[1] = graph.constant(static_cast<float>(vibration->frequency_high));
  graph.attribute(material.force_span);
  for (std::size_t axis = 0; axis < 2; ++axis)
    lowered.force[axis] = graph.output_limit(nodes[material.force[axis]], lowered.ceiling[axis]);
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
