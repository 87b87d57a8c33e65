#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <functional>

#include "compiler/modules/declare_records.hpp"

namespace wale {

namespace {

const std::pair<const char*, Evidence> evidence_words[] = {{"measured", Evidence::measured},
                                                           {"published", Evidence::published},
                                                           {"estimated", Evidence::estimated},
                                                           {"recalled", Evidence::recalled},
                                                           {"transferred", Evidence::transferred}};

std::optional<Evidence> grade_named(std::string_view word) {
  for (const auto& [name, evidence] : evidence_words)
    if (word == name) return evidence;
  return std::nullopt;
}

/// All grades in words: "`measured`, `published`, … or `…`".
std::string grade_words() {
  std::vector<std::string> words;
  for (const auto& [name, evidence] : evidence_words) words.push_back(fmt::format("`{}`", name));
  const std::string last = words.back();
  words.pop_back();
  return fmt::format("{} or {}", fmt::join(words, ", "), last);
}

/// The device of `on sandpaper`; empty if the setting names none.
std::string measured_on(const Setting& on) {
  return on.on ? std::string(on.on->text) : on.items.empty() ? "" : words_of(on.items[0]);
}

/// Reads `evidence slope published, handle transferred`: the grade of each part goes to its entry in the list. Items
/// that are not grades are passed to `otherwise`, and reported if it does not accept them.
void read_grades(RecordReader& reader, const Setting& evidence,
                 const std::vector<std::pair<const char*, Evidence*>>& parts,
                 const std::function<bool(const SettingItem&)>& otherwise = {}) {
  std::vector<std::string> names;
  for (const auto& part : parts) names.push_back(fmt::format("`{}`", part.first));
  for (const auto& item : evidence.items) {
    const std::optional<Evidence> grade = grade_named(item.words.size() == 2 ? item.words[1].text : "");
    const auto part = std::ranges::find_if(
        parts, [&](const auto& each) { return !item.words.empty() && item.words[0].text == each.first; });
    if (grade && part != parts.end())
      *part->second = *grade;
    else if (!otherwise || !otherwise(item))
      reader.report(
          Code::wrong_type, item.span,
          fmt::format("the evidence of a {} has separate grades for {}", reader.record.keyword.text,
                      fmt::join(names, ", ")),
          fmt::format("write one of these, then {}{}", grade_words(),
                      otherwise ? "; `anchor none` where the law is not tied to the reference stimulus" : ""));
  }
}

/// A setting's whole number, such as the number of observers; 0 if the setting is missing.
int whole_number(RecordReader& reader, const char* key) {
  const Setting* setting = reader.setting(key);
  return setting ? static_cast<int>(std::lround(reader.quantity(*setting, 0, "number").value_or(0))) : 0;
}

/// `period 0.7 mm .. 10 mm`, `amplitude above 1.1 N`, `period below 2.5 mm`.
std::optional<Map::Condition> condition_of(RecordReader& reader, const SettingItem& item) {
  if (item.words.empty() || !item.value) return std::nullopt;
  Map::Condition condition{.quantity = std::string(item.words[0].text)};
  const auto first = reader.constant(*item.value);
  if (!first) return condition;
  condition.dimension = first->dimension;
  const std::string_view side = item.words.size() == 2 ? std::string_view(item.words[1].text) : "";
  if (item.range_end)
    condition.range = {first->value, reader.value(*item.range_end, first->dimension).value_or(first->value)};
  else if (side == "above")
    condition.range.low = std::nextafter(first->value, HUGE_VAL);
  else if (side == "below")
    condition.range = {-HUGE_VAL, std::nextafter(first->value, -HUGE_VAL)};
  else
    return std::nullopt;
  return condition;
}

/// Reports errors in a law. Errors of dimension name the law's source, since they are errors of the map.
void report_law(RecordReader& reader, const Diagnostics& found, const std::string& source) {
  for (Diagnostic each : found.all()) {
    if (each.code == Code::wrong_dimension || each.code == Code::mismatched_dimensions) {
      each.code = Code::map_dimension;
      each.cause = source.empty() ? "" : fmt::format("the law comes from {}", source);
    }
    reader.diagnostics.report(std::move(each));
  }
  reader.diagnostics.continue_budget(found);
}

/// Reads one map, setting by setting.
class MapReader {
 public:
  MapReader(RecordReader& reader, const Declarations& declarations, const Percept& percept)
      : reader_(reader), declarations_(declarations), percept_(percept) {}

