#pragma once

#include <array>
#include <bit>
#include <cstdint>
#include <optional>
#include <vector>

#include "compiler/text/source.hpp"
#include "wale/instruction.hpp"

namespace wale {

/// How often a value is computed: once by the compiler; on the control thread when a parameter or the patch changes; or
/// at every tick, lattice point or pixel.
enum class Rate : std::uint8_t { constant, setup, tick };

using NodeId = std::uint32_t;

/// One value of a program in single assignment form, with its place in the source.
struct Node {
  enum class Kind : std::uint8_t {
    constant,   ///< `value()`
    input,      ///< number `index`
    parameter,  ///< number `index`
    state,      ///< number `index`, at the beginning of the tick
    operation,  ///< of a, b, c; `sample` reads table `index`, `recall` and `cell` grid `index`
    component,  ///< result `index` of the sample `a`
    peak,       ///< percentile of `a` over the box of half extents b and c
  };
  Kind kind = Kind::constant;
  Operation operation = Operation::add;
  Rate rate = Rate::constant;
  std::uint8_t operands = 0;  ///< how many of a, b, c it uses, from the first on
  NodeId a = 0, b = 0, c = 0;
  std::uint32_t index = 0;  ///< for a constant: the bits of its value
  Span span;

  /// The value of a constant.
  float value() const { return std::bit_cast<float>(index); }
};

/// The operands of a node, at most three.
struct Operands {
  std::array<NodeId, 3> nodes{};
  std::size_t count = 0;

  std::size_t size() const { return count; }
  NodeId operator[](std::size_t i) const { return nodes[i]; }
  const NodeId* begin() const { return nodes.data(); }
  const NodeId* end() const { return nodes.data() + count; }
};

/// The values of a program. Equal values share one node. Constants are folded with the machine's own operations, so
/// that the bits of a value do not depend on its rate. Operands precede their users.
class Graph {
 public:
  const Node& operator[](NodeId id) const { return nodes_[id]; }
  std::size_t size() const { return size_; }
  /// Reserves room for that many nodes.
  void reserve(std::size_t nodes);

  /// From now on, new nodes are attributed to this place. A value that is made twice keeps its first place.
  void attribute(const Span& place) { place_ = place; }

  NodeId constant(float value);
  NodeId input(Input input);
  NodeId parameter(std::uint32_t index);
  NodeId state(std::uint32_t index);
  /// Applies any operation except `peak`; operands that it does not take are ignored.
  NodeId apply(Operation operation, NodeId a, NodeId b = 0, NodeId c = 0, std::uint32_t table = 0);
  NodeId component(NodeId sample, std::uint32_t index);
  NodeId peak(NodeId value, NodeId half_width, NodeId half_height);
  /// The `limit` at the end of an output: never folded or shared, and always computed in the tick.
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

  std::vector<Node> nodes_;          ///< only the first `size_` are in use
  std::size_t size_ = 0, room_ = 0;  ///< `room_` is 0 or a power of two
  unsigned slot_bits_ = 0;
  /// Hash table of nodes with linear probing: 2^slot_bits_ slots, twice `room_`, each a node or `none`.
  std::vector<NodeId> table_;
  Span place_;
};

/// Derivatives of a graph's nodes with respect to one quantity, by the rules of the instruction table: exact except for
/// rounding. Derivatives are cached, since those of one height are needed repeatedly.
class Derivatives {
 public:
  /// The quantity: inputs that change together at rate 1, or one state.
  struct By {
    std::vector<Input> inputs;
    std::optional<std::uint32_t> state;
    std::optional<Input> edge_slope = {};  ///< the derivative of `shape_edge`; without it that is 0
  };
  /// A look-up in a table gives its value and its slopes. The derivatives of the slopes are taken as 0; or, with
  /// `difference`, as the central difference of the slopes at this distance, in samples, to both sides.
  Derivatives(Graph& graph, By by, std::optional<float> difference = {});

  NodeId operator()(NodeId of);
  /// The operations that `operator()` needs for this node, to charge them before.
  std::size_t operations(NodeId of);

  /// The hand's place along x (axis 0) or y (axis 1): the inputs for the patch and for the workspace change together.
  static By place(int axis);

 private:
  static constexpr NodeId none = ~NodeId{0}, awaited = none - 1;

  bool moves(const Node& node) const;
  std::size_t find_needed(NodeId of, NodeId zero);
  NodeId of_component(const Node& node);
  NodeId slope_of_slope(const Node& sample, std::uint32_t slope, int coordinate);

  Graph& graph_;
  By by_;
  std::optional<float> difference_;
  std::vector<NodeId> known_;   ///< derivative of each node; `none` if not derived yet
  std::vector<NodeId> needed_;  ///< nodes needed for the current one, the last first
  NodeId found_for_ = none;     ///< the node for which `needed_` has been found
};

}  // namespace wale
