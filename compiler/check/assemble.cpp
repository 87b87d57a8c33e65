#include "compiler/check/assemble.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <unordered_map>
#include <utility>

#include "compiler/check/ask.hpp"
#include "compiler/check/override_statements.hpp"
#include "compiler/diagnostics/fix.hpp"
#include "compiler/parse/made_from.hpp"
#include "compiler/text/readable.hpp"

namespace wale {

namespace {

/// The most statements and components of a material, including those from other materials; more do not fit into a patch
/// program.
constexpr std::size_t most_statements = 20'000;
constexpr std::size_t deepest_derivation = 64;
/// Of a component in a blend. No more is needed: 1 is the whole material, and whole materials push with some newtons on
/// devices that give 2 to 20 N. A larger weight is most likely a number of percent.
constexpr double largest_weight = 10;
/// The same as in a program: components that weigh less are absent.
constexpr double least_weight = 1e-6;

class Assembler {
 public:
  explicit Assembler(const Surroundings& surroundings) : surroundings_(surroundings) {}

  std::shared_ptr<const AssembledMaterial> assemble(const Declared<MaterialDecl>& declared) {
    const MaterialDecl& node = *declared.node;
    if (std::ranges::find(path_, &node) != path_.end()) {
      report(Code::recursive_material, node.name.span, fmt::format("`{}` is made from itself", node.name.text),
             "let one of the materials stand on its own");
      return nullptr;
    }
    if (const auto known = assembled_.find(&node); known != assembled_.end()) {
      const auto& material = known->second;  // null if it has errors, which have been reported
      if (!material) return nullptr;
      depth_ = std::max(depth_, material->depth);
      return path_.size() + material->depth > deepest_derivation ? too_deep(node) : material;
    }
    if (path_.size() >= deepest_derivation) return too_deep(node);
    path_.push_back(&node);
    const std::size_t depth_before = std::exchange(depth_, 0);
    std::shared_ptr<const AssembledMaterial> material = assemble_new(declared);
    depth_ = std::max(depth_before, depth_ + 1);
    path_.pop_back();
    return assembled_[&node] = std::move(material);
  }

 private:
  std::shared_ptr<const AssembledMaterial> assemble_new(const Declared<MaterialDecl>& declared) {
    const MaterialDecl& node = *declared.node;
    auto result = std::make_shared<AssembledMaterial>();
    bool good = true;
    if (node.derived_from) {
      const auto made = made_from(declared, *node.derived_from);
      if (made && !charge(made->statements.size() + made->components.size())) return nullptr;
      if (made) *result = *made;
      good = made != nullptr;
      result->derived = true;
    }
    for (const auto& setting : node.representative) {
      if (setting.key.text == "like") good = take_over(declared, setting, *result) && good;
      if (setting.key.text == "kind") result->kind = &setting, result->kind_tree = declared.tree;
    }
    if (!charge(node.perceptual.size() * (1 + node.perceptual.size() / 8)) ||
        !charge(node.physical.size() * (1 + result->statements.size())))
      return nullptr;
    for (const auto& percept : node.perceptual) ask(declared, percept, surroundings_, result->percepts);
    override_statements(declared, result->statements);
    result->depth = depth_ + 1;
    measure(*result);
    if (result->size > most_statements) {
      report(Code::program_too_large, node.name.span,
             fmt::format("with all that it is made from, `{}` has more than {} statements and components",
                         node.name.text, most_statements),
             Advice("make it from fewer materials").fact("limit", static_cast<double>(most_statements)));
      return nullptr;
    }
    return good ? result : nullptr;
  }

  std::shared_ptr<const AssembledMaterial> too_deep(const MaterialDecl& node) {
    report(Code::nested_too_deep, node.name.span,
           fmt::format("more than {} materials are made from one another", deepest_derivation),
           "make them from an earlier one");
    return nullptr;
  }

  /// Takes operations from the budget before they are done; false if it is spent, which has been reported.
  bool charge(std::size_t operations) {
    return surroundings_.diagnostics.charge(operations, path_.front()->name.span, Work::assembly);
  }
  // ---- what a material is made from -------------------------------------------------------------------------------

