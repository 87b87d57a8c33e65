#include "compiler/modules/declare.hpp"

#include <fmt/format.h>

#include <cmath>

#include "compiler/modules/declare_records.hpp"

namespace wale {

namespace {

/// Declares what one file declares. Dimensions and units may refer only to earlier ones.
class Declarer {
 public:
  Declarer(const SyntaxTree& tree, const SourceSet& sources, Declarations& declarations, Diagnostics& diagnostics)
      : tree_(tree), sources_(sources), declarations_(declarations), diagnostics_(diagnostics) {}

  void operator()(const Import&) {}

  void operator()(const DimensionDecl& node) {
    if (twice(declarations_.dimensions, node.name, "dimension")) return;
    auto& names = declarations_.shared_names->own();
    Dimension dimension;
    if (node.definition) {
      const auto known = dimension_of(*node.definition);
      if (!known) return;
      dimension = *known;
    } else {
      if (names.base_units.size() == Dimension::capacity)
        return report(Code::number_out_of_range, node.name.span,
                      fmt::format("more than {} base dimensions", Dimension::capacity),
                      "define it in terms of others, as in `dimension area = length^2`");
      dimension.twelfths[names.base_units.size()] = Dimension::unit_exponent;
      names.base_units.emplace_back(node.name.text);  // a placeholder until its unit is declared
    }
    enter(declarations_.dimensions, node, dimension);
    enter(declarations_.dimension_bounds, node, DimensionBounds{&tree_, node.range});
    names.dimensions.push_back({std::string(node.name.text), dimension});
  }

