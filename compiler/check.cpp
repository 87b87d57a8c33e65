#include "compiler/check.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "compiler/check_expression.hpp"
#include "compiler/spelling.hpp"

namespace wale {

namespace {

/// Checks one material, statement by statement in the order of the text.
class MaterialChecker {
 public:
  /// `whole`: the file has been read and declared without errors, so that nothing of the material is missing.
  MaterialChecker(const SyntaxTree& tree, const MaterialDecl& declaration, Surroundings surroundings, bool whole)
      : tree_(tree),
        declaration_(declaration),
        surroundings_(surroundings),
        checker_(surroundings, material_.terms, material_.tables),
        whole_(whole),
        errors_before_(surroundings.diagnostics.error_count()) {
    scope_.hand = true;
  }

  CheckedMaterial check() {
    material_.name = declaration_.name.text;
    material_.span = declaration_.name.span;
    if (declaration_.derived_from)
      not_built(tree_.span(*declaration_.derived_from), "materials made from other materials (`= …`)",
                "write out the physical block");
    check_representative();
    for (const auto& percept : declaration_.perceptual) check_percept(percept);
    for (const auto& statement : declaration_.physical) {
      statement_span_ = statement.span;
      std::visit(*this, statement.what);
    }
    // What stands in an expression that could not be read or checked may be the use that is missed.
    if (whole_ && surroundings_.diagnostics.error_count() == errors_before_) warn_of_unused_names();
    const auto& sources = surroundings_.sources;
    if (declaration_.perceptual_span) material_.layers.perceptual = sources.text(*declaration_.perceptual_span);
    if (declaration_.physical_span) material_.layers.physical = sources.text(*declaration_.physical_span);
    material_.carriers = checker_.carriers();
    material_.open_spans = checker_.open_spans();
    find_relief();
    return std::move(material_);
  }

  void operator()(const ParamStatement& node) {
    const Value value = checker_.check(tree_, node.value, scope_);
    if (value.failed() || lacks_its_unit(node, value)) return declare_failed(node.name);
    if (value.type != Value::Type::number) {
      report(Code::wrong_type, value.span, fmt::format("a parameter is a number, not {}", type_words(value.type)),
             "use one `param` for each part");
      return declare_failed(node.name);
    }
    const auto number = checker_.constant(tree_, node.value, scope_, value.dimension);
    if (!number) return declare_failed(node.name);
    Parameter parameter{.name = node.name.text,
                        .description = node.description.empty() ? node.documentation : node.description};
    parameter.value = static_cast<float>(*number);
    double low = *number, high = *number;
    if (node.range) {
      const auto from = checker_.constant(tree_, node.range->low, scope_, value.dimension);
      const auto to = checker_.constant(tree_, node.range->high, scope_, value.dimension);
      if (!from || !to) return declare_failed(node.name);
      low = *from, high = *to;
      if (low > high)
        report(Code::value_out_of_range, tree_.span(node.range->low), "the range runs from high to low",
               "exchange its ends");
      else if (!(*number >= low && *number <= high))
        report(Code::value_out_of_range, tree_.span(node.value),
               fmt::format("the default of `{}` lies outside its range", node.name.text),
               "widen the range or change the default");
    }
    parameter.low = static_cast<float>(low);
    parameter.high = static_cast<float>(high);
    std::tie(parameter.unit, parameter.unit_in_si) = written_unit(node, value.dimension);
    parameter.si_unit = surroundings_.declarations.names.unit(value.dimension);
    const auto index = static_cast<std::uint32_t>(material_.parameters.size());
    declare(node.name, {.type = Value::Type::number,
                        .x = material_.terms.parameter(index, node.name.span),
                        .dimension = value.dimension,
                        .span = node.name.span});
    for (const auto& other : material_.parameters)
      if (other.name == parameter.name) return;  // reported as declared twice
    material_.parameters.push_back(std::move(parameter));
  }

  void operator()(const LetStatement& node) { declare(node.name, checker_.check(tree_, node.value, scope_)); }

