#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "compiler/modules/declare_evidence.hpp"

namespace wale {

namespace {

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

struct ProfileWord {
  std::string_view word;
  SurfaceProfile profile;
};
constexpr ProfileWord profile_words[] = {{"grating", SurfaceProfile::grating},
                                         {"noise", SurfaceProfile::noise},
                                         {"photograph", SurfaceProfile::photograph},
                                         {"bump", SurfaceProfile::bump}};

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
    map_.source = source_of(reader_, "author, year, figure");
    read_quantity();
    read_evidence();
    read_couples();
    read_law();
    read_validity();
    read_uncertainty();
    read_domain();
    map_.quotes = quotes_of(reader_);
    if (const auto* on = reader_.required("on", "sandpaper")) map_.device = measured_on(*on);
    return std::move(map_);
  }

 private:
  void read_uncertainty() {
    LawUncertainty& law = map_.uncertainty;
    const auto read = [&](const Setting* setting, float& figure, bool* assumed) {
      if (!setting) return;
      figure = static_cast<float>(reader_.quantity(*setting, 0, "number").value_or(0));
      if (assumed) *assumed = !setting->items.empty() && has_word(setting->items[0], "assumed");
      if (figure < 0)
        reader_.report(Code::value_out_of_range, setting->span, "a standard deviation is not negative",
                       "leave it out where it is not known");
    };
    read(reader_.required("scatter", "0.05"), law.scatter, &law.scatter_assumed);
    read(reader_.setting("slope_error"), law.slope_error, nullptr);
    read(reader_.setting("spread"), law.spread, &law.spread_assumed);
    read(reader_.setting("noise"), law.noise, &law.noise_assumed);
    const auto counted = [&](const char* key) {
      return static_cast<std::uint16_t>(std::clamp(whole_number(reader_, key), 0, 65535));
    };
    law.observers = counted("observers");
    law.stimuli = counted("stimuli");
  }

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
      const std::vector<std::string_view> words = plain_words(item);
      if (words.size() == 1 && words[0] == map_.from && item.value && item.range_end) {
        map_.valid_assumed = has_word(item, "assumed");
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

  /// `domain grating, one_dimensional, alone`: the stimuli that it was measured with.
  void read_domain() {
    const auto* domain = reader_.setting("domain");
    if (!domain) return;
    map_.domain.stated = true;
    for (const auto& item : domain->items) {
      const auto crest = condition_of(reader_, item);
      if (crest && crest->quantity == "crest" && crest->dimension == Dimension{} && item.range_end) {
        map_.domain.crest_low = static_cast<float>(crest->range.low);
        map_.domain.crest_high = static_cast<float>(crest->range.high);
        map_.domain.crest_assumed = crest->assumed;
        continue;
      }
      const std::string word = item.value ? "" : words_of(item);
      const auto* profile = std::ranges::find(profile_words, word, &ProfileWord::word);
      if (profile != std::end(profile_words))
        map_.domain.profiles |= static_cast<std::uint8_t>(profile->profile);
      else if (word == "one_dimensional" || word == "two_dimensional")
        map_.domain.dimensions = word == "one_dimensional" ? 1 : 2;
      else if (word == "alone")
        map_.domain.alone = true;
      else
        reader_.report(Code::wrong_type, item.span, fmt::format("expected a kind of stimulus, found `{}`", word),
                       "write `grating`, `noise`, `photograph` or `bump`; `one_dimensional` or `two_dimensional`; "
                       "`alone`, if nothing else pushed; `crest 1.2 .. 2.2`, the largest force over the effective one");
    }
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

}  // namespace wale