  void operator()(const UnitDecl& node) {
    if (twice(declarations_.units, node.name, "unit")) return;
    Unit unit;
    if (node.dimension) {
      const auto* found = declarations_.dimensions.find(node.dimension->text);
      if (!found) return unknown_dimension(*node.dimension);
      unit.dimension = *found;
      for (std::size_t i = 0; i < declarations_.names().base_units.size(); ++i) {
        Dimension base;
        base.twelfths[i] = Dimension::unit_exponent;
        if (unit.dimension == base) declarations_.shared_names->own().base_units[i] = node.name.text;
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
        return report(Code::not_constant, value.span, "a unit must be a positive quantity known at compile time",
                      "write, for example, `unit thou = 25.4 um`");
      unit = {*factor, value.dimension};
    }
    enter(declarations_.units, node, unit);
    if (unit.factor == 1 && !unit.dimension.plain())
      declarations_.shared_names->own().units.push_back({std::string(node.name.text), unit.dimension});
  }

  void operator()(const Constant& node) {
    if (names_hand_or_patch(node.name.text))
      return report(Code::declared_twice, node.name.span,
                    fmt::format("`{}` is already a name of the hand or the patch", node.name.text),
                    "give it another name");
    if (!twice(declarations_.constants, node.name, "constant"))
      enter(declarations_.constants, node, Declared<Constant>{&tree_, &node, &declarations_});
  }

  void operator()(const FunctionDecl& node) {
    if (is_builtin_function(node.name.text))
      return report(Code::declared_twice, node.name.span, fmt::format("`{}` is a builtin function", node.name.text),
                    "give yours another name");
    if (twice(declarations_.functions, node.name, "function")) return;
    for (std::size_t i = 0; i < node.parameters.size(); ++i)
      for (std::size_t before = 0; before < i; ++before)
        if (node.parameters[i].name.text == node.parameters[before].name.text)
          report(Code::declared_twice, node.parameters[i].name.span,
                 fmt::format("`{}` has two arguments `{}`", node.name.text, node.parameters[i].name.text),
                 Advice("give one of them another name").see(node.parameters[before].name.span, "the first one"));
    for (const auto& parameter : node.parameters)
      if (parameter.dimension && !declarations_.dimension_named(parameter.dimension->text))
        unknown_dimension(*parameter.dimension);
    for (const auto& parameter : node.parameters)
      if (const auto* hidden = declarations_.constants.entry(parameter.name.text))
        report(Code::shadowed_name, parameter.name.span,
               fmt::format("the argument `{}` hides the constant of the same name", parameter.name.text),
               Advice(fmt::format("give it another name, or leave it if that is intended; the constant is {}",
                                  whereabouts(hidden->declared)))
                   .see(hidden->declared, "the constant that it hides"));
    enter(declarations_.functions, node, Declared<FunctionDecl>{&tree_, &node, &declarations_});
  }

  void operator()(const RecordDecl& node) {
    RecordReader reader(tree_, node, sources_, declarations_, diagnostics_);
    const auto& keyword = node.keyword.text;
    if (keyword == "percept") declare_percept(reader, declarations_);
    if (keyword == "map") declare_map(reader, declarations_);
    if (keyword == "threshold") declare_threshold(reader, declarations_);
    if (keyword == "rule") declare_rule(reader, declarations_);
    if (keyword == "class") declare_class(reader, declarations_);
    if (keyword == "device") declare_device(reader, declarations_);
    if (keyword == "levels") declare_levels(reader, declarations_);
    if (keyword == "hand") declare_hand(reader, declarations_);
    reader.report_keys();
  }

  void operator()(const MaterialDecl& node) {
    if (!twice(declarations_.materials, node.name, "material"))
      declarations_.materials.add(
          node.name.text, {.what = {&tree_, &node, &declarations_}, .declared = node.name.span, .exported = true});
  }

  void operator()(const WorkspaceDecl& node) {
    if (!twice(declarations_.workspaces, node.name, "workspace"))
      declarations_.workspaces.add(
          node.name.text, {.what = {&tree_, &node, &declarations_}, .declared = node.name.span, .exported = false});
  }

 private:
  /// `mass * length / time^2`: names of dimensions, multiplied, divided and raised to whole powers.
  std::optional<Dimension> dimension_of(ExprId expr) {
    const Expr& node = tree_.expr(expr);
    // In `1 / time` the parser reads `/ time` as the unit of the number.
    if (const auto* number = std::get_if<NumberLiteral>(&node); number && number->value == 1) return suffix_of(*number);
    if (const auto* use = std::get_if<NameUse>(&node)) {
      if (const auto* found = declarations_.dimensions.find(use->name)) return *found;
      unknown_dimension({use->name, tree_.span(expr)});
      return std::nullopt;
    }
    if (const auto* binary = std::get_if<Binary>(&node)) {
      const auto left = dimension_of(binary->left);
      if (!left) return std::nullopt;
      if (binary->op == BinaryOperator::power) {
        const auto* exponent = std::get_if<NumberLiteral>(&tree_.expr(binary->right));
        if (exponent && std::abs(exponent->value) <= 32 && exponent->value == std::floor(exponent->value)) {
          // In `length^3 / time` the parser reads `/ time` as the unit of the 3.
          const auto raised = power(*left, static_cast<int>(exponent->value));
          const auto rest = suffix_of(*exponent);
          if (!rest) return std::nullopt;
          if (raised) return *raised * *rest;
        }
      } else if (binary->op == BinaryOperator::multiply || binary->op == BinaryOperator::divide) {
        const auto right = dimension_of(binary->right);
        if (!right) return std::nullopt;
        return binary->op == BinaryOperator::multiply ? *left * *right : *left / *right;
      }
    }
    report(Code::wrong_type, tree_.span(expr), "a dimension must be a product of dimensions",
           "write, for example, `dimension force = mass * length / time^2`");
    return std::nullopt;
  }

  std::optional<Dimension> suffix_of(const NumberLiteral& number) {
    Dimension dimension;
    for (const auto& part : tree_.suffix(number)) {
      const auto* found = declarations_.dimensions.find(part.name.text);
      const auto raised =
          found ? power(*found, part.divides ? -part.exponent : part.exponent) : std::optional<Dimension>();
      if (!raised) {
        unknown_dimension(part.name);
        return std::nullopt;
      }
      dimension = dimension * *raised;
    }
    return dimension;
  }

  void unknown_dimension(const Word& word) {
    if (const auto hidden = declarations_.private_names.find(word.text); hidden != declarations_.private_names.end())
      return report(Code::private_name, word.span,
                    fmt::format("`{}` is private to {}", word.text, sources_[hidden->second.source].name),
                    fmt::format("write `export` before its declaration there (line {}), if others may use it",
                                sources_.place(hidden->second).line));
    if (diagnostics_.is_full()) return;
    report(Code::unknown_name, word.span, fmt::format("nothing declares a dimension `{}`", word.text),
           did_you_mean(word.span, word.text, declarations_.dimensions.spellings(),
                        fmt::format("declare it, as in `dimension {} = …`", word.text)));
  }

  std::string whereabouts(Span declared) const {
    return declared.source == tree_.source ? fmt::format("on line {}", sources_.place(declared).line)
                                           : fmt::format("in {}", sources_[declared.source].name);
  }

  /// Whether the name is taken, which is reported.
  template <typename T>
  bool twice(const Names<T>& names, const Word& word, const char* kind) {
    const auto* other = names.entry(word.text);
    if (!other) return false;
    report(Code::declared_twice, word.span,
           fmt::format("a {} `{}` is declared already, {}", kind, word.text, whereabouts(other->declared)),
           Advice("give one of them another name").see(other->declared, "declared here first"));
    return true;
  }

  template <typename T, typename Node>
  void enter(Names<T>& names, const Node& node, T what) {
    names.add(node.name.text, {.what = std::move(what), .declared = node.name.span, .exported = node.exported});
  }

  void report(Code code, Span span, std::string message, Advice advice) {
    diagnostics_.report(std::move(advice).about(code, span, std::move(message)));
  }

  const SyntaxTree& tree_;
  const SourceSet& sources_;
  Declarations& declarations_;
  Diagnostics& diagnostics_;
};

/// Enters one kind of names from an imported file.
template <typename T>
void import_kind(const Names<T>& from, const Import& import, Names<T>& into, const char* kind,
                 std::map<std::string, Span, std::less<>>& hidden, const SourceSet& sources, Diagnostics& diagnostics) {
  for (const auto& [name, entry] : from.own()) {
    if (entry.imported) continue;
    if (!entry.exported) {
      hidden.emplace(name, entry.declared);
      continue;
    }
    if (const auto* other = into.entry(name)) {
      if (other->declared == entry.declared) continue;
      diagnostics.report(Advice("import only one of the two, or rename it in one of the files")
                             .see(other->declared, "declared here first")
                             .see(entry.declared, "and here")
                             .about(Code::declared_twice, import.module.span,
                                    fmt::format("`{}` exports a {} `{}`, but {} has exported one already",
                                                import.module.text, kind, name, sources[other->declared.source].name)));
      continue;
    }
    auto copy = entry;
    copy.imported = true;
    into.add(name, std::move(copy));
  }
}

/// Enters maps, thresholds, rules or levels. Their names cannot clash, since they are not passed on from file to file.
template <typename T>
void import_unnamed(const std::vector<T>& from, std::vector<T>& into) {
  for (const auto& each : from)
    if (each.exported) into.push_back(each), into.back().exported = false;
}

}  // namespace

void import_names(const Declarations& from, const Import& import, Declarations& into, const SourceSet& sources,
                  Diagnostics& diagnostics) {
  import_kind(from.dimensions, import, into.dimensions, "dimension", into.private_names, sources, diagnostics);
  import_kind(from.dimension_bounds, import, into.dimension_bounds, "dimension", into.private_names, sources,
              diagnostics);
  import_kind(from.units, import, into.units, "unit", into.private_names, sources, diagnostics);
  import_kind(from.constants, import, into.constants, "constant", into.private_names, sources, diagnostics);
  import_kind(from.functions, import, into.functions, "function", into.private_names, sources, diagnostics);
  import_kind(from.percepts, import, into.percepts, "percept", into.private_names, sources, diagnostics);
  import_kind(from.classes, import, into.classes, "class of devices", into.private_names, sources, diagnostics);
  import_kind(from.devices, import, into.devices, "device", into.private_names, sources, diagnostics);
  import_kind(from.hands, import, into.hands, "hand", into.private_names, sources, diagnostics);
  import_kind(from.materials, import, into.materials, "material", into.private_names, sources, diagnostics);
  import_unnamed(from.own_maps, into.own_maps);
  import_unnamed(from.own_thresholds, into.own_thresholds);
  import_unnamed(from.own_rules, into.own_rules);
  import_unnamed(from.own_levels, into.own_levels);
}

void declare(const SyntaxTree& tree, const SourceSet& sources, Declarations& declarations, Diagnostics& diagnostics) {
  Declarer declarer(tree, sources, declarations, diagnostics);
  // Records may use units, percepts and functions that are declared further down in the file.
  for (const auto& declaration : tree.declarations)
    if (!std::holds_alternative<RecordDecl>(declaration)) std::visit(declarer, declaration);
  for (const char* keyword : {"percept", "map", "threshold", "rule", "class", "device", "levels", "hand"})
    for (const auto& declaration : tree.declarations)
      if (const auto* record = std::get_if<RecordDecl>(&declaration); record && record->keyword.text == keyword)
        declarer(*record);
}

}  // namespace wale
