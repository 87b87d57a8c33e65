#include "compiler/grade/field.hpp"

#include <algorithm>

#include "compiler/graph/temporaries.hpp"
#include "runtime/machine/decoded_program.hpp"
#include "runtime/machine/floating_point_mode.hpp"
#include "runtime/machine/parallel.hpp"

namespace wale {
namespace {

/// Work above this, in units of cost over all hands, is worth another thread: about one millisecond.
constexpr double worth_a_thread = 4e6;

/// Assigns a register to each needed value: inputs, states and constants have registers of their own; computed values
/// use temporaries, which are free again after their last use.
class Layout {
 public:
  Layout(const Graph& graph, std::span<const NodeId> roots) : graph_(graph), last_use_(graph.size(), unused) {
    for (const NodeId root : roots) last_use_[root] = static_cast<NodeId>(graph.size());
    for (NodeId id = static_cast<NodeId>(graph.size()); id-- > 0;)
      if (last_use_[id] != unused)
        for (const NodeId operand : graph.operands(id)) {
          // A component is one of its look-up's registers, so the look-up lives as long as the component.
          const NodeId until = graph[id].kind == Node::Kind::component ? last_use_[id] : id;
          if (last_use_[operand] == unused || last_use_[operand] < until) last_use_[operand] = until;
        }
  }

  bool needed(NodeId id) const { return last_use_[id] != unused; }

  /// Allocates `count` adjacent temporaries for a node and returns the first.
  std::size_t take(NodeId id, std::size_t count) {
    while (!busy_.empty() && busy_.front().until < id) {
      temporaries_.give_back(busy_.front().first, busy_.front().count);
      std::ranges::pop_heap(busy_, later);
      busy_.pop_back();
    }
    const std::size_t first = temporaries_.take(count);
    busy_.push_back({last_use_[id], first, count});
    std::ranges::push_heap(busy_, later);
    return first;
  }
  std::size_t most() const { return temporaries_.most(); }

 private:
  static constexpr NodeId unused = ~NodeId{0};
  struct Busy {
    NodeId until;
    std::size_t first, count;
  };
  static bool later(const Busy& a, const Busy& b) { return a.until > b.until; }

  const Graph& graph_;
  std::vector<NodeId> last_use_;
  std::vector<Busy> busy_;  ///< a heap, with the first to become free in front
  Temporaries temporaries_;
};

}  // namespace

LiftedField::LiftedField(const Graph& graph, std::span<const NodeId> roots, const Bank& bank)
    : program_(bank.program()) {
  const PatchProgram& described = program_.description();
  Layout layout(graph, roots);
  std::vector<std::size_t> constants(graph.size()), temporaries(graph.size());
  std::size_t needed_constants = 0;
  for (NodeId id = 0; id < graph.size(); ++id)
    if (layout.needed(id) && graph[id].kind == Node::Kind::constant) {
      constants[id] = needed_constants++;
      layout_.constants.push_back(graph[id].value());
    }
  layout_.states = described.states;
  if (first_constant + needed_constants + layout_.states.size() > register_limit) return;

  // Operands precede their users, so a look-up has its registers before its components need them.
  const RegisterNumber first_state = layout_.first_state(), first_temporary = layout_.first_temporary();
  const auto place = [&](NodeId id) {
    const Node& node = graph[id];
    switch (node.kind) {
      case Node::Kind::input: return static_cast<RegisterNumber>(node.index);
      case Node::Kind::constant: return static_cast<RegisterNumber>(first_constant + constants[id]);
      case Node::Kind::state: return static_cast<RegisterNumber>(first_state + node.index);
      default: return static_cast<RegisterNumber>(first_temporary + temporaries[id]);
    }
  };
  std::vector<Instruction> code;
  for (NodeId id = 0; id < graph.size(); ++id) {
    const Node& node = graph[id];
    if (!layout.needed(id)) continue;
    if (node.kind == Node::Kind::input) inputs_.push_back(static_cast<Input>(node.index));
    if (node.kind == Node::Kind::component) temporaries[id] = temporaries[node.a] + node.index;
    if (node.kind != Node::Kind::operation) continue;
    const OperationFacts& known = facts(node.operation);
    Instruction& instruction = code.emplace_back();
    instruction.operation = static_cast<std::uint8_t>(node.operation);
    if (known.operands > 0) instruction.a = place(node.a);
    if (known.operands > 1) instruction.b = place(node.b);
    if (known.operands > 2) instruction.c = place(node.c);
    if (known.fields[2] == 't' || known.fields[2] == 'g') instruction.c = static_cast<RegisterNumber>(node.index);
    temporaries[id] = layout.take(id, static_cast<std::size_t>(known.results));
    if (first_temporary + layout.most() > register_limit) return;
    instruction.destination = place(id);
  }
  layout_.temporaries = static_cast<std::uint16_t>(layout.most());
  for (const NodeId root : roots) roots_.push_back(place(root));

  registers_.assign(bank.registers().begin(), bank.registers().begin() + first_constant);
  registers_.insert(registers_.end(), layout_.constants.begin(), layout_.constants.end());
  cost_ = cost_of(code);
  code_ = decode_block(layout_, program_.decoded().splines, program_.decoded().grids, code);
  fits_ = true;
}

void LiftedField::evaluate(std::span<const Hand> hands, std::span<const float> states, std::vector<float>& values) {
  values.resize(roots_.size() * hands.size());
  const std::size_t blocks = (hands.size() + lanes - 1) / lanes;
  // Every block writes only its own values, so the result does not depend on the threads.
  const auto work = [&](std::size_t begin, std::size_t end) { evaluate_blocks(begin, end, hands, states, values); };
  if (static_cast<double>(hands.size()) * static_cast<double>(cost_) < worth_a_thread)
    work(0, blocks);
  else
    in_parallel(blocks, work);
}

void LiftedField::evaluate_blocks(std::size_t begin, std::size_t end, std::span<const Hand> hands,
                                  std::span<const float> states, std::vector<float>& values) const {
  const DecodedProgram& program = program_.decoded();
  const std::size_t state_count = layout_.states.size();
  const RegisterNumber first_state = layout_.first_state();
  Block block(layout_);
  for (std::size_t first = begin * lanes; first < std::min(end * lanes, hands.size()); first += lanes) {
    const std::size_t count = std::min(lanes, hands.size() - first);
    for (const Input input : inputs_)
      place_input(input, hands.subspan(first, count), program.envelope,
                  block.row(block_operand(first_state, static_cast<RegisterNumber>(input))));
    for (std::size_t state = 0; state < state_count; ++state) {
      float* row = block.row(block_operand(first_state, static_cast<RegisterNumber>(first_state + state)));
      for (std::size_t lane = 0; lane < count; ++lane) row[lane] = states[(first + lane) * state_count + state];
    }
    const FloatingPointMode mode;
    block.run(code_, registers_.data(), program.initial_cells.data());
    for (std::size_t root = 0; root < roots_.size(); ++root) {
      const BlockOperand operand = block_operand(first_state, roots_[root]);
      for (std::size_t lane = 0; lane < count; ++lane)
        values[root * hands.size() + first + lane] = block.value(operand, lane, registers_.data());
    }
  }
}

}  // namespace wale
