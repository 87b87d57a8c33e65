#include "compiler/declare.hpp"

#include <fmt/format.h>

#include <cmath>

#include "compiler/declare_records.hpp"
#include "compiler/spelling.hpp"

namespace wale {

namespace {

/// Works out one file's dimensions and units, which may refer to each other only backwards.
class Declarer {
 public:
  Declarer(const SyntaxTree& tree, const SourceSet& sources, Declarations& declarations, Diagnostics& diagnostics)
      : tree_(tree), sources_(sources), declarations_(declarations), diagnostics_(diagnostics) {}

  void operator()(const Import&) {}

  void operator()(const DimensionDecl& node) {
    auto& names = declarations_.names;
    if (declarations_.dimensions.contains(node.name.text)) return twice(node.name, "dimension");
    Dimension dimension;
    if (node.definition) {
      const auto known = dimension_of(*node.definition);
      if (!known) return;
      dimension = *known;
    } else {
      if (names.base_units.size() == Dimension::capacity)
        return report(Code::number_out_of_range, node.name.span,
                      fmt::format("more than {} base dimensions", Dimension::capacity),
                      "define it by others, as in `dimension area = length^2`");
      dimension.twelfths[names.base_units.size()] = Dimension::unit_exponent;
      names.base_units.push_back(node.name.text);  // until its unit is declared
    }
    declarations_.dimensions[node.name.text] = dimension;
    names.dimensions.push_back({node.name.text, dimension});
  }

  void operator()(const UnitDecl& node) {
    if (declarations_.units.contains(node.name.text)) return twice(node.name, "unit");
    Unit unit;
    if (node.dimension) {
      const auto found = declarations_.dimensions.find(node.dimension->text);
      if (found == declarations_.dimensions.end()) return unknown_dimension(*node.dimension);
      unit.dimension = found->second;
      for (std::size_t i = 0; i < declarations_.names.base_units.size(); ++i) {
        Dimension base;
        base.twelfths[i] = Dimension::unit_exponent;
        if (unit.dimension == base) declarations_.names.base_units[i] = node.name.text;
      }
    } else {
      Terms terms;
      std::vector<HeightTable> tables;
      ExpressionChecker checker({sources_, declarations_, diagnostics_}, terms, tables);
      Scope scope;
      const Value value = checker.check(tree_, *node.definition, scope);
      if (value.failed()) return;
      const auto factor = value.type == Value::Type::number ? constant_value(terms, value.x) : std::nullopt;
      if (!factor || !std::isfinite(*factor) || *factor <= 0)
        return report(Code::not_constant, value.span, "a unit is a positive quantity known at compile time",
                      "write, for example, `unit thou = 25.4 um`");
      unit = {*factor, value.dimension};
    }
    declarations_.units[node.name.text] = unit;
    if (unit.factor == 1 && !unit.dimension.plain())
      declarations_.names.units.push_back({node.name.text, unit.dimension});
  }

  void operator()(const Constant& node) {
    if (declarations_.constants.contains(node.name.text)) return twice(node.name, "constant");
    declarations_.constants[node.name.text] = {&tree_, &node};
  }

  void operator()(const FunctionDecl& node) {
    if (declarations_.functions.contains(node.name.text) || is_builtin_function(node.name.text))
      return twice(node.name, "function");
    for (std::size_t i = 0; i < node.parameters.size(); ++i)
      for (std::size_t before = 0; before < i; ++before)
        if (node.parameters[i].name.text == node.parameters[before].name.text)
          report(Code::declared_twice, node.parameters[i].name.span,
                 fmt::format("`{}` has two arguments `{}`", node.name.text, node.parameters[i].name.text),
                 "give one of them another name");
    for (const auto& parameter : node.parameters)
      if (parameter.dimension && !declarations_.dimensions.contains(parameter.dimension->text))
        unknown_dimension(*parameter.dimension);
    declarations_.functions[node.name.text] = {&tree_, &node};
  }

  void operator()(const RecordDecl& node) {
    RecordReader reader(tree_, node, sources_, declarations_, diagnostics_);
    const auto& keyword = node.keyword.text;
    if (keyword == "percept") declare_percept(reader, declarations_);
    if (keyword == "map") declare_map(reader, declarations_);
    if (keyword == "device") declare_device(reader, declarations_);
    if (keyword == "levels") declare_levels(reader, declarations_);
    if (keyword == "hand") declare_hand(reader, declarations_);
    reader.report_unknown_settings();
  }

