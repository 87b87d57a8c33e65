#include "compiler/graph/graph.hpp"

#include <algorithm>
#include <array>
#include <bit>

#include "compiler/graph/term.hpp"
#include "runtime/machine/single.hpp"

namespace wale {

namespace {

/// The parts of a node that decide its value. Its place in the source does not, and its rate follows from the rest.
struct Identity {
  std::uint64_t first_two, rest;  ///< operands a and b; c and the index
  std::uint16_t what;             ///< kind and operation

  explicit Identity(const Node& node)
      : first_two(node.a | std::uint64_t{node.b} << 32),
        rest(node.c | std::uint64_t{node.index} << 32),
        what(static_cast<std::uint16_t>(static_cast<unsigned>(node.kind) | static_cast<unsigned>(node.operation)
                                                                               << 8)) {}

  friend bool operator==(const Identity&, const Identity&) = default;

  /// A hash below 2^bits. Each multiplication mixes lower bits into the higher ones, which are used.
  std::size_t hash(unsigned bits) const {
    return (((first_two * 0x9e3779b97f4a7c15u) ^ rest) + what) * 0xbf58476d1ce4e5b9u >> (64 - bits);
  }
};

/// The properties of an operation that `Graph::apply` uses.
struct Working {
  std::uint8_t operands = 0;
  Rate rate =
      Rate::constant;  ///< the lowest rate of its result: a look-up cannot be folded, since the compiler has no tables
};

/// By the operation's number.
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
  if (nodes <= room_) return;
  room_ = std::bit_ceil(std::max<std::size_t>(nodes, 128));
  slot_bits_ = static_cast<unsigned>(std::bit_width(room_));
  nodes_.resize(room_);
  const std::vector<NodeId> shared = std::move(table_);
  table_.assign(2 * room_, none);
  const std::size_t last = table_.size() - 1;
  for (const NodeId id : shared) {
    if (id == none) continue;
    std::size_t at = Identity(nodes_[id]).hash(slot_bits_);
    while (table_[at] != none) at = (at + 1) & last;
    table_[at] = id;
  }
}

/// The existing equal node, or this one as a new node. Inlined, since a program makes hundreds of nodes.
[[gnu::always_inline]] inline NodeId Graph::shared(const Node& node) {
  if (size_ == room_) [[unlikely]]
    reserve(size_ + 1);
  const Identity wanted(node);
  NodeId* const slots = table_.data();
  const std::size_t last = 2 * room_ - 1;
  std::size_t at = wanted.hash(slot_bits_);
  for (; slots[at] != none; at = (at + 1) & last)
    if (Identity(nodes_[slots[at]]) == wanted) return slots[at];
  const auto added = static_cast<NodeId>(size_++);
  slots[at] = added;
  Node& entered = nodes_[added];
  entered = node;
  entered.span = place_;
  return added;
}

NodeId Graph::add(const Node& node) { return shared(node); }

NodeId Graph::constant(float value) {
  return shared({.kind = Node::Kind::constant, .index = std::bit_cast<std::uint32_t>(value)});
}

NodeId Graph::input(Input input) {
  const bool patch = input == Input::patch_half_width || input == Input::patch_half_height ||
                     input == Input::patch_rim || input == Input::seconds_per_tick;
  return add({.kind = Node::Kind::input,
              .rate = patch ? Rate::setup : Rate::tick,
              .index = static_cast<std::uint32_t>(input)});
}

NodeId Graph::parameter(std::uint32_t index) {
  return add({.kind = Node::Kind::parameter, .rate = Rate::setup, .index = index});
}

NodeId Graph::state(std::uint32_t index) {
  return add({.kind = Node::Kind::state, .rate = Rate::tick, .index = index});
}

NodeId Graph::folded(Operation operation, NodeId a, NodeId b, NodeId c) {
  const int count = facts(operation).operands;  // ignore unused operands, which need not be constant
  return constant(
      result_of(operation, nodes_[a].value(), count > 1 ? nodes_[b].value() : 0, count > 2 ? nodes_[c].value() : 0));
}

/// An existing node that has the same value for all floats, or `none`. Nothing else is simplified: the bits of the
/// result must not depend on what the compiler knows.
inline NodeId Graph::simpler(Operation operation, NodeId a, NodeId b, NodeId c) const {
  switch (operation) {
    case Operation::multiply: return is_constant(b, 1) ? a : is_constant(a, 1) ? b : none;
    case Operation::divide: return is_constant(b, 1) ? a : none;
    case Operation::subtract: return is_constant(b, 0) ? a : none;
    case Operation::negate:
      return nodes_[a].kind == Node::Kind::operation && nodes_[a].operation == Operation::negate ? nodes_[a].a : none;
    case Operation::select: return nodes_[a].kind != Node::Kind::constant ? none : nodes_[a].value() != 0 ? b : c;
    default: return none;
  }
}

NodeId Graph::apply(Operation operation, NodeId a, NodeId b, NodeId c, std::uint32_t table) {
  const auto [count, own] = workings[static_cast<std::size_t>(operation)];
  Rate least = nodes_[a].rate, most = std::max(own, least);
  const auto take = [&](NodeId operand) {
    least = std::min(least, nodes_[operand].rate);
    most = std::max(most, nodes_[operand].rate);
  };
  if (count > 1)
    take(b);
  else
    b = 0;
  if (count > 2)
    take(c);
  else
    c = 0;
  if (most == Rate::constant) return folded(operation, a, b, c);  // all operands are constant
  if (least == Rate::constant || operation == Operation::negate)
    if (const NodeId there = simpler(operation, a, b, c); there != none) return there;
  return shared({.kind = Node::Kind::operation,
                 .operation = operation,
                 .rate = most,
                 .operands = count,
                 .a = a,
                 .b = b,
                 .c = c,
                 .index = table});
}

NodeId Graph::component(NodeId sample, std::uint32_t index) {
  return add({.kind = Node::Kind::component, .rate = nodes_[sample].rate, .operands = 1, .a = sample, .index = index});
}

NodeId Graph::peak(NodeId value, NodeId half_width, NodeId half_height) {
  if (nodes_[value].rate != Rate::tick) return value;  // the same everywhere on the patch
  return add(
      {.kind = Node::Kind::peak, .rate = Rate::setup, .operands = 3, .a = value, .b = half_width, .c = half_height});
}

NodeId Graph::output_limit(NodeId value, NodeId ceiling) {
  if (size_ == room_) reserve(size_ + 1);
  nodes_[size_] = {.kind = Node::Kind::operation,
                   .operation = Operation::limit,
                   .rate = Rate::tick,
                   .operands = 2,
                   .a = value,
                   .b = ceiling,
                   .span = place_};
  return static_cast<NodeId>(size_++);
}

}  // namespace wale