  void operator()(const HeightStatement& node) {
    Value value = checker_.check(tree_, node.value, scope_);
    if (value.failed()) return declare_failed(node.name);
    if (value.type != Value::Type::number) {
      report(Code::wrong_type, value.span,
             fmt::format("a height is a number at each place, not {}", type_words(value.type)),
             "give it by `x` and `y`, as in `grating(x, period: 2.5 mm)`");
      return declare_failed(node.name);
    }
    if (!value.dimension.plain() && value.dimension != surroundings_.declarations.dimension("length")) {
      const auto sides = surroundings_.declarations.names.side_by_side(surroundings_.declarations.dimension("length"),
                                                                       value.dimension);
      surroundings_.diagnostics.report(
          {.code = Code::wrong_dimension,
           .span = value.span,
           .message = fmt::format("a height is a length or a plain number, found {}",
                                  surroundings_.declarations.names.words(value.dimension)),
           .label = surroundings_.declarations.names.unit(value.dimension),
           .expected = sides[0],
           .found = sides[1],
           .help = fmt::format("only its shape matters to `lateral`: make it plain, as in `/ 1 {}`",
                               customary_unit(surroundings_.declarations, value.dimension))});
      return declare_failed(node.name);
    }
    if (material_.terms.dependence(value.x).velocity) {
      report(Code::wrong_rate, value.span, "a height is a matter of place, and this changes with velocity",
             "use `x` and `y` only; add velocity to the force");
      return declare_failed(node.name);
    }
    last_height_ = value.x;
    declare(node.name, value);
  }

  void operator()(const ForceStatement& node) {
    if (force_seen_)
      report(Code::declared_twice, statement_span_, "a material has one force", "add the terms up in one `force = …`");
    force_seen_ = true;
    material_.force_span = tree_.span(node.value);
    const Value value = checker_.check_as(tree_, node.value, scope_, Value::Type::vector,
                                          surroundings_.declarations.dimension("force"));
    if (!value.failed()) material_.force = {value.x, value.y};
  }

  void operator()(const PatchStatement& node) {
    if (node.sizes.size() != 2)
      return report(Code::wrong_type, statement_span_, "a patch has a width and a height",
                    "write, for example, `patch 95 mm, 95 mm`");
    std::array<double, 2> sizes{};
    for (int side = 0; side < 2; ++side) {
      const auto size =
          checker_.constant(tree_, node.sizes[side], scope_, surroundings_.declarations.dimension("length"));
      if (!size) return;
      if (!(*size > 0))
        return report(Code::value_out_of_range, tree_.span(node.sizes[side]), "a patch must be larger than nothing",
                      "write, for example, `patch 95 mm, 95 mm`");
      sizes[side] = *size;
    }
    if (material_.patch)
      return report(Code::declared_twice, statement_span_, "a material has one patch", "keep one of them");
    material_.patch = sizes;
    material_.patch_span = statement_span_;
  }

  void operator()(const StateStatement& node) {
    not_built(statement_span_, "`state`", "forces may depend on place, velocity and parameters");
    declare_failed(node.name);
  }
  void operator()(const UpdateStatement&) {
    not_built(statement_span_, "updates of a state", "forces may depend on place, velocity and parameters");
  }
  void operator()(const ShowStatement&) {
    not_built(statement_span_, "`show`", "a preview shows the material's heights");
  }

 private:
  void check_representative() {
    for (const auto& setting : declaration_.representative) {
      const auto& key = setting.key.text;
      if (key == "like") {
        not_built(setting.span, "`like`", "write out the physical block");
        continue;
      }
      if (key != "title" && key != "called" && key != "kind") {
        const auto near = nearest_spelling(key, {"title", "called", "kind", "like"});
        report(Code::unknown_setting, setting.key.span, fmt::format("a representative block has no setting `{}`", key),
               near ? fmt::format("did you mean `{}`?", *near) : "it has: title, called, kind");
        continue;
      }
      std::vector<std::string> texts;
      for (const auto& item : setting.items) {
        const auto* literal = item.value ? std::get_if<TextLiteral>(&tree_.expr(*item.value)) : nullptr;
        if (key == "kind" && item.words.size() == 1 && !item.value)
          texts.push_back(item.words[0].text);
        else if (key != "kind" && literal)
          texts.push_back(literal->text);
        else
          report(Code::wrong_type, item.span,
                 fmt::format("`{}` takes {}", key, key == "kind" ? "a word" : "texts in quotes"),
                 key == "kind" ? "write, for example, `kind fabric.woven`" : fmt::format("write `{} \"…\"`", key));
      }
      for (const auto& [other, values] : material_.layers.representative)
        if (other == key)
          report(Code::declared_twice, setting.key.span, fmt::format("`{}` is set twice", key), "put all into one");
      material_.layers.representative.emplace_back(key, std::move(texts));
    }
  }