  Map read() {
    const RecordDecl& record = reader_.record;
    map_ = {
        .percept = percept_.name, .from = std::string(record.from ? record.from->text : ""), .span = record.name.span};
    map_.exported = record.exported;
    if (const auto* name = reader_.setting("name"); name && !name->items.empty()) map_.name = words_of(name->items[0]);
    map_.source = reader_.text("source");
    if (!reader_.setting("source"))
      reader_.report(Code::missing_setting, record.name.span, "a map needs a source",
                     "add `source \"author, year, figure\"`");
    read_quantity();
    read_evidence();
    read_couples();
    read_law();
    read_validity();
    if (const auto* scatter = reader_.required("scatter", "0.05")) {
      map_.scatter = reader_.quantity(*scatter, 0, "number").value_or(0);
      map_.scatter_assumed = !scatter->items.empty() && has_word(scatter->items[0], "assumed");
    }
    if (const auto* spread = reader_.setting("spread"))
      map_.spread = reader_.quantity(*spread, 0, "number").value_or(0);
    map_.observers = whole_number(reader_, "observers");
    if (const auto* on = reader_.required("on", "sandpaper")) map_.device = measured_on(*on);
    return std::move(map_);
  }

 private:
  /// Reads the quantity that the law starts from: the percept's carrier, or another one of the dimension in `quantity
  /// length`.
  void read_quantity() {
    if (const auto* quantity = reader_.setting("quantity"); quantity && !quantity->items.empty()) {
      const auto* known = declarations_.dimensions.find(words_of(quantity->items[0]));
      if (known)
        map_.dimension = *known;
      else if (words_of(quantity->items[0]) != "number")
        reader_.report(Code::unknown_name, quantity->span,
                       fmt::format("nothing declares a dimension `{}`", words_of(quantity->items[0])),
                       "name the dimension of the quantity that the law starts from, or `number`");
      map_.of_carrier = map_.from == percept_.argument() && map_.dimension == percept_.carrier_dimension;
      read_one();
      return;
    }
    map_.dimension = percept_.carrier_dimension;
    if (map_.from == percept_.argument() && !map_.from.empty()) return;
    const RecordDecl& record = reader_.record;
    const Span span = record.from ? record.from->span : record.name.span;
    if (percept_.carrier.empty())
      return reader_.report(
          Code::missing_setting, span,
          fmt::format("`{}` has no carrier, so the map must name the dimension that its law starts from",
                      percept_.name),
          "add, for example, `quantity length`");
    reader_.report(Code::unknown_name, span,
                   fmt::format("`{}` is carried by its `{}`, not by `{}`", map_.percept, percept_.carrier, map_.from),
                   Advice(fmt::format("write `map {} from {}`, or add `quantity` if it is not a carrier", map_.percept,
                                      percept_.argument()))
                       .see(percept_.span, "declared here"));
  }

  /// Reads `one 12 m/s^2`: on another kind of device, a quantity of this size feels like the reference stimulus.
  void read_one() {
    const auto* one = reader_.setting("one");
    if (!one || one->items.size() != 1 || !one->items[0].value) return;
    map_.one = reader_.value(*one->items[0].value, map_.dimension);
    if (map_.of_carrier)
      reader_.report(Code::wrong_type, one->span, fmt::format("`{}` is the carrier itself", map_.from),
                     "the percept declares its size at level 1: leave out `one`");
    else if (map_.one && !(*map_.one > 0))
      reader_.report(Code::value_out_of_range, one->span, "level 1 has no size", "write, for example, `one 12 m/s^2`");
  }

  void read_evidence() {
    const auto* evidence = reader_.required("evidence", "slope measured, anchor measured, handle measured");
    if (!evidence) return;
    read_grades(reader_, *evidence, {{"slope", &map_.slope}, {"anchor", &map_.anchor}, {"handle", &map_.handle}},
                [&](const SettingItem& item) {
                  if (words_of(item) != "anchor none") return false;
                  map_.tied = false;
                  return true;
                });
    if (map_.tied && !map_.of_carrier && !map_.one)
      reader_.report(
          Code::wrong_type, evidence->span,
          fmt::format("a law that starts from `{}` is not tied to the reference stimulus of {}", map_.from,
                      map_.percept),
          "write `anchor none`; or, if it replaces the carrier on another device, give `one`, its size at level 1");
  }

