#include "compiler/listing/print_graph.hpp"

#include <fmt/format.h>

#include <vector>

#include "compiler/listing/figures.hpp"

namespace wale {
namespace {

constexpr std::size_t rate_column = 8, value_column = 30, origin_column = 76;

/// The sections that compute values at the rate of the tick, one bit each.
enum SectionBit : unsigned { peak = 1, enter = 2, tick = 4, picture = 8, frame = 16, prediction = 32 };

class GraphPrinter {
 public:
  GraphPrinter(const LoweredMaterial& lowered, const SolvedMaterial& material, const SourceLines& lines)
      : lowered_(lowered),
        graph_(lowered.graph),
        material_(material),
        lines_(lines),
        sections_(graph_.size(), 0),
        needed_(graph_.size(), false) {}

  std::string run() {
    find_needed();
    std::size_t needed = 0;
    for (const char each : needed_) needed += each ? 1 : 0;
    text_ = fmt::format("values of {}: {}, {} of them needed\n", material_.name, graph_.size(), needed);
    for (NodeId id = 0; id < graph_.size(); ++id)
      if (needed_[id]) print_value(id);
    print_results();
    return std::move(text_);
  }

 private:
  void want(NodeId id, unsigned section) {
    needed_[id] = true;
    sections_[id] |= section;
  }

  void find_needed() {
    for (const NodeId id : lowered_.force) want(id, tick);
    for (const NodeId id : lowered_.ceiling) want(id, tick);
    if (lowered_.relief) want(*lowered_.relief, picture);
    if (lowered_.colour)
      for (const NodeId id : *lowered_.colour) want(id, picture);
    for (const auto& state : lowered_.states) want(state.initial, enter), want(state.next, tick);
    for (const auto& write : lowered_.writes)
      for (const NodeId id : {write.u, write.v, write.value}) want(id, tick);
    for (const auto& mark : lowered_.marks)
      for (const NodeId id : mark) want(id, frame);
    for (const auto& percept : lowered_.percepts)
      for (const NodeId id : {percept.amplitude, percept.magnitude, percept.level}) want(id, prediction);
    for (NodeId id = static_cast<NodeId>(graph_.size()); id-- > 0;) {
      if (!needed_[id]) continue;
      const Node& node = graph_[id];
      // The value of a peak is computed over its lattice; the extents of the lattice are not.
      if (node.kind == Node::Kind::peak) want(node.a, peak);
      for (const NodeId operand : graph_.operands(id))
        want(operand, node.kind == Node::Kind::peak || node.rate != Rate::tick ? 0 : sections_[id]);
    }
  }

  std::string rate_of(NodeId id) const {
    const Node& node = graph_[id];
    if (node.rate == Rate::constant) return "constant";
    if (node.rate == Rate::setup) return "setup";
    std::string rate;
    static constexpr const char* names[] = {"peak", "enter", "tick", "picture", "frame", "prediction"};
    for (unsigned bit = 0; bit < 6; ++bit)
      if (sections_[id] & 1u << bit) rate += (rate.empty() ? "" : "+") + std::string(names[bit]);
    return rate;
  }

  std::string value_text(NodeId id) const {
    const Node& node = graph_[id];
    switch (node.kind) {
      case Node::Kind::constant: return figure(node.value());
      case Node::Kind::input: return input_name(node.index);
      case Node::Kind::parameter: return "parameter " + material_.parameters[node.index].name;
      case Node::Kind::state: return "state " + material_.states[node.index].name;
      case Node::Kind::component: return fmt::format("result {} of %{}", node.index, node.a);
      case Node::Kind::peak: return fmt::format("peak of %{} within %{} %{}", node.a, node.b, node.c);
      case Node::Kind::operation: break;
    }
    const OperationFacts& known = facts(node.operation);
    std::string text(known.name);
    for (const NodeId operand : graph_.operands(id)) text += fmt::format(" %{}", operand);
    if (known.fields[2] == 't') text += fmt::format(" table {}", node.index);
    if (known.fields[2] == 'g') text += " " + material_.memories[node.index].name;
    return text;
  }

  void print_value(NodeId id) {
    const Node& node = graph_[id];
    // The line of a constant's or an input's first use says nothing of its other uses.
    const bool placed =
        node.kind == Node::Kind::operation || node.kind == Node::Kind::component || node.kind == Node::Kind::peak;
    std::string text = beside(fmt::format("  %{}", id), rate_column, rate_of(id));
    text = beside(std::move(text), value_column, value_text(id));
    const std::string place = placed && node.span != Span{}
                                  ? fmt::format("{}:{}", lines_.file(node.span.source), lines_.line(node.span))
                                  : "";
    text_ += beside(std::move(text), origin_column, place) + '\n';
  }

  void print_results() {
    const auto result = [&](const std::string& text) { text_ += text + '\n'; };
    const bool vibrates = material_.device.shaker.has_value();
    result(fmt::format("{} = %{}, {} = %{}", vibrates ? "amplitude" : "force x", lowered_.force[0],
                       vibrates ? "frequency" : "force y", lowered_.force[1]));
    for (std::size_t i = 0; i < lowered_.states.size(); ++i)
      result(fmt::format("{} begins at %{} and becomes %{}", material_.states[i].name, lowered_.states[i].initial,
                         lowered_.states[i].next));
    for (std::size_t i = 0; i < lowered_.writes.size(); ++i)
      result(fmt::format("{} at %{} %{} becomes %{}", material_.memories[material_.writes[i].memory].name,
                         lowered_.writes[i].u, lowered_.writes[i].v, lowered_.writes[i].value));
    if (lowered_.relief) result(fmt::format("relief = %{}", *lowered_.relief));
    if (lowered_.colour)
      result(fmt::format("colour = %{} %{} %{}", (*lowered_.colour)[0], (*lowered_.colour)[1], (*lowered_.colour)[2]));
    for (std::size_t i = 0; i < lowered_.marks.size(); ++i) {
      std::string text = fmt::format("mark {} at", i);
      for (const NodeId operand : lowered_.marks[i]) text += fmt::format(" %{}", operand);
      result(text);
    }
    for (std::size_t i = 0; i < lowered_.percepts.size(); ++i)
      result(fmt::format("{} of %{}: magnitude %{}, level %{}", material_.percepts[i].record.name,
                         lowered_.percepts[i].amplitude, lowered_.percepts[i].magnitude, lowered_.percepts[i].level));
  }

  const LoweredMaterial& lowered_;
  const Graph& graph_;
  const SolvedMaterial& material_;
  const SourceLines& lines_;
  std::vector<unsigned> sections_;  ///< by value: the sections that compute it
  std::vector<char> needed_;
  std::string text_;
};

}  // namespace

std::string print_graph(const LoweredMaterial& lowered, const SolvedMaterial& material, const SourceLines& lines) {
  return GraphPrinter(lowered, material, lines).run();
}

}  // namespace wale
