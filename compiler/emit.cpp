#include "compiler/emit.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <map>

namespace wale {

namespace {

constexpr std::uint32_t peak_points = 16384;  // 164 of them above the 99th percentile
constexpr float peak_percentile = 0.99f;

/// Hands out temporaries of one section and takes them back after their last use.
class TemporaryAllocator {
 public:
  /// `count` neighbouring registers, the lowest that are free.
  std::size_t take(std::size_t count) {
    std::size_t first = 0;
    for (std::size_t run = 0, i = 0; run < count; ++i) {
      if (i == used_.size()) used_.push_back(false);
      run = used_[i] ? 0 : run + 1;
      first = i + 1 - run;
    }
    std::fill_n(used_.begin() + static_cast<std::ptrdiff_t>(first), count, true);
    return first;
  }
  void give_back(std::size_t first, std::size_t count) {
    std::fill_n(used_.begin() + static_cast<std::ptrdiff_t>(first), count, false);
  }
  std::size_t most() const { return used_.size(); }

 private:
  std::vector<bool> used_;
};

class Emitter {
 public:
  Emitter(const LoweredMaterial& lowered, const SolvedMaterial& material)
      : graph_(lowered.graph), lowered_(lowered), material_(material) {}

  PatchProgram emit() {
    program_.material = material_.name;
    program_.parameters = material_.parameters;
    program_.tables = material_.tables;
    program_.patch_width = static_cast<float>(material_.patch_width);
    program_.patch_height = static_cast<float>(material_.patch_height);
    program_.patch_rim = static_cast<float>(material_.patch_rim);
    program_.device = material_.device;
    program_.layers = material_.layers;

    plan();
    emit_setup();
    program_.tick = section({lowered_.force[0], lowered_.force[1]});
    for (std::uint8_t axis = 0; axis < 2; ++axis)
      program_.outputs.push_back({OutputQuantity::force, axis, at(lowered_.force[axis]), at(lowered_.ceiling)});
    if (lowered_.relief) {
      program_.picture.code = section({*lowered_.relief});
      program_.picture.relief = at(*lowered_.relief);
    } else {
      program_.picture.relief = at(zero_);
    }
    for (std::size_t i = 0; i < material_.percepts.size(); ++i) {
      PerceptRecord record = material_.percepts[i].record;
      record.amplitude = at(lowered_.percepts[i].amplitude);
      record.prediction = section({lowered_.percepts[i].magnitude, lowered_.percepts[i].level});
      record.magnitude = at(lowered_.percepts[i].magnitude);
      record.level = at(lowered_.percepts[i].level);
      program_.percepts.push_back(std::move(record));
    }
    program_.temporaries = static_cast<std::uint16_t>(std::min<std::size_t>(most_temporaries_, register_limit));
    return std::move(program_);
  }

  std::size_t registers_needed() const { return first_temporary_ + most_temporaries_; }

 private:
  /// Finds what is needed at all, then lays out constants, parameters and setup results.
  void plan() {
    std::vector<NodeId> roots{lowered_.force[0], lowered_.force[1], lowered_.ceiling};
    if (lowered_.relief) roots.push_back(*lowered_.relief);
    for (const auto& percept : lowered_.percepts)
      roots.insert(roots.end(), {percept.amplitude, percept.magnitude, percept.level});
    needed_.assign(graph_.size(), false);
    for (const NodeId root : roots) needed_[root] = true;
    for (NodeId id = static_cast<NodeId>(graph_.size()); id-- > 0;)
      if (needed_[id])
        for (const NodeId operand : graph_.operands(id)) needed_[operand] = true;
    registers_.assign(graph_.size(), 0);

    std::map<std::uint32_t, RegisterNumber> pool;
    const auto pooled = [&](float value) {
      const auto [entry, added] =
          pool.try_emplace(std::bit_cast<std::uint32_t>(value), first_constant + program_.constants.size());
      if (added) program_.constants.push_back(value);
      return entry->second;
    };
    for (NodeId id = 0; id < graph_.size(); ++id)
      if (needed_[id] && graph_[id].kind == Node::Kind::constant) registers_[id] = pooled(graph_[id].value);
    if (!lowered_.relief) zero_register_ = pooled(0.0f);

    const std::size_t first_parameter = first_constant + program_.constants.size();
    std::size_t next = first_parameter + program_.parameters.size();
    for (NodeId id = 0; id < graph_.size(); ++id) {
      const Node& node = graph_[id];
      if (!needed_[id]) continue;
      if (node.kind == Node::Kind::input) registers_[id] = static_cast<RegisterNumber>(node.index);
      if (node.kind == Node::Kind::parameter)
        registers_[id] = static_cast<RegisterNumber>(first_parameter + node.index);
      if (node.rate == Rate::setup && in_code(node)) registers_[id] = static_cast<RegisterNumber>(next++);
    }
    const std::size_t setup_registers = next - first_parameter - program_.parameters.size();
    program_.setup_registers = static_cast<std::uint16_t>(std::min<std::size_t>(setup_registers, register_limit));
    first_temporary_ = next;
  }

  static bool in_code(const Node& node) { return node.kind == Node::Kind::operation || node.kind == Node::Kind::peak; }