  /// `couples stickiness drag`.
  void read_couples() {
    for (const Setting* setting : reader_.settings("couples"))
      for (const auto& item : setting->items) {
        const Percept* other = item.words.size() == 2 ? declarations_.percepts.find(item.words[0].text) : nullptr;
        if (!other || other->argument() != item.words[1].text || other->name == percept_.name) {
          reader_.report(Code::unknown_name, item.span, "a law can couple only the carrier of another percept",
                         "write the percept and its carrier's argument, as in `couples stickiness drag`");
          continue;
        }
        map_.couples.push_back({other->name, std::string(item.words[1].text)});
      }
  }

  void read_law() {
    if (const auto* branch = reader_.setting("branch"); branch && !branch->items.empty()) {
      const std::string side = words_of(branch->items[0]);
      if (side == "rising" || side == "falling")
        map_.branch = side == "rising" ? Branch::rising : Branch::falling;
      else
        reader_.report(Code::wrong_type, branch->span, "a branch must be `rising` or `falling`",
                       "write `branch rising` or `branch falling`");
    }
    if (const auto* table = reader_.setting("table")) return read_table(*table);
    const auto* law = reader_.required("law", "log10(magnitude) = …");
    if (!law) return;
    const SettingItem* equation = law->items.size() == 1 && law->items[0].equals ? &law->items[0] : nullptr;
    // In `law magnitude = …` the parser reads the single name before `=` as a word.
    const Word* lone = equation && !equation->value && equation->words.size() == 1 ? &equation->words[0] : nullptr;
    if (!equation || (!equation->value && !lone))
      return reader_.report(Code::wrong_type, law->span, "a law must be an equation",
                            fmt::format("write `law log10(magnitude) = …` in `magnitude` and `{}`", map_.from));
    Diagnostics found;
    found.continue_budget(reader_.diagnostics);
    std::vector<HeightTable> tables;
    ExpressionChecker checker({reader_.sources, declarations_, found}, map_.terms, tables);
    Scope scope;
    declare_names(scope, law->span);
    const Value left = lone ? checker.named(*lone, scope) : checker.check(reader_.tree, *equation->value, scope);
    if (!left.failed()) {
      const Value right = checker.check_as(reader_.tree, *equation->equals, scope, Value::Type::number, left.dimension);
      map_.left = left.x;
      map_.right = right.x;
    }
    constexpr std::size_t most_terms_of_a_law = 1024;  // it is evaluated hundreds of times
    if (map_.terms.size() > most_terms_of_a_law) found.report_spent(law->span, Work::solving);
    report_law(reader_, found, map_.source);
    for (const auto& name : scope.spellings())
      if (!found.has_errors() && !scope.at(name).used)
        reader_.report(Code::unsolvable_law, law->span, fmt::format("the law does not contain `{}`", name),
                       "write an equation between the magnitude and the carrier");
  }

  void declare_names(Scope& scope, Span span) {
    scope.declare("magnitude", {.type = Value::Type::number, .x = map_.terms.add({.kind = TermKind::magnitude})}, span);
    const auto carrier = [&](const std::string& name, std::uint32_t index, const Dimension& dimension) {
      scope.declare(name,
                    {.type = Value::Type::number,
                     .x = map_.terms.add({.kind = TermKind::carrier, .index = index}),
                     .dimension = dimension},
                    span);
    };
    carrier(map_.from, 0, map_.dimension);
    for (std::size_t i = 0; i < map_.couples.size(); ++i)
      carrier(map_.couples[i].argument, static_cast<std::uint32_t>(i + 1),
              declarations_.percepts.find(map_.couples[i].percept)->carrier_dimension);
  }

