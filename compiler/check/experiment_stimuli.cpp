#include "compiler/check/experiment_stimuli.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "compiler/check/check_material.hpp"
#include "compiler/parse/overloaded.hpp"
#include "compiler/text/readable.hpp"

namespace wale {
namespace {

constexpr const char* example_of_factor = "write, for example, `factor amplitude 0.2 N, 0.8 N, 2 N`";
constexpr const char* example_of_steps = "write, for example, `factor amplitude 0.2 N .. 2 N, steps 15`";
constexpr const char* example_of_stimulus = "write, for example, `stimulus bench(amplitude: amplitude)`";
constexpr std::size_t most_levels = 500;

/// " N s/m^2": the unit behind a number, as it is written.
std::string suffix_of(const SyntaxTree& tree, const NumberLiteral& number) {
  std::string text;
  for (const SuffixFactor& each : tree.suffix(number)) {
    text += each.divides ? "/" : " ";
    text += each.name.text;
    if (each.exponent != 1) text += fmt::format("^{}", each.exponent);
  }
  return text;
}

bool is_word_alone(const SettingItem& item) {
  return item.words.size() == 1 && !item.value && !item.equals && item.trailing.empty();
}

}  // namespace

ExprId ExperimentStimuli::add(Expr expr, Span span) {
  tree_.exprs.push_back(std::move(expr));
  tree_.expr_spans.push_back(span);
  return static_cast<ExprId>(tree_.exprs.size() - 1);
}

std::optional<std::size_t> ExperimentStimuli::factor_named(std::string_view name) const {
  const auto found = std::ranges::find(experiment_.factors, name, &ExperimentFactor::name);
  if (found == experiment_.factors.end()) return std::nullopt;
  return static_cast<std::size_t>(found - experiment_.factors.begin());
}

void ExperimentStimuli::read_factor(const Setting& setting) {
  const SettingItem& first = setting.items.front();
  if (first.words.empty() || first.equals || (first.words.size() == 1 && !first.value) || first.words.size() > 2 ||
      (first.words.size() == 2 && first.value))
    return reader_.report(Code::wrong_type, setting.span, "a factor is a name with its levels", example_of_factor);
  ExperimentFactor factor;
  factor.name = first.words.front().text, factor.span = first.words.front().span;
  if (const auto other = factor_named(factor.name))
    return reader_.report(Code::declared_twice, factor.span, fmt::format("there are two factors `{}`", factor.name),
                          another_name(experiment_.factors[*other].span));
  std::vector<WrittenLevel> levels;
  if (first.range_end) {
    if (!add_steps(setting, factor, levels)) return;
  } else {
    for (std::size_t i = 0; i < setting.items.size(); ++i)
      if (!add_level(setting, i, factor, levels)) return;
  }
  experiment_.factors.push_back(std::move(factor));
  levels_.push_back(std::move(levels));
}

/// Reads one level, a quantity or a material.
bool ExperimentStimuli::add_level(const Setting& setting, std::size_t index, ExperimentFactor& factor,
                                  std::vector<WrittenLevel>& levels) {
  const SettingItem& item = setting.items[index];
  const std::size_t heading = index == 0 ? 1 : 0;  // the name of the factor
  if (item.equals || item.range_end || !item.trailing.empty() || item.words.size() > heading + 1 ||
      (item.value.has_value() == (item.words.size() > heading))) {
    reader_.report(Code::wrong_type, item.span,
                   item.range_end ? "a range has its number of steps, and nothing besides"
                                  : "a level is a quantity or the name of a material",
                   item.range_end ? example_of_steps : example_of_factor);
    return false;
  }
  WrittenLevel level;
  ExperimentLevel& checked = factor.levels.emplace_back();
  if (item.value) {
    const auto known = reader_.constant(*item.value);
    if (!known) return false;
    const std::string unit = surroundings_.declarations.names().unit(known->dimension);
    if (index > 0 && (factor.unit != unit || !factor.levels.front().value)) {
      reader_.report(Code::mismatched_dimensions, item.span, "the levels of a factor must have one dimension",
                     fmt::format("give it the dimension of the first level, {}",
                                 surroundings_.sources.text(setting.items.front().span)));
      return false;
    }
    factor.unit = unit;
    checked.value = known->value;
    level.value = *item.value;
    level.text = surroundings_.sources.text(tree_.span(*item.value));
    if (std::holds_alternative<Binary>(tree_.expr(*item.value))) level.text = fmt::format("({})", level.text);
  } else {
    if (index > 0 && factor.levels.front().value) {
      reader_.report(Code::wrong_type, item.span, "the levels of a factor are all quantities or all materials",
                     example_of_factor);
      return false;
    }
    level.material = item.words.back();
    level.text = level.material.text;
  }
  checked.text = level.text;
  const auto same = [&](const ExperimentLevel& each) {
    return &each != &checked && (checked.value ? each.value == checked.value : each.text == checked.text);
  };
  if (std::ranges::any_of(factor.levels, same)) {
    reader_.report(Code::declared_twice, item.span, fmt::format("the level {} is there twice", checked.text),
                   "remove one of them; `repetitions` presents all stimuli several times");
    return false;
  }
  levels.push_back(std::move(level));
  return true;
}

/// Reads `0.2 N .. 2 N, steps 15`, levels in equal ratios, or with `even` in equal distances.
bool ExperimentStimuli::add_steps(const Setting& setting, ExperimentFactor& factor, std::vector<WrittenLevel>& levels) {
  const SettingItem& range = setting.items.front();
  const auto low = reader_.constant(*range.value), high = reader_.constant(*range.range_end);
  if (!low || !high) return false;
  bool even = false;
  std::optional<double> steps;
  for (std::size_t i = 1; i < setting.items.size(); ++i) {
    const SettingItem& item = setting.items[i];
    if (is_word_alone(item) && item.words.front().text == "even") {
      even = true;
    } else if (words_of(item) == "steps" && item.value && !item.range_end && !item.equals) {
      steps = reader_.value(*item.value, Dimension{});
      if (!steps) return false;
    } else {
      reader_.report(Code::wrong_type, item.span, "a range has its number of steps, and nothing besides",
                     example_of_steps);
      return false;
    }
  }
  const auto* literal = std::get_if<NumberLiteral>(&tree_.expr(*range.value));
  if (!steps || low->dimension != high->dimension || !literal) {
    reader_.report(low->dimension != high->dimension ? Code::mismatched_dimensions : Code::wrong_type, setting.span,
                   low->dimension != high->dimension ? "the ends of the range have different dimensions"
                   : !steps                          ? "a range needs its number of steps"
                                                     : "a range begins with a number and its unit",
                   example_of_steps);
    return false;
  }
  if (*steps != std::floor(*steps) || *steps < 2 || *steps > static_cast<double>(most_levels) ||
      !(low->value < high->value) || (!even && !(low->value > 0))) {
    const bool count = *steps != std::floor(*steps) || *steps < 2 || *steps > static_cast<double>(most_levels);
    reader_.report(Code::value_out_of_range, setting.span,
                   count                       ? fmt::format("a range has 2 to {} steps", most_levels)
                   : low->value < high->value ? std::string("steps of equal ratio must begin above 0")
                                               : std::string("a range goes from the lower to the higher end"),
                   count                       ? example_of_steps
                   : low->value < high->value ? "begin above 0, or write `even` for equal distances"
                                               : "exchange its ends");
    return false;
  }
  const auto count = static_cast<std::size_t>(*steps);
  const std::string suffix = suffix_of(tree_, *literal);
  const NumberLiteral first = *literal;  // `add` moves the expressions
  const double unit = first.value != 0 ? low->value / first.value : 1;
  if (first.value == 0 && !tree_.suffix(first).empty()) {
    reader_.report(Code::value_out_of_range, range.span, "a range in steps must begin above 0", example_of_steps);
    return false;
  }
  factor.unit = surroundings_.declarations.names().unit(low->dimension);
  for (std::size_t i = 0; i < count; ++i) {
    const double share = static_cast<double>(i) / static_cast<double>(count - 1);
    const double value = even ? low->value + share * (high->value - low->value)
                              : low->value * std::pow(high->value / low->value, share);
    const std::string text = fmt::format("{:.6g}", value / unit);
    // The level is what is written, so that the text alone makes the same program again.
    const double written = std::stod(text);
    levels.push_back({add(NumberLiteral{written, first.suffix}, range.span), {}, text + suffix});
    factor.levels.push_back({text + suffix, written * unit});
  }
  return true;
}

/// The factors that an expression names, each once.
void ExperimentStimuli::names_in(ExprId expr, std::vector<std::size_t>& factors) const {
  const auto note = [&](std::string_view name) {
    const auto found = factor_named(name);
    if (found && std::ranges::find(factors, *found) == factors.end()) factors.push_back(*found);
  };
  std::visit(Overloaded{[&](const NameUse& use) { note(use.name); },
                        [&](const Unary& node) { names_in(node.operand, factors); },
                        [&](const Binary& node) { names_in(node.left, factors), names_in(node.right, factors); },
                        [&](const Call& call) {
                          if (!call.quoted) note(call.callee.text);
                          for (const Argument& each : tree_.arguments(call)) names_in(each.value, factors);
                        },
                        [&](const Conditional& node) {
                          for (const ExprId each : {node.condition, node.yes, node.no}) names_in(each, factors);
                        },
                        [&](const Part& node) { names_in(node.whole, factors); }, [](const auto&) {}},
             tree_.expr(expr));
}

/// The expression with a level in place of each factor's name. `edits` receive what that changes in its text.
ExprId ExperimentStimuli::bound(ExprId expr, const std::vector<std::size_t>& levels,
                                std::vector<std::pair<Span, std::string>>& edits) {
  const Span span = tree_.span(expr);
  const Expr node = tree_.expr(expr);
  if (const auto* use = std::get_if<NameUse>(&node)) {
    const auto factor = factor_named(use->name);
    if (!factor) return expr;
    const WrittenLevel& level = levels_[*factor][levels[*factor]];
    edits.emplace_back(span, level.text);
    return level.material.text.empty() ? level.value : add(NameUse{level.material.text}, level.material.span);
  }
  if (const auto* unary = std::get_if<Unary>(&node))
    return add(Unary{unary->op, bound(unary->operand, levels, edits)}, span);
  if (const auto* binary = std::get_if<Binary>(&node)) {
    const ExprId left = bound(binary->left, levels, edits);
    return add(Binary{binary->op, left, bound(binary->right, levels, edits)}, span);
  }
  if (const auto* call = std::get_if<Call>(&node)) {
    Call made = *call;
    const auto factor = call->quoted ? std::nullopt : factor_named(call->callee.text);
    if (factor && !levels_[*factor].front().material.text.empty()) {
      made.callee = levels_[*factor][levels[*factor]].material;
      edits.emplace_back(call->callee.span, std::string(made.callee.text));
    }
    std::vector<Argument> arguments(tree_.arguments(*call).begin(), tree_.arguments(*call).end());
    for (Argument& each : arguments) each.value = bound(each.value, levels, edits);
    made.arguments = {static_cast<std::uint32_t>(tree_.call_arguments.size()), call->arguments.count};
    tree_.call_arguments.insert(tree_.call_arguments.end(), arguments.begin(), arguments.end());
    return add(made, span);
  }
  return expr;
}

/// Reads what an item says is felt. Empty after an error, which is reported.
std::optional<ExperimentStimuli::Written> ExperimentStimuli::written(const SettingItem& item, bool may_be_named) {
  Written made;
  made.span = item.span;
  const bool named = may_be_named && item.words.size() == 1 && !item.value && item.equals;
  if (is_word_alone(item)) {
    made.made_of = add(NameUse{item.words.front().text}, item.words.front().span);
  } else if (named) {
    made.made_of = *item.equals;
    made.name = item.words.front().text;
  } else if (item.words.empty() && item.value && !item.range_end && !item.equals && item.trailing.empty()) {
    made.made_of = *item.value;
  } else {
    reader_.report(Code::wrong_type, item.span, "expected a material", example_of_stimulus);
    return std::nullopt;
  }
  names_in(made.made_of, made.factors);
  return made;
}

std::string ExperimentStimuli::free_name(const std::string& made_of, const std::string& given) {
  const std::string base = given.empty() ? made_of : given;
  std::string name = base;
  for (int number = 2; !names_.insert(name).second; ++number) name = fmt::format("{}_{}", base, number);
  return name;
}

std::shared_ptr<const CheckedMaterial> ExperimentStimuli::material(const Written& of,
                                                                   const std::vector<std::size_t>& levels,
                                                                   std::string& made_of) {
  std::vector<std::pair<Span, std::string>> edits;
  const ExprId expr = bound(of.made_of, levels, edits);
  const Span whole = tree_.span(of.made_of);
  made_of = surroundings_.sources.text(whole);
  std::ranges::sort(edits, std::greater<>(), [](const auto& each) { return each.first.begin; });
  for (const auto& [span, text] : edits) made_of.replace(span.begin - whole.begin, span.end - span.begin, text);
  const std::size_t errors_before = surroundings_.diagnostics.error_count();
  MaterialDecl decl;
  decl.name = {"stimulus", of.span};
  decl.derived_from = expr;
  decl.span = of.span;
  auto checked = std::make_shared<const CheckedMaterial>(
      check_material({&tree_, &decl, &surroundings_.declarations}, surroundings_, false));
  return surroundings_.diagnostics.error_count() == errors_before ? checked : nullptr;
}

/// Adds a stimulus for each combination of the levels that it names. False after an error.
bool ExperimentStimuli::cross(const Written& stimulus, const std::optional<Written>& standard) {
  std::vector<std::size_t> factors = stimulus.factors;
  std::ranges::sort(factors);  // the last one written goes fastest
  for (const std::size_t each : factors) used_[each] = true;
  if (standard)
    for (const std::size_t each : standard->factors)
      if (std::ranges::find(factors, each) == factors.end()) {
        const std::string& name = experiment_.factors[each].name;
        reader_.report(Code::unknown_name, standard->span,
                       fmt::format("the standard names the factor `{}`, which its stimulus does not", name),
                       fmt::format("give the stimulus a parameter that is `{}`, or the standard a level", name));
        return false;
      }
  std::size_t count = 1;
  for (const std::size_t each : factors) {
    count *= levels_[each].size();
    if (count + experiment_.stimuli.size() > most_stimuli) {
      reader_.report(Code::value_out_of_range, stimulus.span,
                     readable("an experiment has at most {} stimuli", most_stimuli),
                     "give its factors fewer levels, or make several experiments");
      return false;
    }
  }
  std::vector<std::size_t> levels(levels_.size(), 0);
  for (std::size_t number = 0; number < count; ++number) {
    std::size_t rest = number;
    for (std::size_t i = factors.size(); i-- > 0; rest /= levels_[factors[i]].size())
      levels[factors[i]] = rest % levels_[factors[i]].size();
    ExperimentStimulus made;
    made.span = stimulus.span;
    made.material = material(stimulus, levels, made.made_of);
    if (!made.material) return false;
    std::string given = stimulus.name;
    for (const std::size_t each : factors)
      if (!given.empty()) given += ", " + levels_[each][levels[each]].text;
    made.name = free_name(made.made_of, given);
    made.levels.resize(levels_.size());
    for (const std::size_t each : factors) made.levels[each] = levels[each];
    if (standard) {
      ExperimentStimulus against;
      against.span = standard->span;
      against.material = material(*standard, levels, against.made_of);
      if (!against.material) return false;
      const auto [known, is_new] = standards_.emplace(against.made_of, experiment_.standards.size());
      made.standard = known->second;
      if (is_new) {
        against.name = "standard " + against.made_of;
        against.levels.resize(levels_.size());
        for (const std::size_t each : standard->factors) against.levels[each] = levels[each];
        experiment_.standards.push_back(std::move(against));
      }
    }
    experiment_.stimuli.push_back(std::move(made));
  }
  return true;
}

void ExperimentStimuli::read() {
  const std::size_t errors_before = surroundings_.diagnostics.error_count();
  for (const Setting* setting : reader_.settings("factor")) read_factor(*setting);
  used_.assign(levels_.size(), false);
  const Setting* compared = reader_.setting("standard");
  const auto all = reader_.settings("stimulus");
  if (all.empty()) reader_.required("stimulus", "bench(amplitude: amplitude)");
  // Without a factor, stimuli would be said to name something unknown.
  if (surroundings_.diagnostics.error_count() > errors_before) return;
  std::optional<Written> standard;
  if (const Setting* setting = compared) {
    if (setting->items.size() == 1)
      standard = written(setting->items.front(), false);
    else
      reader_.report(Code::wrong_type, setting->span, "an experiment has one standard",
                     "let it depend on a factor: `standard bench(amplitude: reference)`");
  }
  for (const Setting* setting : all)
    for (const SettingItem& item : setting->items) {
      const auto made = written(item, true);
      if (surroundings_.diagnostics.error_count() > errors_before) return;
      if (!made || !cross(*made, standard)) return;
    }
  for (std::size_t i = 0; i < used_.size() && !all.empty(); ++i)
    if (!used_[i])
      reader_.report(Code::unknown_name, experiment_.factors[i].span,
                     fmt::format("no stimulus depends on the factor `{}`", experiment_.factors[i].name),
                     fmt::format("name it in a stimulus, as in `stimulus bench({0}: {0})`, or remove it",
                                 experiment_.factors[i].name));
}

}  // namespace wale