  void check_percept(const PerceptStatement& node) {
    const auto& declarations = surroundings_.declarations;
    if (!declarations.percepts.contains(node.name.text)) {
      std::vector<std::string> candidates;
      for (const auto& [name, percept] : declarations.percepts) candidates.push_back(name);
      const auto near = nearest_spelling(node.name.text, candidates);
      return report(Code::unknown_name, node.name.span, fmt::format("nothing declares a percept `{}`", node.name.text),
                    near ? fmt::format("did you mean `{}`?", *near)
                         : fmt::format("known: {}", candidates.empty() ? "none" : candidates.front()));
    }
    if (node.tolerance) not_built(tree_.span(*node.tolerance), "a percept's tolerance", "give the level alone");
    for (const auto& other : material_.percepts)
      if (other.name == node.name.text)
        return report(Code::declared_twice, node.name.span, fmt::format("`{}` is asked for twice", node.name.text),
                      "keep one of them");
    double level = 0;
    Span span = node.span;
    if (node.level_name) {
      span = node.level_name->span;
      const auto named = named_level(node.name.text, *node.level_name);
      if (!named) return;
      level = *named;
    } else if (node.value) {
      span = tree_.span(*node.value);
      Scope constants;
      const auto known = checker_.constant(tree_, *node.value, constants, Dimension{});
      if (!known) return;
      level = *known;
    } else {
      return;  // reported by the parser
    }
    if (!(level >= 0 && level <= 1))
      return report(Code::level_out_of_range, span, fmt::format("a level of {:.4g} is outside 0 .. 1", level),
                    level > 1 && level <= 100
                        ? fmt::format("1 is the reference stimulus of `{}`; {:.4g} % is written `{:.4g}`",
                                      node.name.text, level, level / 100)
                        : fmt::format("0 is none of it, 1 is the reference stimulus of `{}`", node.name.text));
    material_.percepts.push_back({node.name.text, level, span});
  }

  std::optional<double> named_level(const std::string& percept, const Word& word) {
    std::vector<std::string> candidates;
    for (const auto& levels : surroundings_.declarations.levels) {
      if (levels.percept != percept) continue;
      for (const auto& level : levels.levels) {
        if (level.name == word.text) return level.value;
        candidates.push_back(level.name);
      }
    }
    const auto near = nearest_spelling(word.text, candidates);
    std::string known;
    for (const auto& candidate : candidates) known += (known.empty() ? "" : ", ") + candidate;
    report(Code::unknown_name, word.span, fmt::format("no level of {} is called `{}`", percept, word.text),
           near ? fmt::format("did you mean `{}`?", *near)
                : fmt::format("there are: {}; or give a number from 0 to 1", known.empty() ? "none" : known));
    return std::nullopt;
  }

  /// A default without a unit in a range that has one is one mistake, and not two of the range's.
  bool lacks_its_unit(const ParamStatement& node, const Value& value) {
    if (!node.range || value.type != Value::Type::number || !value.dimension.plain()) return false;
    const Value low = checker_.check(tree_, node.range->low, scope_);
    if (low.failed()) return true;
    if (low.type != Value::Type::number || low.dimension.plain()) return false;
    const auto& names = surroundings_.declarations.names;
    const std::string unit = written_unit(node, low.dimension).first;
    const auto sides = names.side_by_side(low.dimension, value.dimension);
    const std::string text(surroundings_.sources.text(value.span));
    surroundings_.diagnostics.report({.code = Code::wrong_dimension,
                                      .span = value.span,
                                      .message = fmt::format("`{}` is {}, and its default has no unit", node.name.text,
                                                             with_article(names.words(low.dimension))),
                                      .expected = sides[0],
                                      .found = sides[1],
                                      .help = fmt::format("write `{} {}`", text, unit)});
    return true;
  }

  /// The unit that the author wrote for a parameter, and its size in SI.
  std::pair<std::string, double> written_unit(const ParamStatement& node, const Dimension& dimension) {
    std::vector<ExprId> written{node.value};
    if (node.range) written.insert(written.end(), {node.range->low, node.range->high});
    for (ExprId expr : written) {
      while (const auto* unary = std::get_if<Unary>(&tree_.expr(expr))) expr = unary->operand;
      const auto* literal = std::get_if<NumberLiteral>(&tree_.expr(expr));
      if (!literal || literal->suffix.empty()) continue;
      double factor = 1;
      std::string text;
      bool known = true;
      for (const auto& part : literal->suffix) {
        const auto found = surroundings_.declarations.units.find(part.name.text);
        if (found == surroundings_.declarations.units.end()) {
          known = false;
          break;
        }
        factor *= std::pow(found->second.factor, part.divides ? -part.exponent : part.exponent);
        text += (text.empty() ? (part.divides ? "1/" : "") : part.divides ? "/" : " ") + part.name.text;
        if (part.exponent != 1) text += fmt::format("^{}", part.exponent);
      }
      if (known) return {text, factor};
    }
    return {surroundings_.declarations.names.unit(dimension), 1.0};
  }

