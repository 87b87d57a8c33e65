#include "compiler/graph/graph.hpp"

#include <algorithm>
#include <array>
#include <bit>

#include "compiler/graph/term.hpp"
#include "runtime/machine/single.hpp"

namespace wale {

namespace {

/// Whether they are one value. Where it came from and how often it is worked out do not make it what it is.
bool same(const Node& a, const Node& b) {
  return a.a == b.a && a.b == b.b && a.c == b.c && a.operation == b.operation && a.kind == b.kind &&
         a.index == b.index && std::bit_cast<std::uint32_t>(a.value) == std::bit_cast<std::uint32_t>(b.value);
}

/// Of what `same` compares: each word times an odd number of its own; what is above goes into what is below.
inline std::uint32_t hash_of(const Node& node) {
  const std::uint64_t what = static_cast<std::uint64_t>(node.kind) << 40 |
                             static_cast<std::uint64_t>(node.operation) << 32 |
                             std::bit_cast<std::uint32_t>(node.value);
  const std::uint64_t a_and_b = std::uint64_t{node.a} << 32 | node.b;
  const std::uint64_t c_and_index = std::uint64_t{node.c} << 32 | node.index;
  const std::uint64_t hash =
      what * 0x9e3779b97f4a7c15u ^ a_and_b * 0xbf58476d1ce4e5b9u ^ c_and_index * 0x94d049bb133111ebu;
  return static_cast<std::uint32_t>(hash ^ hash >> 32);
}

/// How often the result of an operation is worked out at least, by number: a table is not there while the compiler
/// folds.
constexpr auto least_rate = [] {
  std::array<Rate, operation_table.size()> table{};
  table[static_cast<std::size_t>(Operation::sample)] = Rate::setup;
  table[static_cast<std::size_t>(Operation::recall)] = Rate::tick;
  table[static_cast<std::size_t>(Operation::cell)] = Rate::tick;
  return table;
}();

}  // namespace

void Graph::reserve(std::size_t nodes) {
  nodes_.reserve(nodes);
  if (2 * nodes > table_.size()) enlarge_table(std::bit_ceil(2 * nodes));
}

void Graph::enlarge_table(std::size_t slots) {
  const std::vector<Slot> entries = std::move(table_);
  table_.assign(slots, {});
  for (const Slot& entry : entries) {
    if (entry.node == none) continue;
    std::size_t at = entry.hash & (table_.size() - 1);
    while (table_[at].node != none) at = (at + 1) & (table_.size() - 1);
    table_[at] = entry;
  }
}

[[gnu::always_inline]] inline NodeId Graph::add(const Node& node) {
  if (2 * (in_table_ + 1) > table_.size()) enlarge_table(std::max<std::size_t>(256, 2 * table_.size()));
  const std::uint32_t hash = hash_of(node);
  Slot* const slots = table_.data();
  const std::size_t last = table_.size() - 1;
  std::size_t at = hash & last;
  for (; slots[at].node != none; at = (at + 1) & last)
    if (slots[at].hash == hash && same(nodes_[slots[at].node], node)) return slots[at].node;
  const auto added = static_cast<NodeId>(nodes_.size());
  slots[at] = {hash, added};
  ++in_table_;
  Node& entered = nodes_.emplace_back(node);
  if (node.span == Span{}) entered.span = place_;
  return added;
}

NodeId Graph::constant(float value) { return add({.kind = Node::Kind::constant, .value = value}); }

NodeId Graph::input(Input input, Span span) {
  const bool patch = input == Input::patch_half_width || input == Input::patch_half_height ||
                     input == Input::patch_rim || input == Input::seconds_per_tick;
  return add({.kind = Node::Kind::input,
              .index = static_cast<std::uint32_t>(input),
              .rate = patch ? Rate::setup : Rate::tick,
              .span = span});
}

NodeId Graph::parameter(std::uint32_t index, Span span) {
  return add({.kind = Node::Kind::parameter, .index = index, .rate = Rate::setup, .span = span});
}

NodeId Graph::state(std::uint32_t index, Span span) {
  return add({.kind = Node::Kind::state, .index = index, .rate = Rate::tick, .span = span});
}

NodeId Graph::apply(Operation operation, NodeId a, NodeId b, NodeId c, std::uint32_t table, const Span& span) {
  const auto number = static_cast<std::size_t>(operation);
  const int count = operation_table[number].operands;
  Rate rate = least_rate[number];
  if (count > 0) rate = std::max(rate, nodes_[a].rate);
  if (count > 1) rate = std::max(rate, nodes_[b].rate);
  if (count > 2) rate = std::max(rate, nodes_[c].rate);
  if (rate == Rate::constant)  // of what is worked out once, only constants are nodes
    return constant(result_of(operation, count > 0 ? nodes_[a].value : 0, count > 1 ? nodes_[b].value : 0,
                              count > 2 ? nodes_[c].value : 0));

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
      if (nodes_[a].kind == Node::Kind::constant) return nodes_[a].value != 0 ? b : c;
      break;
    default: break;
  }
  return add({.kind = Node::Kind::operation,
              .operation = operation,
              .a = a,
              .b = count > 1 ? b : 0,
              .c = count > 2 ? c : 0,
              .index = table,
              .rate = rate,
              .span = span});
}

NodeId Graph::component(NodeId sample, std::uint32_t index, Span span) {
  return add({.kind = Node::Kind::component, .a = sample, .index = index, .rate = nodes_[sample].rate, .span = span});
}

NodeId Graph::peak(NodeId value, NodeId half_width, NodeId half_height, Span span) {
  if (nodes_[value].rate != Rate::tick) return value;  // the same everywhere on the patch
  return add(
      {.kind = Node::Kind::peak, .a = value, .b = half_width, .c = half_height, .rate = Rate::setup, .span = span});
}

NodeId Graph::output_limit(NodeId value, NodeId ceiling, Span span) {
  nodes_.push_back({.kind = Node::Kind::operation,
                    .operation = Operation::limit,
                    .a = value,
                    .b = ceiling,
                    .rate = Rate::tick,
                    .span = span});
  return static_cast<NodeId>(nodes_.size() - 1);
}

}  // namespace wale
