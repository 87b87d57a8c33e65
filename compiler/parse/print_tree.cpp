#include "compiler/parse/print_tree.hpp"

#include <fmt/format.h>

namespace wale {
namespace {

std::string text_of(const Word& word) { return std::string(word.text); }

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
    if (number.suffix.count == 0) return fmt::format("{}", number.value);
    std::string suffix;
    for (const SuffixFactor& factor : tree.suffix(number)) {
      suffix += factor.divides ? '/' : ' ';
      suffix += factor.name.text;
      if (factor.exponent != 1) suffix += fmt::format("^{}", factor.exponent);
    }
    return fmt::format("[{}{}]", number.value, suffix);
  }
  std::string operator()(const TextLiteral& text) const { return quoted(text.text); }
  std::string operator()(const NameUse& name) const { return std::string(name.name); }
  std::string operator()(const Unary& unary) const {
    const char* op = unary.op == UnaryOperator::negate ? "-" : unary.op == UnaryOperator::plus ? "+" : "not";
    return fmt::format("({} {})", op, print(unary.operand));
  }
  std::string operator()(const Binary& binary) const {
    return fmt::format("({} {} {})", spelled(binary.op), print(binary.left), print(binary.right));
  }
  std::string operator()(const Call& call) const {
    std::string result = "(" + (call.quoted ? quoted(call.callee.text) : text_of(call.callee));
    for (const Argument& argument : tree.arguments(call)) {
      result += ' ';
      if (argument.name) result += text_of(*argument.name) + ": ";
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

/// Writes nested lists, with one line for each declaration, section and statement.
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

  void operator()(const Import& import) { line(0, "(import " + text_of(import.module) + ")"); }
  void operator()(const DimensionDecl& dimension) {
    line(0, exported(dimension) + "(dimension " + text_of(dimension.name) + optional(dimension.definition) +
                range(dimension.range) + ")");
  }
  void operator()(const UnitDecl& unit) {
    line(0, documented(unit.documentation) + exported(unit) + "(unit " + text_of(unit.name) + typed(unit.dimension) +
                optional(unit.definition) + ")");
  }
  void operator()(const Constant& constant) {
    line(0, documented(constant.documentation) + exported(constant) + "(let " + text_of(constant.name) + " " +
                expr(constant.value) + ")");
  }
  void operator()(const FunctionDecl& function) {
    std::string text = documented(function.documentation) + exported(function) + "(function (" + text_of(function.name);
    for (const FormalParameter& parameter : function.parameters) {
      text += " " + text_of(parameter.name) + typed(parameter.dimension);
      if (parameter.default_value) text += " = " + expr(*parameter.default_value);
    }
    line(0, text + ") " + expr(function.body) + ")");
  }
  void operator()(const RecordDecl& record) {
    line(0, documented(record.documentation) + exported(record) + "(" + text_of(record.keyword) + " " +
                text_of(record.name) + (record.from ? " from " + text_of(*record.from) : ""));
    settings(1, record.settings);
    result_ += ")";
  }
  void operator()(const WorkspaceDecl& workspace) {
    line(0, documented(workspace.documentation) + "(workspace " + text_of(workspace.name));
    for (const PlacedStatement& placed : workspace.placed) {
      if (const auto* patch = std::get_if<PatchPlacing>(&placed)) {
        const MaterialDecl& material = patch->material;
        line(1, documented(material.documentation) + "(patch " + text_of(material.name) + " = " +
                    expr(*material.derived_from));
        settings(2, patch->settings);
      } else {
        const auto& picture = std::get<PicturePlacing>(placed);
        line(1, "(patches from " + expr(picture.picture));
        settings(2, picture.settings);
      }
      result_ += ")";
    }
    result_ += ")";
  }
  void operator()(const MaterialDecl& material) {
    line(0, documented(material.documentation) + "(material " + text_of(material.name));
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
  static std::string typed(const std::optional<Word>& dimension) {
    return dimension ? " : " + text_of(*dimension) : "";
  }
  static std::string documented(std::string_view documentation) {
    return documentation.empty() ? "" : "(documented " + quoted(documentation) + ") ";
  }
  std::string range(const std::optional<Range>& range) const {
    return range ? fmt::format(" (in {} {})", expr(range->low), expr(range->high)) : "";
  }

  void settings(int depth, const std::vector<Setting>& settings) {
    for (const Setting& setting : settings) {
      std::string text = "(" + text_of(setting.key);
      for (const SettingItem& item : setting.items) text += " " + item_text(item);
      if (setting.on) text += " on " + text_of(*setting.on);
      line(depth, text + ")");
    }
  }

  /// An item of a single word or value is written bare, everything else in braces.
  std::string item_text(const SettingItem& item) const {
    std::string text;
    const auto append = [&](const std::string& part) { text += (text.empty() ? "" : " ") + part; };
    for (const Word& word : item.words) append(text_of(word));
    if (item.value) append(expr(*item.value));
    if (item.range_end) append(".. " + expr(*item.range_end));
    if (item.equals) append("= " + expr(*item.equals));
    for (const Word& word : item.trailing) append(text_of(word));
    const std::size_t parts = item.words.size() + item.trailing.size() + item.value.has_value() +
                              item.equals.has_value() + item.range_end.has_value();
    return parts == 1 ? text : "{" + text + "}";
  }

  std::string percept_text(const PerceptStatement& percept) const {
    std::string text = percept.essential ? "(essential " : "(";
    text += text_of(percept.name) + optional(percept.value);
    if (percept.level_name && !percept.level_name->text.empty()) text += " '" + text_of(*percept.level_name);
    if (percept.tolerance) text += " ± " + expr(*percept.tolerance);
    if (percept.by) text += " by " + text_of(*percept.by);
    return text + ")";
  }

  std::string statement_text(const ParamStatement& param) const {
    std::string text = documented(param.documentation) + "(param " + text_of(param.name) + " " + expr(param.value) +
                       range(param.range);
    if (param.soft_range)
      text += fmt::format(" (soft {} {})", expr(param.soft_range->low), expr(param.soft_range->high));
    if (!param.description.empty()) text += " " + quoted(param.description);
    return text + ")";
  }
  std::string statement_text(const LetStatement& let) const {
    return "(let " + text_of(let.name) + " " + expr(let.value) + ")";
  }
  std::string statement_text(const HeightStatement& height) const {
    return "(height " + text_of(height.name) + " " + expr(height.value) + ")";
  }
  std::string statement_text(const ForceStatement& force) const {
    return "(force " + (force.name ? text_of(*force.name) + " " : "") + expr(force.value) +
           (force.limit ? " (limit " + expr(*force.limit) + ")" : "") + ")";
  }
  std::string statement_text(const PatchStatement& patch) const {
    std::string text = "(patch";
    for (const ExprId size : patch.sizes) text += " " + expr(size);
    return text + ")";
  }
  std::string statement_text(const ActiveStatement& active) const { return "(active " + expr(active.power) + ")"; }
  std::string statement_text(const StateStatement& state) const {
    return "(state " + text_of(state.name) + typed(state.dimension) + " " + expr(state.value) + range(state.range) +
           ")";
  }
  std::string statement_text(const MemoryStatement& memory) const {
    return "(memory " + text_of(memory.name) + typed(memory.dimension) + " " + expr(memory.value) +
           range(memory.range) + " (cell " + expr(memory.cell) + "))";
  }
  std::string statement_text(const UpdateStatement& update) const {
    return (update.derivative ? "(derivative " : "(next ") + text_of(update.name) + " " + expr(update.value) + ")";
  }
  std::string statement_text(const ShowStatement& show) const { return "(show " + expr(show.value) + ")"; }

  const SyntaxTree& tree_;
  std::string result_;
};

}  // namespace

std::string print_tree(const SyntaxTree& tree) { return TreePrinter(tree).run(); }

std::string print_expression(const SyntaxTree& tree, ExprId id) { return ExpressionPrinter{tree}.print(id); }

}  // namespace wale
