#include "compiler/emit/emit.hpp"

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
    std::size_t first = lowest_free();
    for (std::size_t run = 1, i = first + 1; run < count; ++i) {
      run = is_used(i) ? 0 : run + 1;
      first = i + 1 - run;
    }
    for (std::size_t i = first; i < first + count; ++i) {
      if (i / word_bits == used_.size()) used_.push_back(0);
      used_[i / word_bits] |= bit(i);
    }
    most_ = std::max(most_, first + count);
    return first;
  }
  void give_back(std::size_t first, std::size_t count) {
    for (std::size_t i = first; i < first + count; ++i) used_[i / word_bits] &= ~bit(i);
  }
  std::size_t most() const { return most_; }

 private:
  static constexpr std::size_t word_bits = 64;

  static std::uint64_t bit(std::size_t i) { return std::uint64_t{1} << i % word_bits; }
  bool is_used(std::size_t i) const { return i / word_bits < used_.size() && (used_[i / word_bits] & bit(i)) != 0; }
  /// Looks at 64 registers at a time, since hundreds may be in use.
  std::size_t lowest_free() const {
    std::size_t word = 0;
    while (word < used_.size() && used_[word] == ~std::uint64_t{0}) ++word;
    return word * word_bits + (word < used_.size() ? static_cast<std::size_t>(std::countr_one(used_[word])) : 0);
  }

  std::vector<std::uint64_t> used_;  ///< a bit for each register
  std::size_t most_ = 0;
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
    program_.active_watt = static_cast<float>(material_.active_watt);
    program_.device = material_.device;
    program_.layers = material_.layers;

    plan();
    emit_setup();
    emit_enter();
    emit_tick();
    emit_picture();
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

  void emit_enter() {
    std::vector<NodeId> roots;
    for (const auto& state : lowered_.states) roots.push_back(state.initial);
    program_.enter = section(roots);
    for (std::size_t i = 0; i < lowered_.states.size(); ++i) {
      const CheckedState& state = material_.states[i];
      program_.states.push_back({.name = state.name,
                                 .low = static_cast<float>(state.low),
                                 .high = static_cast<float>(state.high),
                                 .initial = at(lowered_.states[i].initial)});
    }
  }

  void emit_tick() {
    std::vector<NodeId> roots{lowered_.force[0], lowered_.force[1]};
    for (const auto& state : lowered_.states) roots.push_back(state.next);
    for (const auto& write : lowered_.writes) roots.insert(roots.end(), {write.u, write.v, write.value});
    program_.tick = section(roots);
    for (std::uint8_t axis = 0; axis < 2; ++axis)
      program_.outputs.push_back({OutputQuantity::force, axis, at(lowered_.force[axis]), at(lowered_.ceiling)});
    for (std::size_t i = 0; i < lowered_.states.size(); ++i) program_.states[i].next = at(lowered_.states[i].next);
    program_.grids = material_.memories;
    for (std::size_t i = 0; i < lowered_.writes.size(); ++i)
      program_.writes.push_back({.grid = material_.writes[i].memory,
                                 .u = at(lowered_.writes[i].u),
                                 .v = at(lowered_.writes[i].v),
                                 .value = at(lowered_.writes[i].value)});
  }

  void emit_picture() {
    Picture& picture = program_.picture;
    std::vector<NodeId> roots;
    if (lowered_.relief) roots.push_back(*lowered_.relief);
    if (lowered_.colour) roots.insert(roots.end(), lowered_.colour->begin(), lowered_.colour->end());
    picture.code = section(roots);
    picture.relief = lowered_.relief ? at(*lowered_.relief) : at(zero_);
    picture.relief_is_length = material_.relief_is_length;
    if (lowered_.colour)
      picture.colour = {at((*lowered_.colour)[0]), at((*lowered_.colour)[1]), at((*lowered_.colour)[2])};
    roots.clear();
    for (const auto& operands : lowered_.marks) roots.insert(roots.end(), operands.begin(), operands.end());
    picture.frame = section(roots);
    for (std::size_t i = 0; i < lowered_.marks.size(); ++i) {
      Mark mark{.kind = material_.marks[i].kind, .operands = {}, .colour = material_.marks[i].colour};
      std::ranges::transform(lowered_.marks[i], mark.operands.begin(), [&](NodeId id) { return at(id); });
      picture.marks.push_back(mark);
    }
  }

  std::size_t registers_needed() const { return first_temporary_ + most_temporaries_; }

 private:
  /// Finds what is needed at all, then lays out constants, parameters and setup results.
  void plan() {
    std::vector<NodeId> roots{lowered_.force[0], lowered_.force[1], lowered_.ceiling};
    if (lowered_.relief) roots.push_back(*lowered_.relief);
    if (lowered_.colour) roots.insert(roots.end(), lowered_.colour->begin(), lowered_.colour->end());
    for (const auto& state : lowered_.states) roots.insert(roots.end(), {state.initial, state.next});
    for (const auto& write : lowered_.writes) roots.insert(roots.end(), {write.u, write.v, write.value});
    for (const auto& operands : lowered_.marks) roots.insert(roots.end(), operands.begin(), operands.end());
    for (const auto& percept : lowered_.percepts)
      roots.insert(roots.end(), {percept.amplitude, percept.magnitude, percept.level});
    needed_.assign(graph_.size(), false);
    for (const NodeId root : roots) needed_[root] = true;
    for (NodeId id = static_cast<NodeId>(graph_.size()); id-- > 0;)
      if (needed_[id])
        for (const NodeId operand : graph_.operands(id)) needed_[operand] = true;
    registers_.assign(graph_.size(), 0);
    wanted_in_.assign(graph_.size(), 0);
    last_use_.assign(graph_.size(), 0);

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
    for (NodeId id = 0; id < graph_.size(); ++id)
      if (needed_[id] && graph_[id].kind == Node::Kind::state)
        registers_[id] = static_cast<RegisterNumber>(next + graph_[id].index);
    first_temporary_ = next + lowered_.states.size();
  }

  static bool in_code(const Node& node) { return node.kind == Node::Kind::operation || node.kind == Node::Kind::peak; }

  RegisterNumber at(NodeId id) const { return id == zero_ ? zero_register_ : registers_[id]; }

  Instruction instruction(NodeId id) const {
    const Node& node = graph_[id];
    const OperationFacts& known = facts(node.operation);
    Instruction code{.operation = static_cast<std::uint8_t>(node.operation), .destination = registers_[id]};
    if (known.operands > 0) code.a = registers_[node.a];
    if (known.operands > 1) code.b = registers_[node.b];
    if (known.operands > 2) code.c = registers_[node.c];
    if (known.fields[2] == 't' || known.fields[2] == 'g') code.c = static_cast<RegisterNumber>(node.index);
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

  /// What a section has to work out for its roots, operands first.
  std::vector<NodeId> wanted_by(const std::vector<NodeId>& roots) {
    ++section_;
    std::vector<NodeId> wanted;
    const auto want = [&](NodeId id) {
      const Node& node = graph_[id];
      const bool worked_out = node.kind == Node::Kind::operation || node.kind == Node::Kind::component;
      if (!worked_out || node.rate != Rate::tick || wanted_in_[id] == section_) return;
      wanted_in_[id] = section_;
      last_use_[id] = 0;
      wanted.push_back(id);
    };
    for (const NodeId root : roots) want(root);
    for (std::size_t next = 0; next < wanted.size(); ++next)
      for (const NodeId operand : graph_.operands(wanted[next])) want(operand);
    std::ranges::sort(wanted);
    return wanted;
  }

  /// The code that works out the roots from inputs, constants, parameters and setup results. Leaves in `registers_` the
  /// temporaries of its values; the roots keep theirs to the end.
  std::vector<Instruction> section(const std::vector<NodeId>& roots) {
    const std::vector<NodeId> order = wanted_by(roots);

    // A component is a register of its sample: using it uses the sample.
    const auto owner = [&](NodeId id) { return graph_[id].kind == Node::Kind::component ? graph_[id].a : id; };
    for (std::size_t i = 0; i < order.size(); ++i)
      for (const NodeId operand : graph_.operands(order[i])) last_use_[owner(operand)] = i;
    for (const NodeId root : roots) last_use_[owner(root)] = order.size();

    TemporaryAllocator temporaries;
    std::vector<Instruction> code;
    code.reserve(order.size());
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
      const auto finish = [&](NodeId done) {  // giving back twice is giving back once
        if (wanted_in_[done] == section_ && last_use_[done] <= i)
          temporaries.give_back(registers_[done] - first_temporary_, width(done));
      };
      for (const NodeId operand : graph_.operands(id)) finish(owner(operand));
      finish(owner(id));
    }
    most_temporaries_ = std::max(most_temporaries_, temporaries.most());
    return code;
  }

  const Graph& graph_;
  const LoweredMaterial& lowered_;
  const SolvedMaterial& material_;
  PatchProgram program_;
  std::vector<char> needed_;
  std::vector<RegisterNumber> registers_;
  std::uint32_t section_ = 0;             ///< number of the section at work, from 1
  std::vector<std::uint32_t> wanted_in_;  ///< by node: the last section that works it out
  std::vector<std::size_t> last_use_;     ///< by node: where in that section's order it is needed last
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
