#include "compiler/graph/graph.hpp"

#include <algorithm>
#include <array>
#include <bit>

#include "compiler/graph/term.hpp"
#include "runtime/machine/single.hpp"

namespace wale {

namespace {

/// Whether they are one value. Where it came from does not make it what it is, and the rate follows from the rest.
bool same(const Node& a, const Node& b) {
  return a.a == b.a && a.b == b.b && a.c == b.c && a.index == b.index && a.operation == b.operation && a.kind == b.kind;
}

/// Of what `same` compares. Each multiplication carries what is below to what is above, which is what counts.
inline std::size_t hash_of(const Node& node) {
  std::uint64_t hash = (std::uint64_t{node.a} << 32 | node.b) * 0x9e3779b97f4a7c15u;
  hash ^= std::uint64_t{node.c} << 32 | node.index;
  hash += static_cast<std::uint64_t>(node.operation) << 8 | static_cast<std::uint64_t>(node.kind);
  return hash * 0xbf58476d1ce4e5b9u >> 32;
}

/// What `Graph::apply` asks of an operation.
struct Working {
  std::uint8_t operands = 0;
  Rate rate = Rate::constant;  ///< how often it is worked out at least: a table is not there while the compiler folds
};

/// By number.
constexpr auto workings = [] {
  std::array<Working, operation_table.size()> table{};
  for (std::size_t number = 0; number < table.size(); ++number)
    table[number].operands = static_cast<std::uint8_t>(operation_table[number].operands);
  table[static_cast<std::size_t>(Operation::sample)].rate = Rate::setup;
  table[static_cast<std::size_t>(Operation::recall)].rate = Rate::tick;
  table[static_cast<std::size_t>(Operation::cell)].rate = Rate::tick;
  return table;
}();

}  // namespace

void Graph::reserve(std::size_t nodes) {
  if (nodes <= nodes_.size()) return;
  nodes_.resize(std::bit_ceil(nodes));
  const std::vector<NodeId> shared = std::move(table_);
  table_.assign(2 * nodes_.size(), none);
  const std::size_t last = table_.size() - 1;
  for (const NodeId id : shared) {
    if (id == none) continue;
    std::size_t at = hash_of(nodes_[id]) & last;
    while (table_[at] != none) at = (at + 1) & last;
    table_[at] = id;
  }
}

NodeId Graph::add(const Node& node) {
  if (size_ == nodes_.size()) [[unlikely]]
    return add_with_more_room(node);
  NodeId* const slots = table_.data();
  const std::size_t last = table_.size() - 1;
  std::size_t at = hash_of(node) & last;
  for (; slots[at] != none; at = (at + 1) & last)
    if (same(nodes_[slots[at]], node)) return slots[at];
  const auto added = static_cast<NodeId>(size_++);
  slots[at] = added;
  Node& entered = nodes_[added];
  entered = node;
  if (node.span == Span{}) entered.span = place_;
  return added;
}

NodeId Graph::add_with_more_room(const Node& node) {
  reserve(std::max<std::size_t>(128, 2 * size_));
  return add(node);
}

NodeId Graph::constant(float value) {
  return add({.kind = Node::Kind::constant, .index = std::bit_cast<std::uint32_t>(value)});
}

NodeId Graph::input(Input input, Span span) {
  const bool patch = input == Input::patch_half_width || input == Input::patch_half_height ||
                     input == Input::patch_rim || input == Input::seconds_per_tick;
  return add({.kind = Node::Kind::input,
              .rate = patch ? Rate::setup : Rate::tick,
              .index = static_cast<std::uint32_t>(input),
              .span = span});
}

NodeId Graph::parameter(std::uint32_t index, Span span) {
  return add({.kind = Node::Kind::parameter, .rate = Rate::setup, .index = index, .span = span});
}

NodeId Graph::state(std::uint32_t index, Span span) {
  return add({.kind = Node::Kind::state, .rate = Rate::tick, .index = index, .span = span});
}

NodeId Graph::folded(Operation operation, NodeId a, NodeId b, NodeId c) {
  const int count = facts(operation).operands;  // what it does not take may be no constant
  return constant(result_of(operation, count > 0 ? nodes_[a].value() : 0, count > 1 ? nodes_[b].value() : 0,
                            count > 2 ? nodes_[c].value() : 0));
}

NodeId Graph::apply(Operation operation, NodeId a, NodeId b, NodeId c, std::uint32_t table, const Span& span) {
  auto [count, rate] = workings[static_cast<std::size_t>(operation)];
  if (count > 0) rate = std::max(rate, nodes_[a].rate);
  if (count > 1) rate = std::max(rate, nodes_[b].rate);
  if (count > 2) rate = std::max(rate, nodes_[c].rate);
  if (rate == Rate::constant) return folded(operation, a, b, c);  // only constants are worked out once

  // Only what is exact for every float is simplified: the value must not depend on what the compiler knew.
  switch (operation) {
    case Operation::multiply:
      if (is_constant(b, 1)) return a;
      if (is_constant(a, 1)) return b;
      break;
    case Operation::divide:
      if (is_constant(b, 1)) return a;
      break;
    case Operation::subtract:
      if (is_constant(b, 0)) return a;
      break;
    case Operation::negate:
      if (nodes_[a].kind == Node::Kind::operation && nodes_[a].operation == Operation::negate) return nodes_[a].a;
      break;
    case Operation::select:
      if (nodes_[a].kind == Node::Kind::constant) return nodes_[a].value() != 0 ? b : c;
      break;
    default: break;
  }
  return add({.kind = Node::Kind::operation,
              .operation = operation,
              .rate = rate,
              .operands = count,
              .a = a,
              .b = count > 1 ? b : 0,
              .c = count > 2 ? c : 0,
              .index = table,
              .span = span});
}

NodeId Graph::component(NodeId sample, std::uint32_t index, Span span) {
  return add({.kind = Node::Kind::component,
              .rate = nodes_[sample].rate,
              .operands = 1,
              .a = sample,
              .index = index,
              .span = span});
}

NodeId Graph::peak(NodeId value, NodeId half_width, NodeId half_height, Span span) {
  if (nodes_[value].rate != Rate::tick) return value;  // the same everywhere on the patch
  return add({.kind = Node::Kind::peak,
              .rate = Rate::setup,
              .operands = 3,
              .a = value,
              .b = half_width,
              .c = half_height,
              .span = span});
}

NodeId Graph::output_limit(NodeId value, NodeId ceiling, Span span) {
  if (size_ == nodes_.size()) reserve(2 * size_);
  nodes_[size_] = {.kind = Node::Kind::operation,
                   .operation = Operation::limit,
                   .rate = Rate::tick,
                   .operands = 2,
                   .a = value,
                   .b = ceiling,
                   .span = span};
  return static_cast<NodeId>(size_++);
}

}  // namespace wale