  void operator()(const MaterialDecl& node) {
    for (const auto& other : declarations_.materials)
      if (other.node->name.text == node.name.text) return twice(node.name, "material");
    declarations_.materials.push_back({&tree_, &node});
  }

 private:
  /// `mass * length / time^2`: names of dimensions, multiplied, divided and raised to whole powers.
  std::optional<Dimension> dimension_of(ExprId expr) {
    const Expr& node = tree_.expr(expr);
    // In `1 / time` the parser takes what follows the number for its unit.
    if (const auto* number = std::get_if<NumberLiteral>(&node); number && number->value == 1) {
      Dimension dimension;
      for (const auto& part : number->suffix) {
        const auto found = declarations_.dimensions.find(part.name.text);
        const auto raised = found == declarations_.dimensions.end()
                                ? std::nullopt
                                : power(found->second, part.divides ? -part.exponent : part.exponent);
        if (!raised) {
          unknown_dimension(part.name);
          return std::nullopt;
        }
        dimension = dimension * *raised;
      }
      return dimension;
    }
    if (const auto* use = std::get_if<NameUse>(&node)) {
      const auto found = declarations_.dimensions.find(use->name);
      if (found != declarations_.dimensions.end()) return found->second;
      unknown_dimension({use->name, tree_.span(expr)});
      return std::nullopt;
    }
    if (const auto* binary = std::get_if<Binary>(&node)) {
      const auto left = dimension_of(binary->left);
      if (!left) return std::nullopt;
      if (binary->op == BinaryOperator::power) {
        const auto* exponent = std::get_if<NumberLiteral>(&tree_.expr(binary->right));
        if (exponent && exponent->suffix.empty() && std::abs(exponent->value) <= 32 &&
            exponent->value == std::floor(exponent->value))
          if (const auto raised = power(*left, static_cast<int>(exponent->value))) return raised;
      } else if (binary->op == BinaryOperator::multiply || binary->op == BinaryOperator::divide) {
        const auto right = dimension_of(binary->right);
        if (!right) return std::nullopt;
        return binary->op == BinaryOperator::multiply ? *left * *right : *left / *right;
      }
    }
    report(Code::wrong_type, tree_.span(expr), "a dimension is a product of dimensions",
           "write, for example, `dimension force = mass * length / time^2`");
    return std::nullopt;
  }

  void unknown_dimension(const Word& word) {
    std::vector<std::string> candidates;
    for (const auto& [name, dimension] : declarations_.dimensions) candidates.push_back(name);
    const auto near = nearest_spelling(word.text, candidates);
    report(Code::unknown_name, word.span, fmt::format("nothing declares a dimension `{}`", word.text),
           near ? fmt::format("did you mean `{}`?", *near)
                : fmt::format("declare it, as in `dimension {} = …`", word.text));
  }

  void twice(const Word& word, const char* kind) {
    report(Code::declared_twice, word.span, fmt::format("a {} `{}` is declared already", kind, word.text),
           "give one of them another name");
  }

  void report(Code code, Span span, std::string message, std::string help) {
    diagnostics_.report({.code = code, .span = span, .message = std::move(message), .help = std::move(help)});
  }

  const SyntaxTree& tree_;
  const SourceSet& sources_;
  Declarations& declarations_;
  Diagnostics& diagnostics_;
};

}  // namespace

void declare(const SyntaxTree& tree, const SourceSet& sources, Declarations& declarations, Diagnostics& diagnostics) {
  Declarer declarer(tree, sources, declarations, diagnostics);
  // Records speak of units, percepts and functions wherever in the file those stand.
  for (const auto& declaration : tree.declarations)
    if (!std::holds_alternative<RecordDecl>(declaration)) std::visit(declarer, declaration);
  for (const char* keyword : {"percept", "map", "device", "levels", "hand"})
    for (const auto& declaration : tree.declarations)
      if (const auto* record = std::get_if<RecordDecl>(&declaration); record && record->keyword.text == keyword)
        declarer(*record);
}

}  // namespace wale