  /// `like denim`: takes everything from `denim` that the material does not state itself.
  bool take_over(const Declared<MaterialDecl>& declared, const Setting& setting, AssembledMaterial& result) {
    const auto liked = liked_by(setting, *declared.tree);
    if (!liked || result.derived) {
      report(liked ? Code::declared_twice : Code::wrong_type, setting.span,
             liked ? "a material is made from one other" : "`like` needs the name of one material",
             liked ? first_origin(*declared.node, setting) : "write, for example, `like denim`");
      return false;
    }
    const auto* other = find(*liked, *declared.home);
    const auto base = other ? assemble(*other) : nullptr;
    if (base) result = *base;
    result.derived = true;
    return base != nullptr;
  }

  /// Points at the first origin of a material that `again` gives a second one.
  static Advice first_origin(const MaterialDecl& node, const Setting& again) {
    Advice advice = "keep either `like` or the `=` behind the name; for a mixture write `= 0.5 a + 0.5 b`";
    for (const auto& setting : node.representative)
      if (!node.derived_from && setting.key.text == "like" && &setting != &again)
        return std::move(advice).see(setting.span, "the first one");
    return advice;
  }

  std::shared_ptr<const AssembledMaterial> made_from(const Declared<MaterialDecl>& from, ExprId expr) {
    const Expr& node = from.tree->expr(expr);
    const auto named = [&](std::string_view name) -> std::shared_ptr<const AssembledMaterial> {
      const auto* other = find({name, from.tree->span(expr)}, *from.home);
      return other ? assemble(*other) : nullptr;
    };
    if (const auto* use = std::get_if<NameUse>(&node)) return named(use->name);
    if (const auto* text = std::get_if<TextLiteral>(&node)) return named(text->text);
    if (const auto* call = std::get_if<Call>(&node))
      return call->callee.text == "between" && !call->quoted ? between(from, expr, *call) : instance(from, *call);
    if (std::holds_alternative<Erroneous>(node)) return nullptr;
    return blend(from, expr);
  }

  /// The material of that name that the file declares or imports, or that the library has; null if there is none.
  static const Declared<MaterialDecl>* known(const Word& word, const Declarations& home) {
    if (const auto* found = home.materials.find(word.text)) return found;
    const auto found = home.library_materials.find(word.span.begin);
    return found == home.library_materials.end() ? nullptr : found->second;
  }

  const Declared<MaterialDecl>* find(const Word& word, const Declarations& home) {
    if (const auto* found = known(word, home)) return found;
    if (home.library_materials.contains(word.span.begin)) return nullptr;  // already reported
    report(Code::unknown_name, word.span, fmt::format("no material is called `{}`", word.text),
           did_you_mean(word.span, word.text, home.materials.spellings(),
                        "declare it in this file, or `import` the file that does, as in `import fabric.denim`"));
    return nullptr;
  }

