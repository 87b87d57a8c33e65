#include "compiler/parse/print_tree.hpp"

#include <fmt/format.h>

namespace wale {
namespace {

std::string quoted(std::string_view text) {
  std::string result = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\') result += '\\';
    result += c == '\n' ? ' ' : c;
  }
  return result + '"';
}

const char* spelled(BinaryOperator op) {
  switch (op) {
    case BinaryOperator::add: return "+";
    case BinaryOperator::subtract: return "-";
    case BinaryOperator::multiply: return "*";
    case BinaryOperator::divide: return "/";
    case BinaryOperator::power: return "^";
    case BinaryOperator::less: return "<";
    case BinaryOperator::less_equal: return "<=";
    case BinaryOperator::greater: return ">";
    case BinaryOperator::greater_equal: return ">=";
    case BinaryOperator::conjunction: return "and";
    case BinaryOperator::disjunction: return "or";
  }
  return "?";
}

struct ExpressionPrinter {
  const SyntaxTree& tree;

  std::string print(ExprId id) const { return std::visit(*this, tree.expr(id)); }

  std::string operator()(const NumberLiteral& number) const {
    if (number.suffix.empty()) return fmt::format("{}", number.value);
    std::string suffix;
    for (const SuffixFactor& factor : number.suffix) {
      suffix += (factor.divides ? "/" : " ") + factor.name.text;
      if (factor.exponent != 1) suffix += fmt::format("^{}", factor.exponent);
    }
    return fmt::format("[{}{}]", number.value, suffix);
  }
  std::string operator()(const TextLiteral& text) const { return quoted(text.text); }
  std::string operator()(const NameUse& name) const { return name.name; }
  std::string operator()(const Unary& unary) const {
    const char* op = unary.op == UnaryOperator::negate ? "-" : unary.op == UnaryOperator::plus ? "+" : "not";
    return fmt::format("({} {})", op, print(unary.operand));
  }
  std::string operator()(const Binary& binary) const {
    return fmt::format("({} {} {})", spelled(binary.op), print(binary.left), print(binary.right));
  }
  std::string operator()(const Call& call) const {
    std::string result = "(" + call.callee.text;
    for (const Argument& argument : call.arguments) {
      result += ' ';
      if (argument.name) result += argument.name->text + ": ";
      result += print(argument.value);
    }
    return result + ")";
  }
  std::string operator()(const Conditional& conditional) const {
    return fmt::format("(if {} {} {})", print(conditional.condition), print(conditional.yes), print(conditional.no));
  }
  std::string operator()(const Part& part) const { return fmt::format("(. {} {})", print(part.whole), part.part); }
  std::string operator()(const Erroneous&) const { return "<error>"; }
};

/// Writes nested lists with one line for each declaration, section and statement.
class TreePrinter {
 public:
  explicit TreePrinter(const SyntaxTree& tree) : tree_(tree) {}

  std::string run() {
    for (const Declaration& declaration : tree_.declarations) {
      std::visit(*this, declaration);
      result_ += '\n';
    }
    return std::move(result_);
  }

  void operator()(const Import& import) { line(0, "(import " + import.module.text + ")"); }
  void operator()(const DimensionDecl& dimension) {
    line(0, exported(dimension) + "(dimension " + dimension.name.text + optional(dimension.definition) +
                range(dimension.range) + ")");
  }
  void operator()(const UnitDecl& unit) {
    line(0, documented(unit.documentation) + exported(unit) + "(unit " + unit.name.text + typed(unit.dimension) +
                optional(unit.definition) + ")");
  }
  void operator()(const Constant& constant) {
    line(0, documented(constant.documentation) + exported(constant) + "(let " + constant.name.text + " " +
                expr(constant.value) + ")");
  }
  void operator()(const FunctionDecl& function) {
    std::string text = documented(function.documentation) + exported(function) + "(function (" + function.name.text;
    for (const FormalParameter& parameter : function.parameters) {
      text += " " + parameter.name.text + typed(parameter.dimension);
      if (parameter.default_value) text += " = " + expr(*parameter.default_value);
    }
    line(0, text + ") " + expr(function.body) + ")");
  }
  void operator()(const RecordDecl& record) {
    line(0, documented(record.documentation) + exported(record) + "(" + record.keyword.text + " " + record.name.text +
                (record.from ? " from " + record.from->text : ""));
    settings(1, record.settings);
    result_ += ")";
  }
  void operator()(const MaterialDecl& material) {
    line(0, documented(material.documentation) + "(material " + material.name.text);
    if (material.derived_from) result_ += " = " + expr(*material.derived_from);
    if (!material.representative.empty()) {
      line(1, "(representative");
      settings(2, material.representative);
      result_ += ")";
    }
    if (!material.perceptual.empty()) {
      line(1, "(perceptual");
      for (const PerceptStatement& percept : material.perceptual) line(2, percept_text(percept));
      result_ += ")";
    }
    if (!material.physical.empty()) {
      line(1, "(physical");
      for (const PhysicalStatement& statement : material.physical) {
        line(2, std::visit([&](const auto& each) { return statement_text(each); }, statement.what));
      }
      result_ += ")";
    }
    result_ += ")";
  }

