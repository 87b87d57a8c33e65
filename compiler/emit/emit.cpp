#include "compiler/emit/emit.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <map>
#include <ranges>

#include "compiler/graph/temporaries.hpp"
#include "compiler/text/readable.hpp"

namespace wale {

namespace {

constexpr std::uint32_t peak_points = 16384;  // 164 of them lie above the 99th percentile
constexpr float peak_percentile = 0.99f;

/// Facts about an operation that sections need, by its number.
struct Shape {
  std::uint8_t results = 0;
  bool looks_up = false;  ///< in the table or grid whose number is its third field
};

constexpr auto shapes = [] {
  std::array<Shape, operation_table.size()> all{};
  for (std::size_t number = 0; number < all.size(); ++number) {
    const OperationFacts& known = operation_table[number];
    if (!known.name.empty())
      all[number] = {static_cast<std::uint8_t>(known.results), known.fields[2] == 't' || known.fields[2] == 'g'};
  }
  return all;
}();

class Emitter {
 public:
  Emitter(const LoweredMaterial& lowered, const SolvedMaterial& material, Diagnostics& diagnostics)
      : graph_(lowered.graph), lowered_(lowered), material_(material), diagnostics_(diagnostics) {}

  /// The program; incomplete if it takes too much work, which is reported.
  PatchProgram emit() {
    program_.material = material_.name;
    program_.parameters = material_.parameters;
    program_.tables = material_.tables;
    program_.patch_width = static_cast<float>(material_.patch_width);
    program_.patch_height = static_cast<float>(material_.patch_height);
    program_.patch_rim = static_cast<float>(material_.patch_rim);
    program_.active_watt = static_cast<float>(material_.active_watt);
    program_.device = material_.device;
    if (!material_.limited) program_.device.force_newton = unlimited_newton;
    program_.fates = material_.fates;
    program_.claims = material_.claims;
    program_.layers = material_.layers;

    section_steps_.reserve(lowered_.percepts.size() + 8);
    program_.percepts.reserve(lowered_.percepts.size());
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
    roots.reserve(lowered_.states.size());
    for (const auto& state : lowered_.states) roots.push_back(state.initial);
    program_.enter = section(roots);
    for (std::size_t i = 0; i < lowered_.states.size(); ++i) {
      const CheckedState& state = material_.states[i];
      program_.states.push_back({.name = state.name,
                                 .low = static_cast<float>(state.low),
                                 .high = static_cast<float>(state.high),
                                 .initial = at(lowered_.states[i].initial),
                                 .si_unit = state.si_unit});
    }
  }