  RegisterNumber at(NodeId id) const { return id == zero_ ? zero_register_ : registers_[id]; }

  Instruction instruction(NodeId id) const {
    const Node& node = graph_[id];
    const auto operands = graph_.operands(id);
    Instruction code{.operation = static_cast<std::uint8_t>(node.operation), .destination = registers_[id]};
    if (operands.size() > 0) code.a = registers_[operands[0]];
    if (operands.size() > 1) code.b = registers_[operands[1]];
    if (operands.size() > 2) code.c = registers_[operands[2]];
    if (node.operation == Operation::sample) code.c = static_cast<RegisterNumber>(node.index);
    return code;
  }

  void emit_setup() {
    for (NodeId id = 0; id < graph_.size(); ++id) {
      const Node& node = graph_[id];
      if (!needed_[id] || node.rate != Rate::setup || !in_code(node)) continue;
      if (node.kind == Node::Kind::operation) {
        program_.setup.push_back(instruction(id));
        continue;
      }
      Peak peak;
      peak.code = section({node.a});
      peak.value = registers_[node.a];
      peak.half_width = registers_[node.b];
      peak.half_height = registers_[node.c];
      peak.points = peak_points;
      peak.percentile = peak_percentile;
      program_.setup.push_back({.operation = static_cast<std::uint8_t>(Operation::peak),
                                .destination = registers_[id],
                                .a = static_cast<RegisterNumber>(program_.peaks.size())});
      program_.peaks.push_back(std::move(peak));
    }
  }

  /// The code that works out the roots from inputs, constants, parameters and setup results. Leaves in `registers_` the
  /// temporaries of its values; the roots keep theirs to the end.
  std::vector<Instruction> section(const std::vector<NodeId>& roots) {
    std::vector<bool> wanted(graph_.size(), false);
    for (const NodeId root : roots) wanted[root] = graph_[root].rate == Rate::tick;
    for (NodeId id = static_cast<NodeId>(graph_.size()); id-- > 0;)
      if (wanted[id])
        for (const NodeId operand : graph_.operands(id))
          wanted[operand] = wanted[operand] || graph_[operand].rate == Rate::tick;

    std::vector<NodeId> order;
    for (NodeId id = 0; id < graph_.size(); ++id)
      if (wanted[id] && (graph_[id].kind == Node::Kind::operation || graph_[id].kind == Node::Kind::component))
        order.push_back(id);

    // A component is a register of its sample: using it uses the sample.
    const auto owner = [&](NodeId id) { return graph_[id].kind == Node::Kind::component ? graph_[id].a : id; };
    std::vector<std::size_t> last_use(graph_.size(), 0);
    for (std::size_t i = 0; i < order.size(); ++i)
      for (const NodeId operand : graph_.operands(order[i])) last_use[owner(operand)] = i;
    for (const NodeId root : roots) last_use[owner(root)] = order.size();

    TemporaryAllocator temporaries;
    std::vector<Instruction> code;
    const auto width = [&](NodeId id) { return static_cast<std::size_t>(facts(graph_[id].operation).results); };
    for (std::size_t i = 0; i < order.size(); ++i) {
      const NodeId id = order[i];
      const Node& node = graph_[id];
      if (node.kind == Node::Kind::component) {
        registers_[id] = static_cast<RegisterNumber>(registers_[node.a] + node.index);
      } else {
        registers_[id] = static_cast<RegisterNumber>(first_temporary_ + temporaries.take(width(id)));
        code.push_back(instruction(id));
      }
      std::vector<NodeId> finished;
      for (const NodeId operand : graph_.operands(id)) finished.push_back(owner(operand));
      finished.push_back(owner(id));
      std::ranges::sort(finished);
      finished.erase(std::ranges::unique(finished).begin(), finished.end());
      for (const NodeId done : finished)
        if (wanted[done] && graph_[done].kind == Node::Kind::operation && last_use[done] <= i)
          temporaries.give_back(registers_[done] - first_temporary_, width(done));
    }
    most_temporaries_ = std::max(most_temporaries_, temporaries.most());
    return code;
  }

  const Graph& graph_;
  const LoweredMaterial& lowered_;
  const SolvedMaterial& material_;
  PatchProgram program_;
  std::vector<bool> needed_;
  std::vector<RegisterNumber> registers_;
  std::size_t first_temporary_ = 0;
  std::size_t most_temporaries_ = 0;
  static constexpr NodeId zero_ = ~NodeId{0};  ///< stands for the constant 0 where a program has no relief
  RegisterNumber zero_register_ = 0;
};

}  // namespace

std::optional<PatchProgram> emit(const LoweredMaterial& lowered, const SolvedMaterial& material,
                                 Diagnostics& diagnostics) {
  Emitter emitter(lowered, material);
  PatchProgram program = emitter.emit();
  if (emitter.registers_needed() > register_limit) {
    diagnostics.report({.code = Code::program_too_large,
                        .span = material.span,
                        .message = fmt::format("`{}` needs {} registers, and a patch program has {}", material.name,
                                               emitter.registers_needed(), register_limit),
                        .help = "split the material, or let fewer values live at once"});
    return std::nullopt;
  }
  return program;
}

}  // namespace wale
