#include <optional>

#include "compiler/graph/graph.hpp"

namespace wale {

namespace {

/// A node that can be calculated with, so that the derivative column of the instruction table reads as mathematics.
/// What is known to be zero stays zero and vanishes from sums: a derivative has no term where nothing changes.
struct Expression {
  Graph* graph;
  NodeId id;

  bool zero() const { return graph->is_constant(id, 0.0f) || graph->is_constant(id, -0.0f); }
  bool one() const { return graph->is_constant(id, 1.0f); }
};

Expression apply(Operation operation, Expression a) { return {a.graph, a.graph->apply(operation, a.id)}; }
Expression apply(Operation operation, Expression a, Expression b) {
  return {a.graph, a.graph->apply(operation, a.id, b.id)};
}

Expression operator+(Expression a, Expression b) { return a.zero() ? b : b.zero() ? a : apply(Operation::add, a, b); }
Expression operator-(Expression a) { return a.zero() ? a : apply(Operation::negate, a); }
Expression operator-(Expression a, Expression b) {
  return b.zero() ? a : a.zero() ? -b : apply(Operation::subtract, a, b);
}
Expression operator*(Expression a, Expression b) {
  return a.zero() ? a : b.zero() ? b : apply(Operation::multiply, a, b);
}
Expression operator/(Expression a, Expression b) { return a.zero() ? a : apply(Operation::divide, a, b); }

[[maybe_unused]] Expression sine(Expression a) { return apply(Operation::sine, a); }
[[maybe_unused]] Expression cosine(Expression a) { return apply(Operation::cosine, a); }
[[maybe_unused]] Expression exp2(Expression a) { return apply(Operation::exp2, a); }
[[maybe_unused]] Expression absolute(Expression a) { return apply(Operation::absolute, a); }
[[maybe_unused]] Expression less(Expression a, Expression b) { return apply(Operation::less, a, b); }
[[maybe_unused]] Expression select(Expression a, Expression b, Expression c) {
  if (b.id == c.id) return b;
  return {a.graph, a.graph->apply(Operation::select, a.id, b.id, c.id)};
}

/// The derivative of the result r of an operation of a, b, c, whose derivatives are da, db, dc.
Expression derivative_of(Operation operation, Graph& graph, Expression r, Expression a, Expression b, Expression c,
                         Expression da, Expression db, Expression dc) {
  [[maybe_unused]] const auto number = [&](double value) {
    return Expression{&graph, graph.constant(static_cast<float>(value))};
  };
  // clang-format off
  switch (operation) {
#define INSTRUCTION(number_, name, fields, results, cost, meaning, derivative) \
  case Operation::name: return derivative;
#define SPECIAL(number_, name, fields, results, cost) \
  case Operation::name: break;
#include "schema/instruction.def"
  }
  // clang-format on
  (void)r, (void)a, (void)b, (void)c, (void)da, (void)db, (void)dc;
  return number(0);
}

}  // namespace

NodeId Derivatives::operator()(NodeId of, int axis) {
  Graph& graph = graph_;
  const NodeId zero = graph.constant(0);
  auto& known = known_[static_cast<std::size_t>(axis)];
  if (known.size() <= of) known.resize(of + 1, none);
  std::vector<char> needed(of + 1, false);  // as bool: bits are slower to look at one by one
  needed[of] = known[of] == none;
  for (NodeId id = of + 1; id-- > 0;) {
    if (!needed[id]) continue;
    known[id] = zero;  // unless there is more to say, below
    if (graph[id].rate != Rate::tick) continue;
    for (const NodeId operand : graph.operands(id)) needed[operand] = known[operand] == none;
  }

  for (NodeId id = 0; id <= of; ++id) {
    if (!needed[id] || graph[id].rate != Rate::tick) continue;
    const Node node = graph[id];  // a copy: the graph grows below
    graph.attribute(node.span);
    switch (node.kind) {
      case Node::Kind::input: {
        const auto along = axis == 0 ? Input::x : Input::y;
        const auto on_workspace = axis == 0 ? Input::workspace_x : Input::workspace_y;
        if (node.index == static_cast<std::uint32_t>(along) || node.index == static_cast<std::uint32_t>(on_workspace))
          known[id] = graph.constant(1);
        break;
      }
      case Node::Kind::component: {
        // The spline's own partial derivatives, chained to those of its coordinates. A table gives no second
        // derivatives.
        const Node sample = graph[node.a];
        if (node.index != 0) break;
        const Expression du{&graph, graph.component(node.a, 1)}, dv{&graph, graph.component(node.a, 2)};
        known[id] = (du * Expression{&graph, known[sample.a]} + dv * Expression{&graph, known[sample.b]}).id;
        break;
      }
      case Node::Kind::operation: {
        const auto term = [&](NodeId operand) { return Expression{&graph, operand}; };
        const bool looks_up = node.operation == Operation::sample || node.operation == Operation::recall ||
                              node.operation == Operation::cell;
        if (!looks_up)
          known[id] = derivative_of(node.operation, graph, term(id), term(node.a), term(node.b), term(node.c),
                                    term(known[node.a]), term(known[node.b]), term(known[node.c]))
                          .id;
        break;
      }
      default: break;
    }
  }
  return known[of];
}

}  // namespace wale
