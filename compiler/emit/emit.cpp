#include "compiler/emit/emit.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <map>

#include "compiler/graph/temporaries.hpp"

namespace wale {

namespace {

constexpr std::uint32_t peak_points = 16384;  // 164 of them above the 99th percentile
constexpr float peak_percentile = 0.99f;

/// The nodes that a section still has to look at, the highest first. What comes in is lower than what was taken last.
class PendingNodes {
 public:
  explicit PendingNodes(std::size_t nodes) : words_(nodes / word_bits + 1) {}

  /// Whether it was not there yet.
  bool insert(NodeId id) {
    const std::size_t word = id / word_bits;
    const std::uint64_t bit = std::uint64_t{1} << id % word_bits;
    if ((words_[word] & bit) != 0) return false;
    words_[word] |= bit;
    highest_word_ = std::max(highest_word_, word);
    return true;
  }
  /// The highest of them, or nothing when there is none.
  std::optional<NodeId> take() {
    while (words_[highest_word_] == 0) {
      if (highest_word_ == 0) return std::nullopt;
      --highest_word_;
    }
    std::uint64_t& word = words_[highest_word_];
    const int bit = std::bit_width(word) - 1;
    word ^= std::uint64_t{1} << bit;
    return static_cast<NodeId>(highest_word_ * word_bits + static_cast<std::size_t>(bit));
  }

 private:
  static constexpr std::size_t word_bits = 64;

  std::vector<std::uint64_t> words_;  ///< a bit for each node
  std::size_t highest_word_ = 0;      ///< above it all bits are zero
};

class Emitter {
 public:
  Emitter(const LoweredMaterial& lowered, const SolvedMaterial& material)
      : graph_(lowered.graph), lowered_(lowered), material_(material), pending_(graph_.size()) {}

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
    picture.relief = lowered_.relief ? at(*lowered_.relief) : zero_register_;
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

  /// The lines that the instructions come from.
  SourcePlaces places(const SourceLines& lines) const {
    SourcePlaces places;
    std::map<SourceId, std::uint16_t> files;
    const auto runs_of = [&](const std::vector<Span>& spans) {
      std::vector<SourcePlaces::Run> runs;
      for (const Span& known : spans) {
        const Span span = known == Span{} ? material_.span : known;
        const auto [file, added] = files.try_emplace(span.source, static_cast<std::uint16_t>(places.files.size()));
        if (added) places.files.push_back(lines.file(span.source));
        const SourcePlaces::Run run{1, file->second, lines.line(span)};
        if (!runs.empty() && runs.back().file == run.file && runs.back().line == run.line)
          ++runs.back().instructions;
        else
          runs.push_back(run);
      }
      return runs;
    };
    places.sections.push_back(runs_of(setup_spans_));
    for (const auto& spans : section_spans_) places.sections.push_back(runs_of(spans));
    return places;
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
    last_use_.assign(graph_.size(), no_use);

    // Each constant is one node, so there is nothing to look up: the register of the first comes first.
    const auto pooled = [&](float value) {
      program_.constants.push_back(value);
      return static_cast<RegisterNumber>(first_constant + program_.constants.size() - 1);
    };
    for (NodeId id = 0; id < graph_.size(); ++id) {
      if (!needed_[id] || graph_[id].kind != Node::Kind::constant) continue;
      registers_[id] = pooled(graph_[id].value);
      if (graph_.is_constant(id, 0.0f)) zero_register_ = registers_[id];
    }
    if (!lowered_.relief && zero_register_ == 0) zero_register_ = pooled(0.0f);

    const std::size_t first_parameter = first_constant + program_.constants.size();
    std::size_t next = first_parameter + program_.parameters.size();
    for (NodeId id = 0; id < graph_.size(); ++id) {
      const Node& node = graph_[id];
      if (!needed_[id]) continue;
      if (node.kind == Node::Kind::input) registers_[id] = static_cast<RegisterNumber>(node.index);
      if (node.kind == Node::Kind::parameter)
        registers_[id] = static_cast<RegisterNumber>(first_parameter + node.index);
      if (node.rate == Rate::setup && node.kind == Node::Kind::component)
        registers_[id] = static_cast<RegisterNumber>(registers_[node.a] + node.index);
      if (node.rate == Rate::setup && in_code(node)) {
        registers_[id] = static_cast<RegisterNumber>(next);
        next += node.kind == Node::Kind::operation ? static_cast<std::size_t>(facts(node.operation).results) : 1;
      }
    }
    const std::size_t setup_registers = next - first_parameter - program_.parameters.size();
    program_.setup_registers = static_cast<std::uint16_t>(std::min<std::size_t>(setup_registers, register_limit));
    for (NodeId id = 0; id < graph_.size(); ++id)
      if (needed_[id] && graph_[id].kind == Node::Kind::state)
        registers_[id] = static_cast<RegisterNumber>(next + graph_[id].index);
    first_temporary_ = next + lowered_.states.size();
  }

