#pragma once

#include <cstdint>
#include <unordered_map>
#include <vector>

#include "compiler/source.hpp"
#include "schema/instruction.hpp"

namespace wale {

/// How often a value has to be worked out: once by the compiler, on the control thread when a parameter or the patch
/// changes, or at every tick, lattice point or pixel.
enum class Rate : std::uint8_t { constant, setup, tick };

using NodeId = std::uint32_t;

/// One value of a program in single assignment form, and where in the source it came from.
struct Node {
  enum class Kind : std::uint8_t {
    constant,   ///< `value`
    input,      ///< number `index`
    parameter,  ///< number `index`
    operation,  ///< of a, b, c; `sample` reads table `index`
    component,  ///< result `index` of the sample `a`
    peak,       ///< percentile of `a` over the box of half extents b and c
  };
  Kind kind = Kind::constant;
  Operation operation = Operation::add;
  NodeId a = 0, b = 0, c = 0;
  float value = 0;
  std::uint32_t index = 0;
  Rate rate = Rate::constant;
  Span span;
};

/// The values of a program. Equal values are one node; values of constants are folded by the machine's own operations,
/// so that a change of rate changes no bit. Operands stand before what uses them.
class Graph {
 public:
  const Node& operator[](NodeId id) const { return nodes_[id]; }
  std::size_t size() const { return nodes_.size(); }

  NodeId constant(float value);
  NodeId input(Input input, Span span = {});
  NodeId parameter(std::uint32_t index, Span span = {});
  NodeId apply(Operation operation, NodeId a, NodeId b = 0, NodeId c = 0, std::uint32_t table = 0, Span span = {});
  NodeId component(NodeId sample, std::uint32_t index, Span span = {});
  NodeId peak(NodeId value, NodeId half_width, NodeId half_height, Span span = {});
  /// The `limit` that ends an output: never folded or shared, and always worked out in the tick.
  NodeId output_limit(NodeId value, NodeId ceiling, Span span = {});

  bool is_constant(NodeId id, float value) const;
  /// The operands that are nodes, at most three.
  std::vector<NodeId> operands(NodeId id) const;

 private:
  NodeId add(Node node);

  struct Hash {
    std::size_t operator()(const std::vector<std::uint64_t>& key) const;
  };
  std::vector<Node> nodes_;
  std::unordered_map<std::vector<std::uint64_t>, NodeId, Hash> known_;
};

/// The derivative of a node along x (axis 0) or y (axis 1), by the rules of the instruction table: exact but for
/// rounding.
NodeId derivative(Graph& graph, NodeId of, int axis);

}  // namespace wale