  /// `corduroy(wale: 1.2 mm)`: the same material with other defaults.
  std::shared_ptr<const AssembledMaterial> instance(const Declared<MaterialDecl>& from, const Call& call) {
    const auto* other = find(call.callee, *from.home);
    const auto base = other ? assemble(*other) : nullptr;
    if (!base || !charge(4 * base->work)) return nullptr;
    auto result = std::make_shared<AssembledMaterial>(*base);
    bool good = true;
    std::map<std::string_view, Span> given;
    for (const auto& argument : from.tree->arguments(call)) {
      const Span span = from.tree->span(argument.value);
      if (!charge(4 * base->work)) return nullptr;
      if (!argument.name) {
        report(Code::unknown_argument, span, fmt::format("the parameters of `{}` are given by name", call.callee.text),
               fmt::format("write, for example, `{}({})`", call.callee.text, example_of(*base)));
        good = false;
        continue;
      }
      const auto [first, is_new] = given.emplace(argument.name->text, argument.name->span);
      if (!is_new) {
        report(Code::declared_twice, argument.name->span, fmt::format("`{}` is given twice", argument.name->text),
               Advice("give it once").see(first->second, "given here first"));
        good = false;
        continue;
      }
      const Mixture value{.parts = {{1, from.tree, argument.value, from.home}}};
      if (set_default(*result, argument.name->text, value)) continue;
      if (const Dial dial = dial_named(*result, argument.name->text); dial != Dial::none) {
        const auto number = plain_constant(from, argument.value, surroundings_);
        if (number && (dial == Dial::weight ? good_weight(*number, span)
                                            : good_level(*number, span, "the component's reference stimulus")))
          turn(*result, argument.name->text, *number);
        continue;
      }
      const PerceptName meant = from.home->percept_named(argument.name->text);
      const auto percept = std::ranges::find(
          result->percepts, meant.percept ? meant.percept->name : argument.name->text, &AskedPercept::name);
      if (percept != result->percepts.end()) {  // `velvet(roughness: 0.1)`
        const auto* name = std::get_if<NameUse>(&from.tree->expr(argument.value));
        const bool is_named = name && !from.home->constants.contains(name->name);
        const auto level = is_named
                               ? named_level(*from.home, percept->name, {name->name, span}, surroundings_.diagnostics)
                               : plain_constant(from, argument.value, surroundings_);
        if (level) {
          good_level(*level, span, fmt::format("the reference stimulus of `{}`", percept->name));
          // A name means the same place on the scale for the percept and for its antonym.
          percept->level = meant.reversed && !is_named ? 1 - *level : *level;
          percept->span = span;
          percept->made_at.reset();
          percept->evidence.reset();
          percept->blended = false;
        }
        continue;
      }
      const auto known = arguments_of(*base);
      report(Code::unknown_argument, argument.name->span,
             fmt::format("`{}` has no parameter `{}`", call.callee.text, argument.name->text),
             did_you_mean(argument.name->span, argument.name->text, known,
                          known.empty() ? "it has none" : fmt::format("it has: {}", fmt::join(known, ", "))));
      good = false;
    }
    return good ? result : nullptr;
  }

  static std::string example_of(const AssembledMaterial& material) {
    const auto known = parameters_of(material);
    return known.empty() ? "" : known.front() + ": …";
  }

  bool good_weight(double weight, Span span) {
    if (weight >= least_weight && weight <= largest_weight) return true;
    if (weight > largest_weight)
      report(Code::value_out_of_range, span,
             readable("expected a weight of at most {}, found {:.6g}", largest_weight, weight),
             weight <= 100 ? typeable("1 is the material as it is; for a share write `{:.6g} %`", weight)
                           : "1 is the material as it is");
    else
      report(Code::value_out_of_range, span,
             weight > 0 ? readable("expected a weight of at least {:.6g}, found {:.6g}", least_weight, weight)
                        : "the weight of a component must be greater than zero",
             "leave out components that are not in the blend");
    return false;
  }

  bool good_level(double level, Span span, const std::string& one) {
    if (level >= 0 && level <= 1) return true;
    report(Code::level_out_of_range, span, readable("the level {:.4g} is outside 0 .. 1", level),
           fmt::format("0 is none of it, 1 is {}", one));
    return false;
  }

  // ---- mixtures ---------------------------------------------------------------------------------------------------

  /// `between(fine, wide, 0.3)`: one structure, with every parameter and every level between those of the two.
  std::shared_ptr<const AssembledMaterial> between(const Declared<MaterialDecl>& from, ExprId expr, const Call& call) {
    const Span span = from.tree->span(expr);
    const auto arguments = from.tree->arguments(call);
    if (arguments.size() != 3 || std::ranges::any_of(arguments, [](auto& each) { return bool(each.name); })) {
      report(Code::missing_argument, span, "`between` takes two materials and a position between them, from 0 to 1",
             "write, for example, `between(fine_corduroy, wide_corduroy, 0.3)`");
      return nullptr;
    }
    const auto first = made_from(from, arguments[0].value), second = made_from(from, arguments[1].value);
    const auto way = plain_constant(from, arguments[2].value, surroundings_);
    if (!first || !second || !way ||
        !charge(4 * (first->work + second->work) + first->percepts.size() * second->percepts.size()))
      return nullptr;
    if (!(*way >= 0 && *way <= 1)) {
      report(Code::value_out_of_range, from.tree->span(arguments[2].value),
             readable("the position {:.4g} is not between the two materials", *way), "give a number from 0 to 1");
      return nullptr;
    }
    if (!same_structure(*first, *second, span)) return nullptr;
    auto result = std::make_shared<AssembledMaterial>(*first);
    mix(*result, *second, *way, span);
    return result;
  }

