#include "compiler/modules/declare_records.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

#include "schema/spelling.hpp"

namespace wale {

std::string words_of(const SettingItem& item) {
  std::string text;
  for (const auto& word : item.words) text += fmt::format("{}{}", text.empty() ? "" : " ", word.text);
  return text;
}

bool is_unknown(const Setting& setting) {
  return setting.items.size() == 1 && !setting.items[0].value && words_of(setting.items[0]) == "unknown";
}

bool has_word(const SettingItem& item, std::string_view word) {
  return std::ranges::find(item.words, word, &Word::text) != item.words.end() ||
         std::ranges::find(item.trailing, word, &Word::text) != item.trailing.end();
}

Advice another_name(Span declared) {
  return Advice("give one of them another name").see(declared, "declared here first");
}

RecordReader::RecordReader(const SyntaxTree& tree, const RecordDecl& record, const SourceSet& sources,
                           const Declarations& declarations, Diagnostics& diagnostics)
    : tree(tree), record(record), sources(sources), declarations(declarations), diagnostics(diagnostics) {}

void RecordReader::report(Code code, Span span, std::string message, Advice advice) {
  diagnostics.report(std::move(advice).about(code, span, std::move(message)));
}

std::vector<const Setting*> RecordReader::settings(const std::string& key) {
  asked_.insert(key);
  std::vector<const Setting*> found;
  for (const auto& setting : record.settings)
    if (setting.key.text == key) found.push_back(&setting), read_.insert(&setting);
  return found;
}

const Setting* RecordReader::setting(const std::string& key) {
  const bool first_time = !asked_.contains(key);
  const auto found = settings(key);
  for (std::size_t i = 1; first_time && i < found.size(); ++i)
    report(Code::declared_twice, found[i]->key.span, fmt::format("`{}` is set twice", key),
           Advice("keep one of them").see(found.front()->key.span, "set here first"));
  return found.empty() ? nullptr : found.front();
}

const Setting* RecordReader::required(const std::string& key, const std::string& example) {
  const Setting* found = setting(key);
  if (!found) missing_.emplace(key, example);
  return found;
}

std::optional<double> RecordReader::value(ExprId expr, const Dimension& dimension) {
  Terms terms;
  std::vector<HeightTable> tables;
  ExpressionChecker checker({sources, declarations, diagnostics}, terms, tables);
  Scope scope;
  return checker.constant(tree, expr, scope, dimension);
}

std::optional<double> RecordReader::quantity(const Setting& setting, std::size_t index, const std::string& dimension) {
  if (index >= setting.items.size() || !setting.items[index].value) {
    report(Code::missing_setting, setting.span,
           fmt::format("`{}` needs {} value{}", setting.key.text, index + 1, index == 0 ? "" : "s"),
           "separate them by commas");
    return std::nullopt;
  }
  return value(*setting.items[index].value, dimension == "number" ? Dimension{} : declarations.dimension(dimension));
}

double RecordReader::positive(const std::string& key, std::size_t index, const std::string& dimension,
                              const std::string& example) {
  const Setting* found = index == 0 ? required(key, example) : setting(key);
  if (!found) return 0;
  const auto known = quantity(*found, index, dimension);
  if (known && !(*known > 0)) {
    report(Code::value_out_of_range, found->items[index].span, fmt::format("`{}` must be greater than zero", key),
           fmt::format("write, for example, `{} {}`", key, example));
    return 0;
  }
  return known.value_or(0);
}

std::string RecordReader::text(const std::string& key) {
  const Setting* found = setting(key);
  if (!found) return {};
  if (found->items.size() == 1 && found->items[0].value)
    if (const auto* literal = std::get_if<TextLiteral>(&tree.expr(*found->items[0].value)))
      return std::string(literal->text);
  report(Code::wrong_type, found->span, fmt::format("`{}` must be a text", key), fmt::format("write `{} \"…\"`", key));
  return {};
}

std::optional<RecordReader::Quantity> RecordReader::constant(ExprId expr) {
  Terms terms;
  std::vector<HeightTable> tables;
  ExpressionChecker checker({sources, declarations, diagnostics}, terms, tables);
  Scope scope;
  const Value value = checker.check(tree, expr, scope);
  if (value.failed()) return std::nullopt;
  if (value.type != Value::Type::number) {
    report(Code::wrong_type, value.span, fmt::format("expected a number, found {}", type_words(value.type)),
           "write a number with its unit, as in `0.7 mm`");
    return std::nullopt;
  }
  const auto known = checker.constant(value);
  if (!known) return std::nullopt;
  return Quantity{*known, value.dimension};
}

std::vector<std::string> RecordReader::texts(const Setting& setting) {
  std::vector<std::string> found;
  for (const auto& item : setting.items) {
    const auto* literal = item.value ? std::get_if<TextLiteral>(&tree.expr(*item.value)) : nullptr;
    if (literal)
      found.emplace_back(literal->text);
    else
      report(Code::wrong_type, item.span, fmt::format("`{}` takes texts in quotes", setting.key.text),
             fmt::format("write `{} \"…\"`", setting.key.text));
  }
  return found;
}

void RecordReader::reject(Code code, Span span, std::string message, Advice advice) {
  report(code, span, std::move(message), std::move(advice));
  rejected_ = true;
}

void RecordReader::report_keys() {
  if (rejected_) return;
  const std::vector<std::string> known(asked_.begin(), asked_.end());
  // A setting that is there already is not the one that was meant.
  std::vector<std::string> absent;
  for (const std::string& each : known)
    if (std::ranges::none_of(record.settings, [&](const Setting& setting) { return setting.key.text == each; }))
      absent.push_back(each);
  for (const auto& setting : record.settings) {
    if (read_.contains(&setting)) continue;
    report(Code::unknown_setting, setting.key.span,
           fmt::format("{} has no setting `{}`", with_article(std::string(record.keyword.text)), setting.key.text),
           did_you_mean(setting.key.span, setting.key.text, absent, fmt::format("it has: {}", fmt::join(known, ", "))));
    if (const auto meant = nearest_spelling(setting.key.text, absent)) missing_.erase(*meant);
  }
  for (const auto& [key, example] : missing_)
    report(Code::missing_setting, record.name.span,
           fmt::format("the {} `{}` lacks `{}`", record.keyword.text, record.name.text, key),
           fmt::format("add `{} {}`", key, example));
}

void declare_levels(RecordReader& reader, Declarations& declarations) {
  Levels levels{.percept = std::string(reader.record.name.text), .levels = {}, .span = reader.record.name.span};
  levels.exported = reader.record.exported;
  if (!declarations.percepts.contains(levels.percept))
    reader.report(Code::unknown_name, levels.span, fmt::format("nothing declares a percept `{}`", levels.percept),
                  did_you_mean(levels.span, levels.percept, declarations.percepts.spellings(),
                               "declare it, as in schema/percepts.wale"));
  for (const auto& setting : reader.record.settings) {
    reader.setting(std::string(setting.key.text));  // the keys are names that the author chose
    const auto value = reader.quantity(setting, 0, "number");
    if (!value) continue;
    if (!(*value >= 0 && *value <= 1))
      reader.report(Code::level_out_of_range, setting.span,
                    fmt::format("the level `{}` is outside 0 .. 1", setting.key.text),
                    Advice("1 is the percept's reference stimulus").fact("low", 0).fact("high", 1));
    else
      levels.levels.push_back({std::string(setting.key.text), *value, setting.key.span});
  }
  declarations.own_levels.push_back(std::move(levels));
}

void declare_hand(RecordReader& reader, Declarations& declarations) {
  const RecordDecl& record = reader.record;
  HandDeclaration hand{.name = std::string(record.name.text), .span = record.name.span};
  if (const auto* other = declarations.hands.entry(hand.name))
    return reader.reject(Code::declared_twice, record.name.span,
                         fmt::format("a hand `{}` is declared already", hand.name), another_name(other->declared));
  hand.mass = reader.positive("mass", 0, "mass", "0.55 kg");
  hand.damping = reader.positive("damping", 0, "viscosity", "6.5 N s/m");
  hand.stiffness = reader.positive("stiffness", 0, "stiffness", "135 N/m");
  const auto motion = [&](const char* key, double& size, double& frequency) {
    if (const auto* found = reader.setting(key)) {
      size = reader.quantity(*found, 0, "length").value_or(0);
      frequency = reader.quantity(*found, 1, "frequency").value_or(0);
    }
  };
  motion("lateral", hand.lateral_amplitude, hand.lateral_frequency);
  motion("circular", hand.circular_radius, hand.circular_frequency);
  motion("press", hand.press_depth, hand.press_frequency);
  if (const auto* counts = reader.setting("counts_per_period")) {
    hand.fewest_counts = reader.quantity(*counts, 0, "number").value_or(0);
    hand.faithful_counts = reader.quantity(*counts, 1, "number").value_or(0);
  }
  if (const auto* levels = reader.setting("force_levels"))
    hand.fewest_levels = reader.quantity(*levels, 0, "number").value_or(0);
  hand.source = reader.text("source");
  declarations.hands.add(hand.name, {.what = hand, .declared = record.name.span, .exported = record.exported});
}

}  // namespace wale
