#pragma once

#include <array>
#include <bit>
#include <cstdint>
#include <optional>
#include <vector>

#include "compiler/text/source.hpp"
#include "schema/instruction.hpp"

namespace wale {

/// How often a value has to be worked out: once by the compiler, on the control thread when a parameter or the patch
/// changes, or at every tick, lattice point or pixel.
enum class Rate : std::uint8_t { constant, setup, tick };

using NodeId = std::uint32_t;

/// One value of a program in single assignment form, and where in the source it came from.
struct Node {
  enum class Kind : std::uint8_t {
    constant,   ///< `value()`
    input,      ///< number `index`
    parameter,  ///< number `index`
    state,      ///< number `index`, as it was when the tick began
    operation,  ///< of a, b, c; `sample` reads table `index`, `recall` and `cell` grid `index`
    component,  ///< result `index` of the sample `a`
    peak,       ///< percentile of `a` over the box of half extents b and c
  };
  Kind kind = Kind::constant;
  Operation operation = Operation::add;
  Rate rate = Rate::constant;
  std::uint8_t operands = 0;  ///< how many of a, b, c it is worked out from; those come first
  NodeId a = 0, b = 0, c = 0;
  std::uint32_t index = 0;  ///< of a constant the bits of its value
  Span span;

  /// Of a constant.
  float value() const { return std::bit_cast<float>(index); }
};

/// The nodes that a node is worked out from, at most three.
struct Operands {
  std::array<NodeId, 3> nodes{};
  std::size_t count = 0;

  std::size_t size() const { return count; }
  NodeId operator[](std::size_t i) const { return nodes[i]; }
  const NodeId* begin() const { return nodes.data(); }
  const NodeId* end() const { return nodes.data() + count; }
};

/// The values of a program. Equal values are one node; values of constants are folded by the machine's own operations,
/// so that a change of rate changes no bit. Operands stand before what uses them.
class Graph {
 public:
  const Node& operator[](NodeId id) const { return nodes_[id]; }
  std::size_t size() const { return size_; }
  /// Makes room for so many nodes; there may be more.
  void reserve(std::size_t nodes);

  /// From now on, what is made comes from this place. A value that is made twice comes from the first.
  void attribute(const Span& place) { place_ = place; }

  NodeId constant(float value);
  NodeId input(Input input);
  NodeId parameter(std::uint32_t index);
  NodeId state(std::uint32_t index);
  /// Any operation but `peak`; operands that it does not take are ignored.
  NodeId apply(Operation operation, NodeId a, NodeId b = 0, NodeId c = 0, std::uint32_t table = 0);
  NodeId component(NodeId sample, std::uint32_t index);
  NodeId peak(NodeId value, NodeId half_width, NodeId half_height);
  /// The `limit` that ends an output: never folded or shared, and always worked out in the tick.
  NodeId output_limit(NodeId value, NodeId ceiling);

  bool is_constant(NodeId id, float value) const {
    return nodes_[id].kind == Node::Kind::constant && nodes_[id].index == std::bit_cast<std::uint32_t>(value);
  }
  /// Whether it is the constant 0, of either sign.
  bool is_zero(NodeId id) const { return nodes_[id].kind == Node::Kind::constant && nodes_[id].index << 1 == 0; }
  Operands operands(NodeId id) const {
    const Node& node = nodes_[id];
    return {{node.a, node.b, node.c}, node.operands};
  }

 private:
  NodeId shared(const Node& node);
  NodeId add(const Node& node);
  NodeId folded(Operation operation, NodeId a, NodeId b, NodeId c);
  NodeId simpler(Operation operation, NodeId a, NodeId b, NodeId c) const;

  static constexpr NodeId none = ~NodeId{0};

  std::vector<Node> nodes_;          ///< the first `size_` of these: the rest is room for more
  std::size_t size_ = 0, room_ = 0;  ///< the room is a power of two, once there is some
  unsigned slot_bits_ = 0;
  /// Finds equal nodes: two slots for each that there is room for, 2^slot_bits_, each a node or `none`. A node stands
  /// in the first free slot from the one that its hash names.
  std::vector<NodeId> table_;
  Span place_;
};

/// Derivatives of a graph's nodes by one of the quantities that they depend on, by the rules of the instruction table:
/// exact but for rounding. What has been derived once is remembered: slopes of one height are asked for again and
/// again.
class Derivatives {
 public:
  /// What moves, at rate 1: inputs that move together, or one state.
  struct By {
    std::vector<Input> inputs;
    std::optional<std::uint32_t> state;
  };
  /// A look-up in a table gives its value and its slopes. The slopes' own derivatives are taken for 0, or for the
  /// difference of the slopes this far (in samples) to either side, which on a cubic spline is off by no more than that
  /// far off.
  Derivatives(Graph& graph, By by, std::optional<float> difference = {});

  NodeId operator()(NodeId of);

  /// The hand's place along x (axis 0) or y (axis 1), on the patch and with it on the workspace.
  static By place(int axis);

 private:
  static constexpr NodeId none = ~NodeId{0}, awaited = none - 1;

  bool moves(const Node& node) const;
  void find_needed(NodeId of, NodeId zero);
  NodeId of_component(const Node& node);
  NodeId slope_of_slope(const Node& sample, std::uint32_t slope, int coordinate);

  Graph& graph_;
  By by_;
  std::optional<float> difference_;
  std::vector<NodeId> known_;   ///< by node; `none` where not derived yet
  std::vector<NodeId> needed_;  ///< by the one that is asked for, the last first
};

}  // namespace wale