  /// `table 0.2 N = 1.6, 1 N = 6.1, 3.8 N = 16.8`.
  void read_table(const Setting& setting) {
    reader_.setting("law");  // read but not used: the table is the law
    for (const auto& item : setting.items) {
      if (!item.value || !item.equals) {
        reader_.report(Code::wrong_type, item.span, "a table must consist of points",
                       fmt::format("write the {} and its magnitude, as in `table 0.2 N = 1.6, 1 N = 6.1`", map_.from));
        return;
      }
      const auto size = reader_.value(*item.value, map_.dimension),
                 magnitude = reader_.value(*item.equals, Dimension{});
      if (!size || !magnitude) return;
      if (!(*size > 0 && *magnitude > 0) || (!map_.table.empty() && !(*size > map_.table.back()[0])))
        return reader_.report(Code::value_out_of_range, item.span,
                              "the values of a table must rise from point to point and be greater than zero",
                              "sort them");
      map_.table.push_back({*size, *magnitude});
    }
    if (map_.table.size() < 2)
      reader_.report(Code::missing_setting, setting.span, "a table needs at least two points", "add another");
    if (!map_.couples.empty())
      reader_.report(Code::wrong_type, setting.span, "a table has only one quantity",
                     "write a `law` to couple another");
  }

  void read_validity() {
    const auto* valid = reader_.required("valid", map_.from + " … .. …");
    if (!valid) return;
    Diagnostics found;
    found.continue_budget(reader_.diagnostics);
    RecordReader quiet(reader_.tree, reader_.record, reader_.sources, declarations_, found);
    for (const auto& item : valid->items) {
      map_.validity.emplace_back(reader_.sources.text(item.span));
      if (words_of(item) == map_.from && item.value && item.range_end) {
        map_.valid_low = quiet.value(*item.value, map_.dimension).value_or(0);
        map_.valid_high = quiet.value(*item.range_end, map_.dimension).value_or(0);
      } else if (const auto condition = condition_of(quiet, item)) {
        map_.conditions.push_back(*condition);
      }
    }
    report_law(reader_, found, map_.source);
    if (!found.has_errors() && !(map_.valid_low > 0 && map_.valid_high > map_.valid_low))
      reader_.report(Code::value_out_of_range, valid->span,
                     fmt::format("the range of `{}` is empty or missing", map_.from),
                     fmt::format("write, for example, `valid {} 9 pu .. 194 pu`", map_.from));
  }