  bool same_structure(const AssembledMaterial& a, const AssembledMaterial& b, Span span) {
    const auto differ = [&](const std::string& how, std::vector<SecondarySpan> where = {}) {
      Advice advice =
          "`between` needs two variants of one material, with different parameters; to mix materials, write "
          "`0.7 a + 0.3 b`";
      for (const auto& [place, label] : where) advice = std::move(advice).see(place, label);
      report(Code::different_structures, span, "these two materials have different structures: " + how,
             std::move(advice));
      return false;
    };
    if (a.components.size() != b.components.size()) return differ("their blends have different numbers of components");
    for (std::size_t i = 0; i < a.components.size(); ++i)
      if (!same_structure(*a.components[i].material, *b.components[i].material, span)) return false;
    if (a.statements.size() != b.statements.size())
      return differ(fmt::format("one has {} statements, the other has {}", a.statements.size(), b.statements.size()));
    for (std::size_t i = 0; i < a.statements.size(); ++i)
      if (a.statements[i].statement != b.statements[i].statement)
        return differ(fmt::format("`{}` in one, `{}` in the other",
                                  first_line(surroundings_.sources.text(a.statements[i].statement->span)),
                                  first_line(surroundings_.sources.text(b.statements[i].statement->span))),
                      {{a.statements[i].statement->span, "in one"}, {b.statements[i].statement->span, "in the other"}});
    for (const auto& percept : a.percepts)
      if (std::ranges::find(b.percepts, percept.name, &AskedPercept::name) == b.percepts.end())
        return differ(fmt::format("only one asks for {}", percept.name), {{percept.span, "asked for here"}});
    if (a.percepts.size() != b.percepts.size()) return differ("they ask for different percepts");
    return true;
  }

  static std::string first_line(std::string_view text) {
    constexpr std::size_t longest = 60;
    text = text.substr(0, text.find('\n'));
    return std::string(text.substr(0, longest)) + (text.size() > longest ? "…" : "");
  }

  /// `0.7 corduroy + 0.3 denim`: the forces and textures of both at once.
  std::shared_ptr<const AssembledMaterial> blend(const Declared<MaterialDecl>& from, ExprId expr) {
    auto result = std::make_shared<AssembledMaterial>();
    if (!add_components(from, expr, result->components)) return nullptr;
    name_weights(result->components);
    std::size_t asked_for = 0;
    for (const auto& component : result->components) {
      asked_for += component.material->percepts.size();
      if (!charge(component.material->percepts.size() * (1 + result->percepts.size()))) return nullptr;
      for (const auto& asked : component.material->percepts)
        if (std::ranges::find(result->percepts, asked.name, &AskedPercept::name) == result->percepts.end())
          result->percepts.push_back({.name = asked.name,
                                      .span = from.tree->span(expr),
                                      .by = asked.by,
                                      .by_span = asked.by_span,
                                      .essential = asked.essential,
                                      .blended = true});
    }
    if (!charge(asked_for * result->percepts.size())) return nullptr;
    measure(*result);
    blend_levels(*result);
    return result;
  }

