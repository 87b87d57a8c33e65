#include <algorithm>
#include <optional>
#include <utility>

#include "compiler/graph/graph.hpp"

namespace wale {

namespace {

/// A node with arithmetic operators, so that the derivative column of the instruction table can be compiled. A known
/// zero stays zero and vanishes from sums, so constant parts add no terms to a derivative.
struct Expression {
  Graph* graph;
  NodeId id;

  bool zero() const { return graph->is_zero(id); }
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

/// The derivative of the result r of an operation on a, b, c, whose derivatives are da, db, dc; 0 for a look-up.
[[gnu::noinline]] NodeId derivative_of(Graph& graph, const Node& node, NodeId result, NodeId derivative_a,
                                       NodeId derivative_b, NodeId derivative_c) {
  const Expression r{&graph, result}, a{&graph, node.a}, b{&graph, node.b}, c{&graph, node.c};
  const Expression da{&graph, derivative_a}, db{&graph, derivative_b}, dc{&graph, derivative_c};
  [[maybe_unused]] const auto number = [&](double value) {
    return Expression{&graph, graph.constant(static_cast<float>(value))};
  };
  // clang-format off
  switch (node.operation) {
#define INSTRUCTION(number_, name, fields, results, cost, meaning, range, derivative) \
  case Operation::name: return (derivative).id;
#define SPECIAL(number_, name, fields, results, cost) \
  case Operation::name: break;
#include "wale/instruction.def"
  }
  // clang-format on
  (void)r, (void)a, (void)b, (void)c, (void)da, (void)db, (void)dc;
  return number(0).id;
}

}  // namespace

Derivatives::Derivatives(Graph& graph, By by, std::optional<float> difference)
    : graph_(graph), by_(std::move(by)), difference_(difference) {}

Derivatives::By Derivatives::place(int axis) {
  if (axis == 0) return {.inputs = {Input::x, Input::workspace_x}, .state = {}, .edge_slope = Input::shape_edge_x};
  return {.inputs = {Input::y, Input::workspace_y}, .state = {}, .edge_slope = Input::shape_edge_y};
}

bool Derivatives::moves(const Node& node) const {
  if (node.kind == Node::Kind::state) return by_.state == node.index;
  return node.kind == Node::Kind::input &&
         std::ranges::find(by_.inputs, static_cast<Input>(node.index)) != by_.inputs.end();
}

/// The derivative, per sample, of slope number `slope` (1 along a, 2 along b) of a table along a (coordinate 0) or b
/// (1).
NodeId Derivatives::slope_of_slope(const Node& sample, std::uint32_t slope, int coordinate) {
  const auto slope_at = [&](Operation shift) {
    const NodeId step = graph_.constant(*difference_);
    NodeId at[] = {sample.a, sample.b};
    at[coordinate] = graph_.apply(shift, at[coordinate], step);
    return graph_.component(graph_.apply(sample.operation, at[0], at[1], 0, sample.index), slope);
  };
  const NodeId change = graph_.apply(Operation::subtract, slope_at(Operation::add), slope_at(Operation::subtract));
  return graph_.apply(Operation::multiply, change, graph_.constant(0.5f / *difference_));
}

/// The spline's partial derivatives, multiplied by the derivatives of its coordinates (chain rule).
NodeId Derivatives::of_component(const Node& node) {
  const Node sample = graph_[node.a];  // a copy: the graph grows
  const bool slope = node.index != 0;
  if (slope && !(difference_ && sample.operation == Operation::sample)) return graph_.constant(0);
  const auto partial = [&](int coordinate) {
    return slope ? slope_of_slope(sample, node.index, coordinate)
                 : graph_.component(node.a, static_cast<std::uint32_t>(coordinate) + 1);
  };
  Expression sum{&graph_, graph_.constant(0)};
  const NodeId coordinates[] = {sample.a, sample.b};
  for (int i = 0; i < 2; ++i)
    if (const Expression moving{&graph_, known_[coordinates[i]]}; !moving.zero())
      sum = sum + Expression{&graph_, partial(i)} * moving;
  return sum.id;
}

/// Finds the nodes that must be derived for one node. For all other operands the derivative is known afterwards.
/// Returns how many nodes were looked at.
std::size_t Derivatives::find_needed(NodeId of, NodeId zero) {
  if (known_.size() <= of) known_.resize(of + 1, none);
  needed_.clear();
  found_for_ = of;
  NodeId* const known = known_.data();
  std::size_t waiting = 0;  // nodes marked `awaited` in `known`
  const auto ask = [&](NodeId id) {
    if (known[id] != none) return;
    known[id] = awaited;
    ++waiting;
  };
  ask(of);
  if (waiting > 0) needed_.reserve(graph_.size());
  NodeId id = of + 1;
  while (waiting > 0) {
    if (known[--id] != awaited) continue;
    --waiting;
    known[id] = zero;  // unless the node changes, see below
    const Node& node = graph_[id];
    if (node.rate != Rate::tick) continue;
    needed_.push_back(id);
    if (node.operands > 0) ask(node.a);
    if (node.operands > 1) ask(node.b);
    if (node.operands > 2) ask(node.c);
  }
  return of + 1 - id;
}

std::size_t Derivatives::operations(NodeId of) {
  constexpr std::size_t of_a_node = 8, looks_of_an_operation = 8;
  const std::size_t looked_at = find_needed(of, graph_.constant(0));
  return of_a_node * needed_.size() + looked_at / looks_of_an_operation;
}

NodeId Derivatives::operator()(NodeId of) {
  if (found_for_ != of) find_needed(of, graph_.constant(0));
  found_for_ = none;
  for (auto next = needed_.rbegin(); next != needed_.rend(); ++next) {
    const NodeId id = *next;
    const Node node = graph_[id];  // a copy: the graph grows below
    graph_.attribute(node.span);
    if (node.kind == Node::Kind::operation)
      known_[id] = derivative_of(graph_, node, id, known_[node.a], known_[node.b], known_[node.c]);
    else if (node.kind == Node::Kind::component)
      known_[id] = of_component(node);
    else if (moves(node))
      known_[id] = graph_.constant(1);
    else if (by_.edge_slope && node.kind == Node::Kind::input && static_cast<Input>(node.index) == Input::shape_edge)
      known_[id] = graph_.input(*by_.edge_slope);
  }
  return known_[of];
}

}  // namespace wale
