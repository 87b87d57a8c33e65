#include "compiler/check/ask.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "compiler/expression/check_name.hpp"
#include "compiler/modules/declare_evidence.hpp"
#include "compiler/text/readable.hpp"

namespace wale {

namespace {

/// A level above this was meant in percent; one between 1 and this was meant to be stronger than the reference
/// stimulus.
constexpr double most_meant_as_level = 5;

/// The fix for a level such as `60`, which was meant in percent.
std::vector<Fix> as_percentage(const Declared<MaterialDecl>& declared, const PerceptStatement& node, double level) {
  if (!node.value || !(level > most_meant_as_level && level <= 100)) return {};
  const auto* literal = std::get_if<NumberLiteral>(&declared.tree->expr(*node.value));
  if (!literal || literal->suffix.count > 0) return {};
  return {replace(declared.tree->span(*node.value), typeable("{:.4g}", level / 100), {}, false)};
}

/// What stands before the size in a call of a percept's function: "height, amplitude: ", or nothing if it comes first.
std::string before_carrier(const Declarations& declarations, const std::string& function, const std::string& argument) {
  const auto* declared = declarations.functions.find(function);
  std::string before;
  if (!declared) return before;
  for (const FormalParameter& each : declared->node->parameters) {
    if (each.name.text == argument) return before.empty() ? before : fmt::format("{}{}: ", before, argument);
    if (!each.default_value) before += fmt::format("{}, ", each.name.text);
  }
  return {};
}

/// The value of a level or a tolerance, a constant without a unit. Of `0.6 mm` the number was meant.
std::optional<double> plain_level(const Declared<MaterialDecl>& declared, ExprId expr, const Surroundings& surroundings,
                                  const char* what, const Percept& percept) {
  const auto* literal = std::get_if<NumberLiteral>(&declared.tree->expr(expr));
  if (literal == nullptr || literal->suffix.count == 0) return plain_constant(declared, expr, surroundings);
  Diagnostics found;
  const auto value = plain_constant(declared, expr, {surroundings.sources, surroundings.declarations, found});
  for (Diagnostic diagnostic : found.all()) {
    if (diagnostic.code == Code::wrong_dimension) {
      const std::string number = fmt::format("{}", literal->value);
      const std::string_view text = surroundings.sources.text(declared.tree->span(expr));
      const std::string function = percept.carrier.substr(0, percept.carrier.find(' '));
      const bool is_size = !percept.carrier.empty() && std::ranges::any_of(diagnostic.facts, [&](const Fact& fact) {
        const auto* words = std::get_if<std::string>(&fact.value);
        return fact.name == "found" && words && *words == declared.home->names().words(percept.carrier_dimension);
      });
      if (is_size) {
        diagnostic.help =
            fmt::format("levels go from 0 to 1; for {} write `{}({}{})` in a physical block", text, function,
                        before_carrier(surroundings.declarations, function, percept.argument()), text);
        surroundings.diagnostics.report(std::move(diagnostic));
        continue;
      }
      diagnostic.help = fmt::format("{} has no unit: write `{}`", what, number);
      diagnostic.fixes = {replace(declared.tree->span(expr), number, {}, false)};
    }
    surroundings.diagnostics.report(std::move(diagnostic));
  }
  return value;
}

/// The names of the percepts and antonyms that people describe with that word: `hardness` of "hard".
std::vector<std::string> percepts_called(const Declarations& declarations, std::string_view word) {
  std::vector<std::string> names;
  declarations.percepts.each([&](const std::string& name, const Percept& percept) {
    if (std::ranges::find(percept.words, word) != percept.words.end()) names.push_back(name);
    if (std::ranges::find(percept.antonym_words, word) != percept.antonym_words.end() && !percept.antonym.empty())
      names.push_back(percept.antonym);
  });
  return names;
}

/// What to write where a word stands alone among percepts: a percept lacks its level, a level its percept.
std::string instead_of_bare(const Declarations& declarations, const PerceptName& meant, std::string_view word) {
  if (meant.percept) {
    std::vector<std::string> own;
    for (const auto* levels : declarations.levels())
      if (levels->percept == meant.percept->name)
        for (const auto& level : levels->levels) own.push_back(fmt::format("`{} {}`", word, level.name));
    return own.empty() ? fmt::format("write a level from 0 to 1 behind it, as in `{} 0.5`", word)
                       : fmt::format("write a level from 0 to 1 behind it, as in `{} 0.5`, or one by name: {}", word,
                                     fmt::join(own, ", "));
  }
  std::vector<std::string> whole;
  for (const auto* levels : declarations.levels())
    for (const auto& level : levels->levels)
      if (level.name == word) whole.push_back(fmt::format("`{} {}`", levels->percept, word));
  if (!whole.empty())
    return fmt::format("a level stands behind its percept: write {}", fmt::join(whole, " or "));
  for (const std::string& name : percepts_called(declarations, word)) whole.push_back(fmt::format("`{} 0.5`", name));
  if (!whole.empty()) return fmt::format("write a percept and its level, as in {}", fmt::join(whole, " or "));
  return "write a percept and its level, as in `roughness 0.5`";
}

}  // namespace

std::optional<double> named_level(const Declarations& declarations, const std::string& percept, const Word& word,
                                  Diagnostics& diagnostics) {
  std::vector<std::string> candidates;
  for (const auto* levels : declarations.levels()) {
    if (levels->percept != percept) continue;
    for (const auto& level : levels->levels) {
      if (level.name == word.text) return level.value;
      candidates.push_back(level.name);
    }
  }
  Advice advice =
      did_you_mean(word.span, word.text, candidates,
                   fmt::format("there are: {}; or give a number from 0 to 1",
                               candidates.empty() ? "none" : fmt::format("{}", fmt::join(candidates, ", "))));
  diagnostics.report(std::move(advice).about(Code::unknown_name, word.span,
                                             fmt::format("no level of {} is called `{}`", percept, word.text)));
  return std::nullopt;
}

std::optional<double> plain_constant(const Declared<MaterialDecl>& declared, ExprId expr,
                                     const Surroundings& surroundings) {
  Terms terms;
  std::vector<HeightTable> tables;
  ExpressionChecker checker({surroundings.sources, *declared.home, surroundings.diagnostics}, terms, tables);
  Scope scope;
  return checker.constant(*declared.tree, expr, scope, Dimension{});
}

void ask(const Declared<MaterialDecl>& declared, const PerceptStatement& node, const Surroundings& surroundings,
         std::vector<AskedPercept>& percepts) {
  const auto report = [&](Code code, Span span, std::string message, Advice advice) {
    surroundings.diagnostics.report(std::move(advice).about(code, span, std::move(message)));
  };
  const auto& declarations = *declared.home;
  const PerceptName meant = declarations.percept_named(node.name.text);
  if (node.level_name && node.level_name->text.empty())
    return surroundings.diagnostics.propose(Code::unexpected_token, node.level_name->span,
                                            instead_of_bare(declarations, meant, node.name.text));
  if (!meant.percept) {
    const auto known = declarations.percept_spellings();
    const std::string message = fmt::format("nothing declares a percept `{}`", node.name.text);
    if (auto imported = import_mend(surroundings, node.name.text, {"percept"}))
      return report(Code::unknown_name, node.name.span, message, *std::move(imported));
    if (const auto named = percepts_called(declarations, node.name.text); !named.empty())
      return report(Code::unknown_name, node.name.span, message,
                    Advice(fmt::format("did you mean `{}`?", fmt::join(named, "` or `")))
                        .fix(replace(node.name.span, named.front(), {}, false))
                        .fact("meant", named.front()));
    return report(
        Code::unknown_name, node.name.span, message,
        did_you_mean(node.name.span, node.name.text, known,
                     fmt::format("known: {}", known.empty() ? "none" : fmt::format("{}", fmt::join(known, ", ")))));
  }
  for (const auto& other : declared.node->perceptual) {
    if (&other == &node) break;
    if (declarations.percept_named(other.name.text).percept == meant.percept)
      return report(Code::declared_twice, node.name.span,
                    other.name.text == node.name.text
                        ? fmt::format("`{}` is asked for twice", node.name.text)
                        : fmt::format("`{}` is `{}` from the other end, which is asked for already", node.name.text,
                                      other.name.text),
                    Advice("keep one of them").see(other.name.span, "asked for here first"));
  }
  AskedPercept asked{.name = meant.percept->name, .span = node.span, .essential = node.essential};
  if (node.by) {
    asked.by = node.by->text;
    asked.by_span = node.by->span;
    bool is_known = false;
    declarations.each_map([&](const Map& map) { is_known = is_known || map.name == asked.by; });
    if (auto imported = is_known ? std::nullopt : import_mend(surroundings, asked.by, {"map"}))
      return report(Code::unknown_name, node.by->span,
                    fmt::format("no map for {} is called `{}`", asked.name, asked.by), *std::move(imported));
  }
  if (node.level_name) {
    asked.span = node.level_name->span;
    const auto named = named_level(declarations, meant.percept->name, *node.level_name, surroundings.diagnostics);
    if (!named) return;
    asked.level = meant.reversed
                      ? 1 - *named
                      : *named;  // a name means the same place on the scale for the percept and for its antonym
  } else if (node.value) {
    asked.span = declared.tree->span(*node.value);
    const auto known = plain_level(declared, *node.value, surroundings, "a level", *meant.percept);
    if (!known) return;
    asked.level = *known;
  } else {
    return;  // the parser has reported it
  }
  if (!(asked.level >= 0 && asked.level <= 1))
    return report(
        Code::level_out_of_range, asked.span, readable("the level {:.9g} is outside 0 .. 1", asked.level),
        Advice(asked.level > most_meant_as_level && asked.level <= 100
                   ? typeable("1 is the reference stimulus of `{}`; {:.4g} % is written `{:.4g}`", node.name.text,
                              asked.level, asked.level / 100)
                   : fmt::format("give a level from 0 to 1, where 1 is the reference stimulus of `{}`", node.name.text))
            .fact("low", 0)
            .fact("high", 1)
            .fix(as_percentage(declared, node, asked.level)));
  if (node.tolerance) {
    const auto tolerance = plain_level(declared, *node.tolerance, surroundings, "a tolerance", *meant.percept);
    if (!tolerance) return;
    if (!(*tolerance >= 0 && *tolerance <= 1))
      return report(Code::level_out_of_range, declared.tree->span(*node.tolerance),
                    "a tolerance is a difference of levels, from 0 to 1",
                    Advice("write, for example, `0.6 ± 0.1`").fact("low", 0).fact("high", 1));
    asked.tolerance = *tolerance;
  }
  if (node.evidence) {
    asked.evidence = grade_named(node.evidence->text);
    if (!asked.evidence)
      report(Code::wrong_type, node.evidence->span, fmt::format("a level is not `{}`", node.evidence->text),
             Advice(fmt::format("write how well it is known: {}", grade_words())));
  }
  if (meant.reversed) asked.level = 1 - asked.level;
  const auto taken_over = std::ranges::find(percepts, asked.name, &AskedPercept::name);
  if (taken_over == percepts.end())
    percepts.push_back(asked);
  else
    *taken_over = asked;
}

}  // namespace wale