  bool add_components(const Declared<MaterialDecl>& from, ExprId expr,
                      std::vector<AssembledMaterial::Component>& components) {
    const Expr& node = from.tree->expr(expr);
    if (const auto* binary = std::get_if<Binary>(&node); binary && binary->op == BinaryOperator::add) {
      const bool left = add_components(from, binary->left, components);
      return add_components(from, binary->right, components) && left;
    }
    const Span span = from.tree->span(expr);
    std::shared_ptr<const AssembledMaterial> material;
    std::string name;
    double weight = 1;
    if (const auto* number = std::get_if<NumberLiteral>(&node)) {  // 0.3 denim
      const auto suffix = from.tree->suffix(*number);
      double scale = 1;
      std::size_t next = 0;
      for (; next + 1 < suffix.size(); ++next) {  // 30 % denim
        const Unit* unit = from.home->units.find(suffix[next].name.text);
        if (!unit || !unit->dimension.plain()) break;
        scale *= unit->factor;
      }
      if (next + 1 != suffix.size() || suffix[next].divides || suffix[next].exponent != 1) return no_component(span);
      weight = number->value * scale;
      const auto* other = find(suffix[next].name, *from.home);
      name = other ? other->node->name.text : suffix[next].name.text;
      material = other ? assemble(*other) : nullptr;
    } else if (const auto* unary = std::get_if<Unary>(&node);
               unary && unary->op == UnaryOperator::negate &&
               std::holds_alternative<NumberLiteral>(from.tree->expr(unary->operand))) {  // -1 denim
      return good_weight(-std::get<NumberLiteral>(from.tree->expr(unary->operand)).value, span);
    } else if (const auto* product = std::get_if<Binary>(&node);
               product && product->op == BinaryOperator::multiply) {  // 0.3 * denim(weave: 1 mm)
      if (std::holds_alternative<NumberLiteral>(from.tree->expr(product->right)))
        return weight_behind(from, *product, span);
      if (const auto* left = std::get_if<NameUse>(&from.tree->expr(product->left));
          left && !from.home->constants.contains(left->name))
        return weight_is_name(from, *product);
      const auto factor = plain_constant(from, product->left, surroundings_);
      if (!factor) return false;
      weight = *factor;
      name = name_of(from, product->right);
      material = made_from(from, product->right);
    } else if (std::holds_alternative<NameUse>(node) || std::holds_alternative<TextLiteral>(node) ||
               std::holds_alternative<Call>(node)) {
      name = name_of(from, expr);
      material = made_from(from, expr);
    } else {
      return no_component(span);
    }
    if (!material) return false;
    if (!good_weight(weight, span)) return false;
    components.push_back({.weight = weight, .name = name, .span = span, .material = material});
    return true;
  }

  static std::string name_of(const Declared<MaterialDecl>& from, ExprId expr) {
    const Expr& node = from.tree->expr(expr);
    Word word{"part", from.tree->span(expr)};
    if (const auto* use = std::get_if<NameUse>(&node)) word.text = use->name;
    if (const auto* text = std::get_if<TextLiteral>(&node)) word.text = text->text;
    if (const auto* call = std::get_if<Call>(&node)) word = call->callee;
    const auto* material = known(word, *from.home);  // by its own name, not by a title
    return std::string(material ? material->node->name.text : word.text);
  }

  /// `brick * 0.5`.
  bool weight_behind(const Declared<MaterialDecl>& from, const Binary& product, Span span) {
    const std::string_view left = surroundings_.sources.text(from.tree->span(product.left));
    const std::string_view right = surroundings_.sources.text(from.tree->span(product.right));
    const std::string mended = fmt::format("{} * {}", right, left);
    report(Code::wrong_type, span, "the weight of a component stands before it",
           Advice(fmt::format("write `{}`", mended)).fix(replace(span, mended)));
    return false;
  }

  /// `brick * oak`.
  bool weight_is_name(const Declared<MaterialDecl>& from, const Binary& product) {
    const Span span = from.tree->span(product.left);
    const std::string_view left = surroundings_.sources.text(span);
    const std::string_view right = surroundings_.sources.text(from.tree->span(product.right));
    report(Code::wrong_type, span, fmt::format("expected a weight, found `{}`", left),
           fmt::format("to mix materials, write `0.5 {} + 0.5 {}`", left, right));
    return false;
  }

  bool no_component(Span span) {
    report(Code::wrong_type, span, "this is neither a material nor a mixture of materials",
           "write `corduroy(wale: 1 mm)`, `0.7 corduroy + 0.3 denim` or `between(a, b, 0.5)`");
    return false;
  }

  void report(Code code, Span span, std::string message, Advice advice) {
    surroundings_.diagnostics.report(std::move(advice).about(code, span, std::move(message)));
  }

  const Surroundings& surroundings_;
  std::vector<const MaterialDecl*> path_;
  std::size_t depth_ = 0;  ///< of the materials from which the current one is made, so far
  /// Each material is assembled once, however often others are made from it.
  std::unordered_map<const MaterialDecl*, std::shared_ptr<const AssembledMaterial>> assembled_;
};

}  // namespace

std::shared_ptr<const AssembledMaterial> assemble(const Declared<MaterialDecl>& material,
                                                  const Surroundings& surroundings) {
  return Assembler(surroundings).assemble(material);
}

}  // namespace wale
