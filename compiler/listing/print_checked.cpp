#include "compiler/listing/print_checked.hpp"

#include <fmt/format.h>

#include <vector>

#include "compiler/listing/figures.hpp"

namespace wale {
namespace {

constexpr std::size_t place_column = 76;
/// A term of this length gets its own line even if it is used once.
constexpr std::size_t longest_term = 60;

class CheckedPrinter {
 public:
  CheckedPrinter(const CheckedMaterial& material, const DimensionNames& dimensions, const SourceLines& lines)
      : material_(material),
        dimensions_(dimensions),
        lines_(lines),
        uses_(material.terms.size()),
        texts_(material.terms.size()) {}

  std::string run() {
    line(0, fmt::format("material {}", material_.name), material_.span);
    print_declared();
    count_uses();
    for (TermId id = 0; id < uses_.size(); ++id)
      if (uses_[id] > 0) write(id);
    print_results();
    return std::move(text_);
  }

 private:
  void line(std::size_t depth, const std::string& text, Span span = {}) {
    const std::string place = span == Span{} ? "" : fmt::format("{}:{}", lines_.file(span.source), lines_.line(span));
    text_ += beside(std::string(2 * depth, ' ') + text, place_column, place) + '\n';
  }

  void print_declared() {
    for (std::size_t i = 0; i < material_.parameters.size(); ++i) {
      const Parameter& p = material_.parameters[i];
      const std::string unit = p.si_unit.empty() ? "" : " " + p.si_unit;
      line(1,
           fmt::format("param {} = {}{} in {}{} .. {}{}", p.name, figure(p.value), unit, figure(p.low), unit,
                       figure(p.high), unit),
           i < material_.parameter_spans.size() ? material_.parameter_spans[i] : Span{});
    }
    for (const auto& percept : material_.percepts) {
      const std::string tolerance = percept.tolerance > 0 ? fmt::format(" ± {}", figure(percept.tolerance)) : "";
      line(1, fmt::format("asks {} {}{}", percept.name, figure(percept.level), tolerance), percept.span);
    }
    if (material_.patch)
      line(1, fmt::format("patch {} m x {} m", figure((*material_.patch)[0]), figure((*material_.patch)[1])),
           material_.patch_span);
    for (std::size_t i = 0; i < material_.tables.size(); ++i)
      line(1, fmt::format("table {}: {} x {} heights", i, material_.tables[i].width, material_.tables[i].height));
  }

  std::vector<TermId> roots() const {
    std::vector<TermId> roots;
    if (material_.force) roots.insert(roots.end(), material_.force->begin(), material_.force->end());
    if (material_.relief) roots.push_back(*material_.relief);
    if (material_.colour) roots.insert(roots.end(), material_.colour->begin(), material_.colour->end());
    for (const auto& state : material_.states) roots.insert(roots.end(), {state.initial, state.next});
    for (const auto& memory : material_.memories)
      if (memory.next) roots.insert(roots.end(), {memory.next->u, memory.next->v, memory.next->value});
    for (const auto& mark : material_.marks) roots.insert(roots.end(), mark.operands.begin(), mark.operands.end());
    for (const auto& carrier : material_.carriers) roots.push_back(carrier.size);
    return roots;
  }

  /// How often each term is used in another one or in a result; 0 for terms that are not needed.
  void count_uses() {
    for (const TermId root : roots()) ++uses_[root];
    for (TermId id = static_cast<TermId>(uses_.size()); id-- > 0;)
      if (uses_[id] > 0)
        for (const TermId operand : operands(material_.terms[id])) ++uses_[operand];
  }

  /// Finds the text for a term: its expression, or the name of its own line.
  void write(TermId id) {
    const Term& term = material_.terms[id];
    std::string text = expression(term);
    const bool simple = operands(term).size() == 0;
    if (simple || (uses_[id] == 1 && text.size() < longest_term)) {
      texts_[id] = std::move(text);
      return;
    }
    texts_[id] = std::move(text);
    line(1, fmt::format("t{} = {}", id, bare(id)), term.span);
    texts_[id] = fmt::format("t{}", id);
  }

  /// The text of a term in a place that needs no parentheses.
  std::string bare(TermId id) const {
    const Term& term = material_.terms[id];
    const std::string& text = texts_[id];
    const bool enclosed = term.kind == TermKind::operation && outer_parentheses(term.operation) && text.front() == '(';
    return enclosed ? text.substr(1, text.size() - 2) : text;
  }

