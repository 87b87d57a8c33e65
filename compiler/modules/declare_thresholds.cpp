#include <fmt/format.h>

#include <algorithm>
#include <span>

#include "compiler/modules/declare_evidence.hpp"

namespace wale {

namespace {

const std::pair<const char*, Task> task_words[] = {{"forced_choice", Task::forced_choice},
                                                   {"adjustment", Task::adjustment},
                                                   {"yes_no", Task::yes_no},
                                                   {"one_interval", Task::one_interval},
                                                   {"identification", Task::identification}};

/// Reads the task of a threshold, and its criterion and fraction at d' = 1, or the number of sizes that are recognised.
void read_task(RecordReader& reader, Threshold& threshold) {
  if (const auto* task = reader.required("task", "forced_choice"); task && !task->items.empty()) {
    const std::vector<std::string_view> words = plain_words(task->items[0]);
    const std::string_view name = words.empty() ? "" : words[0];
    const auto known = std::ranges::find(task_words, name, [](const auto& each) { return each.first; });
    threshold.task_assumed = has_word(task->items[0], "assumed");
    if (known != std::end(task_words))
      threshold.task = known->second;
    else
      reader.report(Code::wrong_type, task->span, fmt::format("no task is called `{}`", name),
                    "write `forced_choice`, `adjustment`, `yes_no`, `one_interval` or `identification`");
  }
  if (threshold.task == Task::identification) {
    threshold.recognised = reader.positive("recognised", 0, "number", "2.9");
    if (reader.setting("recognised") && !(threshold.recognised >= 1))
      reader.report(Code::value_out_of_range, reader.setting("recognised")->span, "people recognise one size at least",
                    "write, for example, `recognised 2.9`");
    threshold.recognised = std::max(threshold.recognised, 1.0);
    return;
  }
  threshold.published = reader.positive("weber", 0, "number", "0.1");
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
}

/// Reads `valid 2.5 N .. 10 N, speed 25 mm/s .. 160 mm/s`: the sizes of the cue that were compared, which may stand
/// under the cue's own name, and other conditions.
void read_compared(RecordReader& reader, Threshold& threshold) {
  const auto* valid = reader.setting("valid");
  if (!valid) return;
  for (const auto& item : valid->items) {
    const std::vector<std::string_view> words = plain_words(item);
    const bool named = !words.empty() && words[0] == threshold.cue;
    if (auto own = range_of(reader, item, std::span(words).subspan(named ? 1 : 0))) {
      if (own->written.empty()) continue;  // its value is reported already
      own->quantity = threshold.cue;
      if (own->dimension != threshold.dimension)
        reader.report(Code::wrong_dimension, item.span,
                      fmt::format("the range of `{}` has another dimension than its `quantity`", threshold.cue),
                      "write the name of the quantity before the range, as in `speed 25 mm/s .. 160 mm/s`");
      else
        threshold.valid = *own;
    } else if (const auto condition = condition_of(reader, item)) {
      threshold.conditions.push_back(*condition);
    } else {
      reader.report(Code::wrong_type, item.span, "expected a range of sizes",
                    "write, for example, `valid 2.5 N .. 10 N, speed 25 mm/s .. 160 mm/s`");
    }
  }
}

}  // namespace

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
  read_task(reader, threshold);
  if (const auto* floor = reader.setting("floor"); floor && !floor->items.empty() && floor->items[0].value) {
    threshold.floor = reader.value(*floor->items[0].value, threshold.dimension).value_or(0);
    threshold.floor_assumed = has_word(floor->items[0], "assumed");
  }
  read_compared(reader, threshold);
  threshold.observers = whole_number(reader, "observers");
  if (const auto* evidence = reader.required("evidence", "slope published, handle transferred"))
    read_grades(reader, *evidence, {{"slope", &threshold.evidence}, {"handle", &threshold.handle}});
  if (const auto* on = reader.required("on", "sandpaper")) threshold.device = measured_on(*on);
  threshold.quotes = quotes_of(reader);
  threshold.source = source_of(reader, "author, year");
  declarations.own_thresholds.push_back(std::move(threshold));
}

namespace {

const std::pair<const char*, Classified> classified_words[] = {{"surface", Classified::surface},
                                                               {"texture", Classified::texture},
                                                               {"size", Classified::size},
                                                               {"confidence", Classified::confidence},
                                                               {"layout", Classified::layout}};

/// Reads `classifies texture`: what the cases of a rule are classes of.
Classified classified_by(RecordReader& reader) {
  const auto* setting = reader.setting("classifies");
  if (!setting || setting->items.empty()) return Classified::none;
  const std::string name = words_of(setting->items[0]);
  std::vector<std::string> known;
  for (const auto& [word, classified] : classified_words) {
    if (name == word) return classified;
    known.emplace_back(word);
  }
  reader.report(Code::unknown_name, setting->span, fmt::format("nothing called `{}` is classified", name),
                did_you_mean(setting->items[0].span, name, known,
                             "write `surface`, `texture`, `size`, `confidence` or `layout`, or leave it out"));
  return Classified::none;
}

}  // namespace

void declare_rule(RecordReader& reader, Declarations& declarations) {
  const RecordDecl& record = reader.record;
  Rule rule{.name = std::string(record.name.text), .span = record.name.span, .exported = record.exported};
  rule.classified = classified_by(reader);
  for (const Setting* setting : reader.settings("case")) {
    Rule::Case each{.span = setting->span};
    for (const auto& item : setting->items) {
      const auto* label = item.value ? std::get_if<TextLiteral>(&reader.tree.expr(*item.value)) : nullptr;
      const std::string_view first = item.words.empty() ? "" : item.words[0].text;
      if (label && &item == &setting->items.front()) {
        each.label = label->text;
      } else if (first == "kind" && item.words.size() == 2) {
        each.kind = item.words[1].text;
      } else if (label && first == "says") {
        each.says = label->text;
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
  rule.quotes = quotes_of(reader);
  rule.source = source_of(reader, "author, year, section");
  declarations.own_rules.push_back(std::move(rule));
}

}  // namespace wale