  void declare(const Word& name, Value value) {
    if (names_hand_or_patch(name.text) || name.text == "open")
      return report(Code::declared_twice, name.span,
                    fmt::format("`{}` already means the hand's or the patch's own", name.text), "give it another name");
    if (const auto* other = scope_.find(name.text)) {
      const unsigned line = surroundings_.sources.place(other->declared).line;
      return report(Code::declared_twice, name.span,
                    fmt::format("`{}` is declared already, on line {}", name.text, line),
                    "give one of them another name");
    }
    scope_.names[name.text] = {.value = std::move(value), .declared = name.span};
  }

  /// Keeps a name whose value is in error, so that its uses are not errors too.
  void declare_failed(const Word& name) {
    declare(name, {});
    if (auto* binding = scope_.find(name.text)) binding->used = true;
  }

  void warn_of_unused_names() {
    std::vector<std::pair<std::string, Span>> unused;
    for (const auto& [name, binding] : scope_.names)
      if (!binding.used && !binding.value.failed()) unused.emplace_back(name, binding.declared);
    std::ranges::sort(unused, {}, [](const auto& entry) { return entry.second.begin; });
    for (const auto& [name, span] : unused) {
      const bool parameter =
          std::ranges::find(material_.parameters, name, &Parameter::name) != material_.parameters.end();
      report(Code::unused_name, span,
             parameter ? fmt::format("the parameter `{}` does nothing: no height and no force depends on it", name)
                       : fmt::format("nothing uses `{}`", name),
             "use it or leave it out");
    }
  }

  /// The surface as it looks: what the textures push by, or else the last height of the text.
  void find_relief() {
    for (const auto& carrier : material_.carriers) {
      if (!carrier.relief) continue;
      material_.relief = material_.relief ? material_.terms.apply(Operation::add, *material_.relief, *carrier.relief)
                                          : *carrier.relief;
    }
    if (!material_.relief) material_.relief = last_height_;
  }

  void not_built(Span span, const std::string& what, const std::string& help) {
    report(Code::not_built, span, fmt::format("this version of Wale does not have {} yet", what), help);
  }

  void report(Code code, Span span, std::string message, std::string help) {
    surroundings_.diagnostics.report(
        {.code = code, .span = span, .message = std::move(message), .help = std::move(help)});
  }

  const SyntaxTree& tree_;
  const MaterialDecl& declaration_;
  Surroundings surroundings_;
  CheckedMaterial material_;
  ExpressionChecker checker_;
  Scope scope_;
  Span statement_span_;
  std::optional<TermId> last_height_;
  bool force_seen_ = false;
  bool whole_;
  std::size_t errors_before_;
};

/// Constants are otherwise read only where they are used: an unused one must not hide an error.
void check_constants(const ModuleSet& modules, Surroundings surroundings) {
  for (const auto& [name, constant] : modules.declarations.constants) {
    if (constant.tree->source != modules.source) continue;
    Terms terms;
    std::vector<HeightTable> tables;
    ExpressionChecker checker(surroundings, terms, tables);
    Scope scope;
    checker.check(*constant.tree, constant.node->value, scope);
  }
}

}  // namespace

const CheckedMaterial* CheckedModule::material(const std::string& name) const {
  for (const auto& material : materials)
    if (name.empty() || material.name == name) return &material;
  return nullptr;
}

CheckedModule check(ModuleSet modules, const SourceSet& sources, Resolver& resolver, Diagnostics& diagnostics) {
  CheckedModule checked;
  const Surroundings surroundings{sources, modules.declarations, diagnostics, &resolver};
  const bool whole = !diagnostics.has_errors();
  check_constants(modules, surroundings);
  for (const auto& material : modules.declarations.materials) {
    if (material.tree->source != modules.source) continue;
    checked.materials.push_back(MaterialChecker(*material.tree, *material.node, surroundings, whole).check());
  }
  checked.trees = std::move(modules.trees);
  checked.declarations = std::move(modules.declarations);
  return checked;
}

}  // namespace wale