  static bool outer_parentheses(Operation operation) {
    switch (operation) {
      case Operation::add:
      case Operation::subtract:
      case Operation::multiply:
      case Operation::divide:
      case Operation::less:
      case Operation::select: return true;
      default: return false;
    }
  }

  std::string expression(const Term& term) const {
    const auto text = [&](TermId id) -> const std::string& { return texts_[id]; };
    switch (term.kind) {
      case TermKind::literal: return figure(term.value);
      case TermKind::input: return input_name(term.index);
      case TermKind::parameter: return material_.parameters[term.index].name;
      case TermKind::open: return fmt::format("?{}", term.index);
      case TermKind::settled: return text(term.a);
      case TermKind::magnitude: return "magnitude";
      case TermKind::carrier: return "carrier";
      case TermKind::state: return material_.states[term.index].name;
      case TermKind::cells:
        return fmt::format("{}({})", term.index % 2 == 0 ? "columns" : "rows", material_.memories[term.index / 2].name);
      case TermKind::component:
        return fmt::format("{}.{}", text(term.a), std::array{"value", "along_a", "along_b"}[term.index % 3]);
      case TermKind::gradient: return fmt::format("d/d{}({})", term.index == 0 ? 'x' : 'y', bare(term.a));
      case TermKind::peak: return fmt::format("peak({})", bare(term.a));
      case TermKind::operation: break;
    }
    const auto binary = [&](const char* sign) { return fmt::format("({} {} {})", text(term.a), sign, text(term.b)); };
    switch (term.operation) {
      case Operation::add: return binary("+");
      case Operation::subtract: return binary("-");
      case Operation::multiply: return binary("*");
      case Operation::divide: return binary("/");
      case Operation::less: return binary("<");
      case Operation::negate: return "-" + text(term.a);
      case Operation::select: return fmt::format("(if {} then {} else {})", text(term.a), text(term.b), text(term.c));
      default: break;
    }
    const OperationFacts& known = facts(term.operation);
    std::string arguments;
    for (const TermId operand : operands(term)) arguments += (arguments.empty() ? "" : ", ") + bare(operand);
    if (known.fields[2] == 't') arguments += fmt::format(", table {}", term.index);
    if (known.fields[2] == 'g') arguments += ", " + material_.memories[term.index].name;
    return fmt::format("{}({})", known.name, arguments);
  }

  void print_results() {
    const auto text = [&](TermId id) { return bare(id); };
    if (material_.force) {
      line(1, "force x = " + text((*material_.force)[0]), material_.force_span);
      line(1, "force y = " + text((*material_.force)[1]), material_.force_span);
    }
    for (const auto& state : material_.states) {
      line(1, fmt::format("state {} in {} .. {}", state.name, figure(state.low), figure(state.high)), state.span);
      line(2, "begins at " + text(state.initial));
      line(2, "becomes   " + text(state.next));
    }
    for (const auto& memory : material_.memories) {
      const std::string unit = dimensions_.unit(memory.dimension);
      line(1,
           fmt::format("memory {} = {}{}{} in {} .. {}, cells of {} m", memory.name, figure(memory.initial),
                       unit.empty() ? "" : " ", unit, figure(memory.low), figure(memory.high), figure(memory.cell)),
           memory.span);
      if (memory.next)
        line(2,
             fmt::format("at {}, {} becomes {}", text(memory.next->u), text(memory.next->v), text(memory.next->value)));
    }
    for (const auto& carrier : material_.carriers)
      line(1, fmt::format("carrier {} = {}{}", carrier.name, text(carrier.size), carrier.open ? ", left open" : ""),
           carrier.span);
    if (material_.relief)
      line(1, fmt::format("relief = {}{}", text(*material_.relief), material_.relief_is_length ? " m" : ""));
    if (material_.colour)
      line(1, fmt::format("colour = {}, {}, {}", text((*material_.colour)[0]), text((*material_.colour)[1]),
                          text((*material_.colour)[2])));
    for (const auto& mark : material_.marks) {
      std::string shape = fmt::format("mark of kind {} in #{:06x}:", static_cast<int>(mark.kind), mark.colour);
      for (const TermId operand : mark.operands) shape += " " + text(operand);
      line(1, shape);
    }
  }

  const CheckedMaterial& material_;
  const DimensionNames& dimensions_;
  const SourceLines& lines_;
  std::vector<std::size_t> uses_;
  std::vector<std::string> texts_;
  std::string text_;
};

}  // namespace

std::string print_checked(const CheckedMaterial& material, const DimensionNames& dimensions, const SourceLines& lines) {
  return CheckedPrinter(material, dimensions, lines).run();
}

}  // namespace wale