  void emit_tick() {
    std::vector<NodeId> roots{lowered_.force[0], lowered_.force[1]};
    for (const auto& state : lowered_.states) roots.push_back(state.next);
    for (const auto& write : lowered_.writes) roots.insert(roots.end(), {write.u, write.v, write.value});
    program_.tick = section(roots);
    for (std::uint8_t i = 0; i < 2; ++i) {
      Output output{.axis = i, .value = at(lowered_.force[i]), .ceiling = at(lowered_.ceiling[i])};
      if (material_.device.shaker)
        output.quantity = i == 0 ? OutputQuantity::amplitude : OutputQuantity::frequency, output.axis = 0;
      program_.outputs.push_back(output);
    }
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

  /// The source line of each instruction.
  SourcePlaces places(const SourceLines& lines) const {
    SourcePlaces places;
    std::map<SourceId, std::uint16_t> files;
    // A node may be in several sections; its line is searched once.
    std::vector<SourcePlaces::Run> known(graph_.size(), {0, 0, 0});
    const auto run_of = [&](NodeId id) {
      SourcePlaces::Run& run = known[id];
      if (run.instructions == 1) return run;
      const Span span = graph_[id].span == Span{} ? material_.span : graph_[id].span;
      const auto [file, added] = files.try_emplace(span.source, static_cast<std::uint16_t>(places.files.size()));
      if (added) places.files.push_back(lines.file(span.source));
      run = {1, file->second, lines.line(span)};
      return run;
    };
    const auto runs_of = [&](const std::vector<NodeId>& nodes) {
      std::vector<SourcePlaces::Run> runs;
      for (auto each = nodes.rbegin(); each != nodes.rend(); ++each) {
        const NodeId id = *each;
        const SourcePlaces::Run run = run_of(id);
        if (!runs.empty() && runs.back().file == run.file && runs.back().line == run.line)
          ++runs.back().instructions;
        else
          runs.push_back(run);
      }
      return runs;
    };
    places.sections.push_back(runs_of(setup_nodes_));
    for (const auto& steps : section_steps_) {
      std::vector<NodeId> nodes;
      for (const Step* step : steps) nodes.push_back(static_cast<NodeId>(step - steps_.data()));
      places.sections.push_back(runs_of(nodes));
    }
    return places;
  }

  std::size_t registers_needed() const { return first_temporary_ + most_temporaries_; }

 private:
  static constexpr std::uint32_t not_needed = ~std::uint32_t{0}, in_no_section = not_needed - 1;

  /// A node as a section sees it; each section fills it in anew. A component is represented by its sample, as one of
  /// the sample's registers. A missing operand is result 0 of `nothing_`.
  struct Step {
    std::array<Step*, 3> operands{};  ///< for a component, its sample
    /// which of the operand's registers; for `nothing_`, the number of a table or a grid
    std::array<RegisterNumber, 3> results{};
    Operation operation = Operation::add;
    std::uint8_t width = 0;  ///< registers
    /// The first register. It may be beyond the limit of a program; then `emit` refuses the program.
    std::uint32_t location = 0;
    /// The last section that computes it, from 1; otherwise `not_needed`, or `in_no_section` if setup or no section
    /// computes it.
    std::uint32_t wanted = not_needed;
    std::array<bool, 3> last_uses{};  ///< whether this is the last use of the operand in that section
  };

  /// Finds the nodes that are needed, then assigns registers to constants, parameters and setup results.
  void plan() {
    find_needed();
    // Each constant is one node, so the registers follow the order of the nodes.
    const auto pooled = [&](float value) {
      program_.constants.push_back(value);
      return static_cast<std::uint32_t>(first_constant + program_.constants.size() - 1);
    };
    program_.constants.reserve(constant_nodes_.size() + 1);
    for (const NodeId id : constant_nodes_) {
      steps_[id].location = pooled(graph_[id].value());
      if (graph_.is_constant(id, 0.0f)) zero_register_ = at(id);
    }
    if (!lowered_.relief && zero_register_ == 0) zero_register_ = static_cast<RegisterNumber>(pooled(0.0f));

    const std::size_t first_parameter = first_constant + program_.constants.size();
    const std::size_t first_setup = first_parameter + program_.parameters.size();
    for (const NodeId id : parameter_nodes_)
      steps_[id].location = static_cast<std::uint32_t>(first_parameter + graph_[id].index);
    std::size_t next = first_setup;
    for (auto each = setup_nodes_.rbegin(); each != setup_nodes_.rend(); ++each) {
      Step& step = steps_[*each];
      step.location = static_cast<std::uint32_t>(next);
      next += step.width;
    }
    program_.setup_registers = static_cast<std::uint16_t>(std::min<std::size_t>(next - first_setup, register_limit));
    for (const NodeId id : state_nodes_) steps_[id].location = static_cast<std::uint32_t>(next + graph_[id].index);
    first_temporary_ = next + lowered_.states.size();
  }

  /// Marks the nodes that are needed, and fills in what sections need to know of them.
  void find_needed() {
    steps_.assign(graph_.size(), Step{.operands = {&nothing_, &nothing_, &nothing_}});
    backwards_.resize(steps_.size());
    for (auto* nodes : {&constant_nodes_, &parameter_nodes_, &state_nodes_, &setup_nodes_}) nodes->reserve(64);
    Step* const steps = steps_.data();
    const auto need = [steps](NodeId id) { steps[id].wanted = in_no_section; };
    for (const NodeId id : {lowered_.force[0], lowered_.force[1], lowered_.ceiling[0], lowered_.ceiling[1]}) need(id);
    if (lowered_.relief) need(*lowered_.relief);
    if (lowered_.colour) std::ranges::for_each(*lowered_.colour, need);
    for (const auto& state : lowered_.states) need(state.initial), need(state.next);
    for (const auto& write : lowered_.writes) need(write.u), need(write.v), need(write.value);
    for (const auto& operands : lowered_.marks) std::ranges::for_each(operands, need);
    for (const auto& percept : lowered_.percepts) need(percept.amplitude), need(percept.magnitude), need(percept.level);

    for (auto id = static_cast<NodeId>(steps_.size()); id-- > 0;) {
      Step& step = steps[id];
      if (step.wanted == not_needed) continue;
      const Node& node = graph_[id];
      if (node.kind == Node::Kind::operation) {  // the most frequent kind
        look_at(node, step);
        for (Step* operand : step.operands) operand->wanted = in_no_section;
        if (node.rate == Rate::tick)
          step.wanted = 0;
        else
          setup_nodes_.push_back(id);
        continue;
      }
      switch (node.kind) {
        case Node::Kind::constant: constant_nodes_.push_back(id); break;
        case Node::Kind::input: step.location = node.index; break;
        case Node::Kind::parameter: parameter_nodes_.push_back(id); break;
        case Node::Kind::state: state_nodes_.push_back(id); break;
        case Node::Kind::component: need(node.a); break;
        case Node::Kind::peak:
          need(node.a), need(node.b), need(node.c);
          step.width = 1;
          setup_nodes_.push_back(id);
          break;
        case Node::Kind::operation: break;
      }
    }
    std::ranges::reverse(constant_nodes_);
  }

  /// Fills in the step of an operation, without operands.
  void look_at(const Node& node, Step& step) {
    const Shape shape = shapes[static_cast<std::size_t>(node.operation)];
    step.operation = node.operation;
    step.width = shape.results;
    const auto take = [&](std::size_t i, NodeId id) {
      const Node& operand = graph_[id];
      step.operands[i] = &steps_[id];
      if (operand.kind != Node::Kind::component) return;
      step.operands[i] = &steps_[operand.a];
      step.results[i] = static_cast<RegisterNumber>(operand.index);
    };
    if (node.operands > 0) take(0, node.a);
    if (node.operands > 1) take(1, node.b);
    if (node.operands > 2) take(2, node.c);
    if (shape.looks_up) step.results[2] = static_cast<RegisterNumber>(node.index);
  }

  /// The register that holds a value.
  RegisterNumber at(NodeId id) const {
    const Node& node = graph_[id];
    if (node.kind != Node::Kind::component) return static_cast<RegisterNumber>(steps_[id].location);
    return static_cast<RegisterNumber>(steps_[node.a].location + node.index);
  }

  /// Writes the instruction of a step.
  static void write(Instruction& instruction, const Step& step, std::uint32_t a, std::uint32_t b, std::uint32_t c) {
    instruction.operation = static_cast<std::uint8_t>(step.operation);
    instruction.destination = static_cast<RegisterNumber>(step.location);
    instruction.a = static_cast<RegisterNumber>(a + step.results[0]);
    instruction.b = static_cast<RegisterNumber>(b + step.results[1]);
    instruction.c = static_cast<RegisterNumber>(c + step.results[2]);
  }

  void emit_setup() {
    program_.setup.reserve(setup_nodes_.size());
    for (auto each = setup_nodes_.rbegin(); each != setup_nodes_.rend(); ++each) {
      const NodeId id = *each;
      const Node& node = graph_[id];
      if (node.kind == Node::Kind::operation) {
        const Step& step = steps_[id];
        const auto [a, b, c] = step.operands;
        write(program_.setup.emplace_back(), step, a->location, b->location, c->location);
        continue;
      }
      Peak peak;
      peak.code = section({node.a});
      peak.value = at(node.a);
      peak.half_width = at(node.b);
      peak.half_height = at(node.c);
      peak.points = peak_points;
      peak.percentile = peak_percentile;
      program_.setup.push_back({.operation = static_cast<std::uint8_t>(Operation::peak),
                                .destination = at(id),
                                .a = static_cast<RegisterNumber>(program_.peaks.size())});
      program_.peaks.push_back(std::move(peak));
    }
  }

  /// The steps of a section for its roots, last step first. Values are requested from the last to the first, so the
  /// first to request a value is its last user: `last_uses` says for which operands.
  const std::vector<Step*>& backwards_from(const std::vector<NodeId>& roots) {
    const auto section = static_cast<std::uint32_t>(section_steps_.size() + 1);
    std::size_t pending = 0;  // requested and not processed yet
    const auto want = [&](Step& step) {
      const bool first = step.wanted < section;
      step.wanted = std::max(step.wanted, section);
      pending += first;
      return first;
    };
    std::size_t end = 0;
    for (const NodeId root : roots) {
      const NodeId id = graph_[root].kind == Node::Kind::component ? graph_[root].a : root;
      if (want(steps_[id])) end = std::max<std::size_t>(end, id + 1);
    }
    constexpr std::size_t looks_of_an_operation = 4;
    if (!diagnostics_.charge(end / looks_of_an_operation, material_.span, Work::program)) pending = 0;
    Step** next = backwards_.data();
    for (Step* step = steps_.data() + end; pending > 0;) {
      if ((--step)->wanted != section) continue;
      --pending;
      *next++ = step;
      step->last_uses[0] = want(*step->operands[0]);
      step->last_uses[1] = want(*step->operands[1]);
      step->last_uses[2] = step->operands[2] != &nothing_ && want(*step->operands[2]);  // rarely
    }
    return section_steps_.emplace_back(backwards_.data(), next);
  }

  /// The code that computes the roots from inputs, constants, parameters and setup results. Leaves the temporaries of
  /// its values in `steps_`; the roots keep theirs to the end.
  std::vector<Instruction> section(const std::vector<NodeId>& roots) {
    const std::vector<Step*>& backwards = backwards_from(roots);
    std::vector<Instruction> code(backwards.size());
    if (!write_code<FewTemporaries>(backwards, code.data())) write_code<Temporaries>(backwards, code.data());
    return code;
  }

  /// Writes an instruction for each step, last step first. False if that many temporaries are not enough.
  template <typename SomeTemporaries>
  bool write_code(const std::vector<Step*>& backwards, Instruction* next) {
    SomeTemporaries temporaries;
    const auto first = static_cast<std::uint32_t>(first_temporary_);
    for (Step *const *begin = backwards.data(), *const *each = begin + backwards.size(); each != begin;) {
      Step& step = **--each;
      const Step &a = *step.operands[0], &b = *step.operands[1], &c = *step.operands[2];
      const std::uint32_t at_a = a.location, at_b = b.location, at_c = c.location;
      if (!temporaries.has_room(step.width)) return false;
      step.location = first + static_cast<std::uint32_t>(temporaries.take(step.width));
      write(*next++, step, at_a, at_b, at_c);
      temporaries.give_back_if(step.last_uses[0], at_a - first, a.width);
      temporaries.give_back_if(step.last_uses[1], at_b - first, b.width);
      if (step.last_uses[2]) temporaries.give_back(at_c - first, c.width);
    }
    most_temporaries_ = std::max(most_temporaries_, temporaries.most());
    return true;
  }

  const Graph& graph_;
  const LoweredMaterial& lowered_;
  const SolvedMaterial& material_;
  Diagnostics& diagnostics_;
  PatchProgram program_;

  /// The operand of an operation without this operand: register 0, which no section sets.
  Step nothing_{.wanted = in_no_section};
  std::vector<Step> steps_;       ///< by node
  std::vector<Step*> backwards_;  ///< storage for the steps of a section
  std::size_t first_temporary_ = 0;
  std::size_t most_temporaries_ = 0;
  RegisterNumber zero_register_ = 0;  ///< of the constant 0: the relief of a program without one
  std::vector<NodeId> constant_nodes_, parameter_nodes_, state_nodes_;  ///< the nodes that are needed
  std::vector<NodeId> setup_nodes_;                                     ///< computed by setup, one instruction each
  /// of the other sections, last step first; sections in the order of the format
  std::vector<std::vector<Step*>> section_steps_;
};

}  // namespace

std::optional<PatchProgram> emit(const LoweredMaterial& lowered, const SolvedMaterial& material,
                                 Diagnostics& diagnostics, const SourceLines* lines) {
  Emitter emitter(lowered, material, diagnostics);
  PatchProgram program = emitter.emit();
  if (diagnostics.is_spent()) return std::nullopt;
  if (lines) program.places = emitter.places(*lines);
  if (emitter.registers_needed() > register_limit) {
    diagnostics.report({.code = Code::program_too_large,
                        .span = material.span,
                        .message = readable("`{}` needs {} registers, and a patch program has {}", material.name,
                                            emitter.registers_needed(), register_limit),
                        .help = "split the material, or use values soon after they are computed"});
    return std::nullopt;
  }
  return program;
}

}  // namespace wale