  static bool in_code(const Node& node) { return node.kind == Node::Kind::operation || node.kind == Node::Kind::peak; }

  RegisterNumber at(NodeId id) const { return registers_[id]; }

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
      setup_spans_.push_back(node.span);
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

  /// Asks for a value in the section at work, if that is where it is worked out. Values are asked for from the last to
  /// the first, so whoever is first to ask for one is last to use it.
  void want(NodeId id, NodeId user) {
    const Node& node = graph_[id];
    if (node.rate != Rate::tick) return;
    if (node.kind == Node::Kind::component) want(node.a, user);  // it is a register of its sample
    const bool worked_out = node.kind == Node::Kind::operation || node.kind == Node::Kind::component;
    if (worked_out && pending_.insert(id)) last_use_[id] = user;
  }

  /// What a section has to work out for its roots, operands first; `last_use_` says until when each is needed.
  std::vector<NodeId> wanted_by(const std::vector<NodeId>& roots) {
    std::vector<NodeId> wanted;
    for (const NodeId root : roots) want(root, no_use);
    while (const auto id = pending_.take()) {
      wanted.push_back(*id);
      for (const NodeId operand : graph_.operands(*id)) want(operand, *id);
    }
    std::ranges::reverse(wanted);
    return wanted;
  }

  /// The code that works out the roots from inputs, constants, parameters and setup results. Leaves in `registers_` the
  /// temporaries of its values; the roots keep theirs to the end.
  std::vector<Instruction> section(const std::vector<NodeId>& roots) {
    const std::vector<NodeId> order = wanted_by(roots);
    Temporaries temporaries;
    std::vector<Instruction> code;
    code.reserve(order.size());
    auto& spans = section_spans_.emplace_back();
    const auto width = [&](NodeId id) { return static_cast<std::size_t>(facts(graph_[id].operation).results); };
    for (const NodeId id : order) {
      const Node& node = graph_[id];
      if (node.kind == Node::Kind::component) {
        registers_[id] = static_cast<RegisterNumber>(registers_[node.a] + node.index);
        continue;
      }
      registers_[id] = static_cast<RegisterNumber>(first_temporary_ + temporaries.take(width(id)));
      code.push_back(instruction(id));
      spans.push_back(node.span);
      for (const NodeId operand : graph_.operands(id)) {
        const NodeId owner = graph_[operand].kind == Node::Kind::component ? graph_[operand].a : operand;
        if (last_use_[owner] == id)  // giving back twice is giving back once
          temporaries.give_back(registers_[owner] - first_temporary_, width(owner));
      }
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
  PendingNodes pending_;          ///< of the section at work
  std::vector<NodeId> last_use_;  ///< by node: who is the last in that section to use it
  std::size_t first_temporary_ = 0;
  std::size_t most_temporaries_ = 0;
  static constexpr NodeId no_use = ~NodeId{0};    ///< of a root, needed to the end, and of what no section works out
  RegisterNumber zero_register_ = 0;              ///< of the constant 0: the relief of a program that has none
  std::vector<Span> setup_spans_;                 ///< of setup's instructions
  std::vector<std::vector<Span>> section_spans_;  ///< of the other sections', which are made in the format's order
};

}  // namespace

std::optional<PatchProgram> emit(const LoweredMaterial& lowered, const SolvedMaterial& material,
                                 Diagnostics& diagnostics, const SourceLines* lines) {
  Emitter emitter(lowered, material);
  PatchProgram program = emitter.emit();
  if (lines) program.places = emitter.places(*lines);
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