 private:
  void line(int depth, const std::string& text) {
    if (depth > 0) result_ += "\n" + std::string(static_cast<std::size_t>(2 * depth), ' ');
    result_ += text;
  }

  std::string expr(ExprId id) const { return print_expression(tree_, id); }
  std::string optional(const std::optional<ExprId>& id) const { return id ? " " + expr(*id) : ""; }
  template <class Node>
  static std::string exported(const Node& node) {
    return node.exported ? "export " : "";
  }
  static std::string typed(const std::optional<Word>& dimension) { return dimension ? " : " + dimension->text : ""; }
  static std::string documented(const std::string& documentation) {
    return documentation.empty() ? "" : "(documented " + quoted(documentation) + ") ";
  }
  std::string range(const std::optional<Range>& range) const {
    return range ? fmt::format(" (in {} {})", expr(range->low), expr(range->high)) : "";
  }

  void settings(int depth, const std::vector<Setting>& settings) {
    for (const Setting& setting : settings) {
      std::string text = "(" + setting.key.text;
      for (const SettingItem& item : setting.items) text += " " + item_text(item);
      if (setting.on) text += " on " + setting.on->text;
      line(depth, text + ")");
    }
  }

  /// An item of a single word or value stands bare, everything else in braces.
  std::string item_text(const SettingItem& item) const {
    std::string text;
    const auto append = [&](const std::string& part) { text += (text.empty() ? "" : " ") + part; };
    for (const Word& word : item.words) append(word.text);
    if (item.value) append(expr(*item.value));
    if (item.range_end) append(".. " + expr(*item.range_end));
    if (item.equals) append("= " + expr(*item.equals));
    for (const Word& word : item.trailing) append(word.text);
    const std::size_t parts = item.words.size() + item.trailing.size() + item.value.has_value() +
                              item.equals.has_value() + item.range_end.has_value();
    return parts == 1 ? text : "{" + text + "}";
  }

  std::string percept_text(const PerceptStatement& percept) const {
    std::string text = percept.essential ? "(essential " : "(";
    text += percept.name.text + optional(percept.value);
    if (percept.level_name) text += " '" + percept.level_name->text;
    if (percept.tolerance) text += " ± " + expr(*percept.tolerance);
    if (percept.by) text += " by " + percept.by->text;
    return text + ")";
  }

  std::string statement_text(const ParamStatement& param) const {
    std::string text =
        documented(param.documentation) + "(param " + param.name.text + " " + expr(param.value) + range(param.range);
    if (param.soft_range)
      text += fmt::format(" (soft {} {})", expr(param.soft_range->low), expr(param.soft_range->high));
    if (!param.description.empty()) text += " " + quoted(param.description);
    return text + ")";
  }
  std::string statement_text(const LetStatement& let) const {
    return "(let " + let.name.text + " " + expr(let.value) + ")";
  }
  std::string statement_text(const HeightStatement& height) const {
    return "(height " + height.name.text + " " + expr(height.value) + ")";
  }
  std::string statement_text(const ForceStatement& force) const {
    return "(force " + (force.name ? force.name->text + " " : "") + expr(force.value) + ")";
  }
  std::string statement_text(const PatchStatement& patch) const {
    std::string text = "(patch";
    for (const ExprId size : patch.sizes) text += " " + expr(size);
    return text + ")";
  }
  std::string statement_text(const ActiveStatement& active) const { return "(active " + expr(active.power) + ")"; }
  std::string statement_text(const StateStatement& state) const {
    return "(state " + state.name.text + typed(state.dimension) + " " + expr(state.value) + range(state.range) + ")";
  }
  std::string statement_text(const MemoryStatement& memory) const {
    return "(memory " + memory.name.text + typed(memory.dimension) + " " + expr(memory.value) + range(memory.range) +
           " (cell " + expr(memory.cell) + "))";
  }
  std::string statement_text(const UpdateStatement& update) const {
    return (update.derivative ? "(derivative " : "(next ") + update.name.text + " " + expr(update.value) + ")";
  }
  std::string statement_text(const ShowStatement& show) const { return "(show " + expr(show.value) + ")"; }

  const SyntaxTree& tree_;
  std::string result_;
};

}  // namespace

std::string print_tree(const SyntaxTree& tree) { return TreePrinter(tree).run(); }

std::string print_expression(const SyntaxTree& tree, ExprId id) { return ExpressionPrinter{tree}.print(id); }

}  // namespace wale
