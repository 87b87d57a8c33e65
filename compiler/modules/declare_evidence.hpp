#pragma once

#include <functional>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "compiler/modules/declare_records.hpp"

namespace wale {

// What maps, thresholds and rules state alike: how well their figures are known, under which conditions they were
// measured, and the passages that hold them.

/// The grade of that name, such as `published`; empty if there is none.
std::optional<Evidence> grade_named(std::string_view word);
/// All grades in words: "`measured`, `published`, … or `…`".
std::string grade_words();
/// Reads `evidence slope published, handle transferred`: the grade of each part goes to its entry in the list. Items
/// that are not grades are passed to `otherwise`, and reported if it does not accept them.
void read_grades(RecordReader& reader, const Setting& evidence,
                 const std::vector<std::pair<const char*, Evidence*>>& parts,
                 const std::function<bool(const SettingItem&)>& otherwise = {});

/// The words of an item before its value, without the mark `assumed`: "period above" of `assumed period above 7 mm`.
std::vector<std::string_view> plain_words(const SettingItem& item);
/// `0.7 mm .. 10 mm`, `above 1.1 N`, `below 2.5 mm`: the range of an item whose words after the quantity's name are
/// `side`. Empty if it is none; without `written` if its value cannot be read, which is reported.
std::optional<Condition> range_of(RecordReader& reader, const SettingItem& item,
                                  std::span<const std::string_view> side);
/// `period 0.7 mm .. 10 mm`, `amplitude above 1.1 N`, `assumed period below 2.5 mm`; empty if the item is none.
std::optional<Condition> condition_of(RecordReader& reader, const SettingItem& item);

/// Where the figures were published. A record without it is reported: "a map needs a source", with that example.
std::string source_of(RecordReader& reader, const char* example);
/// The passages of `quote "…", "…"`, as the author cut them.
std::vector<std::string> quotes_of(RecordReader& reader);
/// The device of `on sandpaper`; empty if the setting names none.
std::string measured_on(const Setting& on);
/// A setting's whole number, such as the number of observers; 0 if the setting is missing.
int whole_number(RecordReader& reader, const char* key);

}  // namespace wale