  RecordReader& reader_;
  const Declarations& declarations_;
  const Percept& percept_;
  Map map_;
};

}  // namespace

void declare_map(RecordReader& reader, Declarations& declarations) {
  const RecordDecl& record = reader.record;
  const Percept* percept = declarations.percepts.find(record.name.text);
  if (!percept)
    return reader.reject(Code::unknown_name, record.name.span,
                         fmt::format("nothing declares a percept `{}`", record.name.text),
                         did_you_mean(record.name.span, record.name.text, declarations.percepts.spellings(),
                                      "declare it, as in schema/percepts.wale"));
  Map map = MapReader(reader, declarations, *percept).read();
  for (const Map* other : declarations.maps())
    if (!map.name.empty() && other->name == map.name)
      reader.report(Code::declared_twice, record.name.span, fmt::format("a map `{}` is declared already", map.name),
                    another_name(other->span));
  declarations.own_maps.push_back(std::move(map));
}

void declare_threshold(RecordReader& reader, Declarations& declarations) {
  const RecordDecl& record = reader.record;
  Threshold threshold{.cue = std::string(record.name.text), .span = record.name.span, .exported = record.exported};
  if (const auto* quantity = reader.required("quantity", "force"); quantity && !quantity->items.empty()) {
    const std::string name = words_of(quantity->items[0]);
    if (const auto* known = declarations.dimensions.find(name))
      threshold.dimension = *known;
    else if (name != "number")
      reader.report(Code::unknown_name, quantity->span, fmt::format("nothing declares a dimension `{}`", name),
                    did_you_mean(quantity->items[0].span, name, declarations.dimensions.spellings(), "or `number`"));
  }
  if (const auto* name = reader.setting("name"); name && !name->items.empty())
    threshold.name = words_of(name->items[0]);
  threshold.published = reader.positive("weber", 0, "number", "0.1");
  if (const auto* task = reader.required("task", "forced_choice"); task && !task->items.empty()) {
    const std::string name = words_of(task->items[0]);
    if (name == "forced_choice" || name == "adjustment" || name == "yes_no")
      threshold.task = name == "adjustment" ? Task::adjustment : name == "yes_no" ? Task::yes_no : Task::forced_choice;
    else
      reader.report(Code::wrong_type, task->span, fmt::format("no task is called `{}`", name),
                    "write `forced_choice`, `adjustment` or `yes_no`");
  }
  if (const auto* criterion = reader.required("criterion", "75 %")) {
    threshold.criterion = reader.quantity(*criterion, 0, "number").value_or(0.75);
    threshold.criterion_assumed = !criterion->items.empty() && has_word(criterion->items[0], "assumed");
    if (!(threshold.criterion > 0.5 && threshold.criterion < 1)) {
      reader.report(Code::value_out_of_range, criterion->span,
                    "a criterion must be a share of correct answers above chance",
                    "write, for example, `criterion 75 %`");
      threshold.criterion = 0.75;
    }
    threshold.weber = threshold.published / sensitivity(threshold.task, threshold.criterion);
  }
  if (const auto* floor = reader.setting("floor"); floor && !floor->items.empty() && floor->items[0].value) {
    threshold.floor = reader.value(*floor->items[0].value, threshold.dimension).value_or(0);
    threshold.floor_assumed = has_word(floor->items[0], "assumed");
  }
  if (const auto* valid = reader.setting("valid"))
    for (const auto& item : valid->items)
      if (item.words.empty() && item.value && item.range_end)
        threshold.valid = {reader.value(*item.value, threshold.dimension).value_or(0),
                           reader.value(*item.range_end, threshold.dimension).value_or(0)};
  threshold.observers = whole_number(reader, "observers");
  if (const auto* evidence = reader.required("evidence", "slope published, handle transferred"))
    read_grades(reader, *evidence, {{"slope", &threshold.evidence}, {"handle", &threshold.handle}});
  if (const auto* on = reader.required("on", "sandpaper")) threshold.device = measured_on(*on);
  threshold.source = reader.text("source");
  if (!reader.setting("source"))
    reader.report(Code::missing_setting, record.name.span, "a threshold needs a source",
                  "add `source \"author, year\"`");
  declarations.own_thresholds.push_back(std::move(threshold));
}

void declare_rule(RecordReader& reader, Declarations& declarations) {
  const RecordDecl& record = reader.record;
  Rule rule{.name = std::string(record.name.text), .span = record.name.span, .exported = record.exported};
  for (const Setting* setting : reader.settings("case")) {
    Rule::Case each{.span = setting->span};
    for (const auto& item : setting->items) {
      const auto* label = item.value ? std::get_if<TextLiteral>(&reader.tree.expr(*item.value)) : nullptr;
      const std::string_view first = item.words.empty() ? "" : item.words[0].text;
      if (label && &item == &setting->items.front()) {
        each.label = label->text;
      } else if (first == "kind" && item.words.size() == 2) {
        each.kind = item.words[1].text;
      } else if ((first == "confidence" || first == "spread") && item.words.size() == 1 && item.value) {
        (first == "spread" ? each.spread : each.confidence) = reader.value(*item.value, Dimension{});
      } else if (const auto condition = condition_of(reader, item)) {
        each.conditions.push_back(*condition);
      } else {
        reader.report(Code::wrong_type, item.span, "a case needs a text, then its conditions",
                      "write, for example, `case \"moguls\", amplitude above 1.1 N, period above 7 mm`");
      }
    }
    rule.cases.push_back(std::move(each));
  }
  if (rule.cases.empty()) reader.required("case", "\"flat texture\", period below 2.5 mm");
  if (const auto* evidence = reader.required("evidence", "measured"); evidence && !evidence->items.empty()) {
    const auto grade = grade_named(words_of(evidence->items[0]));
    if (grade)
      rule.evidence = *grade;
    else
      reader.report(Code::wrong_type, evidence->span, "this is not a grade of evidence", "write " + grade_words());
  }
  if (const auto* on = reader.required("on", "sandpaper")) rule.device = measured_on(*on);
  rule.source = reader.text("source");
  if (!reader.setting("source"))
    reader.report(Code::missing_setting, record.name.span, "a rule needs a source",
                  "add `source \"author, year, section\"`");
  declarations.own_rules.push_back(std::move(rule));
}

}  // namespace wale
