#include "compiler/modules/declare_evidence.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>

namespace wale {

namespace {

const std::pair<const char*, Evidence> evidence_words[] = {{"measured", Evidence::measured},
                                                           {"published", Evidence::published},
                                                           {"estimated", Evidence::estimated},
                                                           {"recalled", Evidence::recalled},
                                                           {"transferred", Evidence::transferred},
                                                           {"simulated", Evidence::simulated}};

}  // namespace

std::optional<Evidence> grade_named(std::string_view word) {
  for (const auto& [name, evidence] : evidence_words)
    if (word == name) return evidence;
  return std::nullopt;
}

std::string grade_words() {
  std::vector<std::string> words;
  for (const auto& [name, evidence] : evidence_words) words.push_back(fmt::format("`{}`", name));
  const std::string last = words.back();
  words.pop_back();
  return fmt::format("{} or {}", fmt::join(words, ", "), last);
}

std::vector<std::string_view> plain_words(const SettingItem& item) {
  std::vector<std::string_view> words;
  for (const Word& word : item.words)
    if (word.text != "assumed") words.push_back(word.text);
  return words;
}

std::string source_of(RecordReader& reader, const char* example) {
  if (!reader.setting("source"))
    reader.report(Code::missing_setting, reader.record.name.span,
                  fmt::format("a {} needs a source", reader.record.keyword.text),
                  fmt::format("add `source \"{}\"`", example));
  return reader.text("source");
}

std::vector<std::string> quotes_of(RecordReader& reader) {
  const Setting* quote = reader.setting("quote");
  return quote ? reader.texts(*quote) : std::vector<std::string>();
}

std::string measured_on(const Setting& on) {
  return on.on ? std::string(on.on->text) : on.items.empty() ? "" : words_of(on.items[0]);
}

void read_grades(RecordReader& reader, const Setting& evidence,
                 const std::vector<std::pair<const char*, Evidence*>>& parts,
                 const std::function<bool(const SettingItem&)>& otherwise) {
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

int whole_number(RecordReader& reader, const char* key) {
  const Setting* setting = reader.setting(key);
  return setting ? static_cast<int>(std::lround(reader.quantity(*setting, 0, "number").value_or(0))) : 0;
}

std::optional<Condition> range_of(RecordReader& reader, const SettingItem& item,
                                  std::span<const std::string_view> side) {
  const std::string_view bound = side.size() == 1 ? side[0] : "";
  const bool one_sided = !item.range_end && (bound == "above" || bound == "below");
  if (!item.value || !(one_sided || (item.range_end && side.empty()))) return std::nullopt;
  Condition condition;
  const auto first = reader.constant(*item.value);
  if (!first) return condition;
  const Span value = reader.tree.span(*item.value), end = item.range_end ? reader.tree.span(*item.range_end) : value;
  condition.written =
      fmt::format("{}{}{}", bound, one_sided ? " " : "", reader.sources.text({value.source, value.begin, end.end}));
  condition.assumed = has_word(item, "assumed");
  condition.dimension = first->dimension;
  // "10 mm": the number, and the unit in which people read it.
  const std::string last(reader.sources.text(item.range_end ? end : value));
  char* rest = nullptr;
  const double number = std::strtod(last.c_str(), &rest);
  const double worth = item.range_end ? reader.value(*item.range_end, first->dimension).value_or(0) : first->value;
  condition.unit = rest;
  condition.unit.erase(0, condition.unit.find_first_not_of(' '));
  if (number > 0 && worth > 0)
    condition.unit_in_si = worth / number;
  else
    condition.unit.clear();
  if (item.range_end)
    condition.range = {first->value, reader.value(*item.range_end, first->dimension).value_or(first->value)};
  if (condition.range.low > condition.range.high)
    reader.report(Code::value_out_of_range, {value.source, value.begin, end.end},
                  fmt::format("the range `{}` begins above its end, so nothing lies in it", condition.written),
                  "write the smaller value first");
  if (item.range_end) return condition;
  if (bound == "above")
    condition.range.low = std::nextafter(first->value, HUGE_VAL);
  else
    condition.range = {-HUGE_VAL, std::nextafter(first->value, -HUGE_VAL)};
  return condition;
}

std::optional<Condition> condition_of(RecordReader& reader, const SettingItem& item) {
  const std::vector<std::string_view> words = plain_words(item);
  if (words.empty()) return std::nullopt;
  auto condition = range_of(reader, item, std::span(words).subspan(1));
  if (condition) condition->quantity = words[0];
  return condition;
}

}  // namespace wale
