#include "compiler/modules/declare_records.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

namespace wale {

namespace {

const std::pair<const char*, Evidence> evidence_words[] = {{"measured", Evidence::measured},
                                                           {"published", Evidence::published},
                                                           {"estimated", Evidence::estimated},
                                                           {"recalled", Evidence::recalled},
                                                           {"transferred", Evidence::transferred}};

/// "lateral amplitude" of `lateral amplitude 194 pu`.
std::string joined(const std::vector<Word>& words) {
  std::string text;
  for (const auto& word : words) text += (text.empty() ? "" : " ") + word.text;
  return text;
}

/// Whether an item holds a word, before its value or behind it.
bool has_word(const SettingItem& item, std::string_view word) {
  return std::ranges::find(item.words, word, &Word::text) != item.words.end() ||
         std::ranges::find(item.trailing, word, &Word::text) != item.trailing.end();
}

/// The dimension of a carrier, "lateral amplitude", from the declaration of the function's argument.
std::optional<Dimension> carrier_dimension(const Declarations& declarations, const SettingItem& item) {
  if (item.words.size() != 2) return std::nullopt;
  const auto* function = declarations.functions.find(item.words[0].text);
  if (!function) return std::nullopt;
  for (const auto& formal : function->node->parameters)
    if (formal.name.text == item.words[1].text && formal.dimension)
      if (const auto* known = function->home->dimensions.find(formal.dimension->text)) return *known;
  return std::nullopt;
}

template <typename Entry>
Advice another_name(const Entry& other) {
  return Advice("give one of them another name").see(other.declared, "declared here first");
}

}  // namespace

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
  if (!found)
    report(Code::missing_setting, record.name.span,
           fmt::format("the {} `{}` lacks `{}`", record.keyword.text, record.name.text, key),
           fmt::format("add `{} {}`", key, example));
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
    report(Code::value_out_of_range, found->items[index].span, fmt::format("`{}` must be more than nothing", key),
           fmt::format("write, for example, `{} {}`", key, example));
    return 0;
  }
  return known.value_or(0);
}

std::string RecordReader::text(const std::string& key) {
  const Setting* found = setting(key);
  if (!found) return {};
  if (found->items.size() == 1 && found->items[0].value)
    if (const auto* literal = std::get_if<TextLiteral>(&tree.expr(*found->items[0].value))) return literal->text;
  report(Code::wrong_type, found->span, fmt::format("`{}` is a text", key), fmt::format("write `{} \"…\"`", key));
  return {};
}

void RecordReader::reject(Code code, Span span, std::string message, Advice advice) {
  report(code, span, std::move(message), std::move(advice));
  rejected_ = true;
}

void RecordReader::report_unknown_settings() {
  if (rejected_) return;
  for (const auto& setting : record.settings) {
    if (read_.contains(&setting)) continue;
    report(Code::unknown_setting, setting.key.span,
           fmt::format("a {} has no setting `{}`", record.keyword.text, setting.key.text),
           did_you_mean(setting.key.span, setting.key.text, {asked_.begin(), asked_.end()},
                        fmt::format("it has: {}", fmt::join(asked_, ", "))));
  }
}

void declare_percept(RecordReader& reader, Declarations& declarations) {
  const RecordDecl& record = reader.record;
  Percept percept{.name = record.name.text, .documentation = record.documentation, .span = record.name.span};
  if (const auto* other = declarations.percepts.entry(percept.name))
    return reader.reject(Code::declared_twice, record.name.span,
                         fmt::format("a percept `{}` is declared already", percept.name), another_name(*other));
  if (const auto* one = reader.required("one", "lateral amplitude 194 pu on sandpaper"); one && !one->items.empty()) {
    const SettingItem& item = one->items.front();
    percept.carrier = joined(item.words);
    if (one->on) percept.reference_device = one->on->text;
    const auto dimension = carrier_dimension(declarations, item);
    if (!dimension) {
      reader.report(Code::unknown_name, item.span,
                    fmt::format("`{}` is not an argument of a force function", percept.carrier),
                    "name the function and its argument, as in `lateral amplitude`");
    } else {
      percept.carrier_dimension = *dimension;
      const auto size = item.value ? reader.value(*item.value, *dimension) : std::optional<double>(0.0);
      percept.one = size.value_or(0);
      if (size && !(*size > 0))
        reader.report(Code::value_out_of_range, item.span, "the reference stimulus has no size",
                      "give it one, as in `lateral amplitude 194 pu`");
    }
  }
  reader.setting("zero");
  reader.setting("words");
  if (const auto* threshold = reader.setting("near_threshold"))
    percept.near_threshold = reader.quantity(*threshold, 0, "number").value_or(0);
  declarations.percepts.add(percept.name, {.what = percept, .declared = record.name.span, .exported = record.exported});
}

void declare_map(RecordReader& reader, Declarations& declarations) {
  const RecordDecl& record = reader.record;
  const Percept* percept = declarations.percepts.find(record.name.text);
  if (!percept)
    return reader.reject(Code::unknown_name, record.name.span,
                         fmt::format("nothing declares a percept `{}`", record.name.text),
                         did_you_mean(record.name.span, record.name.text, declarations.percepts.spellings(),
                                      "declare it, as in schema/percepts.wale"));
  Map map{.percept = record.name.text, .from = record.from ? record.from->text : "", .span = record.name.span};
  map.exported = record.exported;
  if (!percept->carrier.ends_with(" " + map.from))
    reader.report(Code::unknown_name, record.from ? record.from->span : record.name.span,
                  fmt::format("`{}` is carried by its `{}`, not by `{}`", map.percept, percept->carrier, map.from),
                  Advice(fmt::format("write `map {} from {}`", map.percept,
                                     percept->carrier.substr(percept->carrier.find(' ') + 1)))
                      .see(percept->span, "declared here"));

  const auto* law = reader.required("law", "log10(magnitude) = …");
  const SettingItem* equation = law && law->items.size() == 1 && law->items[0].equals ? &law->items[0] : nullptr;
  // In `law magnitude = …` the parser takes the lone name before `=` for a word.
  const Word* lone = equation && !equation->value && equation->words.size() == 1 ? &equation->words[0] : nullptr;
  if (equation && (equation->value || lone)) {
    std::vector<HeightTable> tables;
    const std::size_t errors_before = reader.diagnostics.error_count();
    ExpressionChecker checker({reader.sources, declarations, reader.diagnostics}, map.terms, tables);
    Scope scope;
    scope.declare("magnitude", {.type = Value::Type::number, .x = map.terms.add({.kind = TermKind::magnitude})},
                  law->span);
    scope.declare(map.from,
                  {.type = Value::Type::number,
                   .x = map.terms.add({.kind = TermKind::carrier}),
                   .dimension = percept->carrier_dimension},
                  law->span);
    const Value left = lone ? checker.named(*lone, scope) : checker.check(reader.tree, *equation->value, scope);
    if (!left.failed()) {
      const Value right = checker.check_as(reader.tree, *equation->equals, scope, Value::Type::number, left.dimension);
      map.left = left.x;
      map.right = right.x;
    }
    const bool read = reader.diagnostics.error_count() == errors_before;
    for (const auto& name : scope.spellings())
      if (read && !scope.at(name).used)
        reader.report(Code::unsolvable_law, law->span, fmt::format("the law does not speak of `{}`", name),
                      "tie the magnitude to the carrier");
  } else if (law) {
    reader.report(Code::wrong_type, law->span, "a law is an equation",
                  fmt::format("write `law log10(magnitude) = …` in `magnitude` and `{}`", map.from));
  }

  if (const auto* valid = reader.required("valid", map.from + " … .. …")) {
    for (const auto& item : valid->items) {
      map.validity.emplace_back(reader.sources.text(item.span));
      if (joined(item.words) != map.from) continue;
      if (item.value) map.valid_low = reader.value(*item.value, percept->carrier_dimension).value_or(0);
      if (item.range_end) map.valid_high = reader.value(*item.range_end, percept->carrier_dimension).value_or(0);
    }
    if (!(map.valid_low > 0 && map.valid_high > map.valid_low))
      reader.report(Code::value_out_of_range, valid->span,
                    fmt::format("the range of `{}` is empty or missing", map.from),
                    fmt::format("write, for example, `valid {} 9 pu .. 194 pu`", map.from));
  }
  if (const auto* scatter = reader.required("scatter", "0.05"))
    map.scatter = reader.quantity(*scatter, 0, "number").value_or(0);
  if (const auto* evidence = reader.required("evidence", "slope measured, anchor measured, handle measured")) {
    for (const auto& item : evidence->items) {
      const auto grade = item.words.size() == 2
                             ? std::ranges::find(evidence_words, item.words[1].text,
                                                 [](auto& entry) { return std::string(entry.first); })
                             : std::end(evidence_words);
      Evidence* part = item.words.empty()               ? nullptr
                       : item.words[0].text == "slope"  ? &map.slope
                       : item.words[0].text == "anchor" ? &map.anchor
                       : item.words[0].text == "handle" ? &map.handle
                                                        : nullptr;
      if (grade == std::end(evidence_words) || !part)
        reader.report(Code::wrong_type, item.span, "evidence is graded apart for slope, anchor and handle",
                      "write `slope`, `anchor` or `handle`, then `measured`, `published`, `estimated`, `recalled` or "
                      "`transferred`");
      else
        *part = grade->second;
    }
  }
  if (const auto* on = reader.required("on", "sandpaper")) {
    if (on->on)
      map.device = on->on->text;
    else if (on->items.size() == 1)
      map.device = joined(on->items[0].words);
  }
  map.source = reader.text("source");
  if (!reader.setting("source"))
    reader.report(Code::missing_setting, record.name.span, "a map without a source is a rumour",
                  "add `source \"author, year, figure\"`");
  declarations.own_maps.push_back(std::move(map));
}

void declare_device(RecordReader& reader, Declarations& declarations) {
  const RecordDecl& record = reader.record;
  DeviceDeclaration device{.documentation = record.documentation, .span = record.name.span};
  DeviceProfile& profile = device.profile;
  profile.name = record.name.text;
  if (const auto* other = declarations.devices.entry(profile.name))
    return reader.reject(Code::declared_twice, record.name.span,
                         fmt::format("a device `{}` is declared already", profile.name), another_name(*other));

  if (const auto* workspace = reader.required("workspace", "disc(228.6 mm)"); workspace && !workspace->items.empty()) {
    const auto* call =
        workspace->items[0].value ? std::get_if<Call>(&reader.tree.expr(*workspace->items[0].value)) : nullptr;
    if (call && call->callee.text == "disc" && call->arguments.size() == 1)
      profile.workspace_diameter = reader.value(call->arguments[0].value, declarations.dimension("length")).value_or(0);
    if (!(profile.workspace_diameter > 0))
      reader.report(Code::wrong_type, workspace->span, "a workspace is a disc of some diameter",
                    "write, for example, `workspace disc(228.6 mm)`");
  }
  profile.position_counts = reader.positive("position", 0, "number", "4096 counts");
  profile.force_newton = reader.positive("force", 0, "force", "10 N, 2048 counts");
  if (const auto* force = reader.setting("force"))
    profile.force_counts = reader.quantity(*force, 1, "number").value_or(0);
  profile.rate = reader.positive("rate", 0, "frequency", "900 Hz");
  profile.speed_limit = reader.positive("speed", 0, "velocity", "1 m/s");
  profile.slew = reader.positive("slew", 0, "slew", "200 N/s");
  if (const auto* filter = reader.required("velocity_filter", "15, 1 counts")) {
    profile.velocity_window = reader.quantity(*filter, 0, "number").value_or(0);
    profile.velocity_noise_counts = reader.quantity(*filter, 1, "number").value_or(0);
  }
  if (const auto* patch = reader.required("patch", "160 mm, 160 mm, 5 mm")) {
    profile.patch_width = reader.quantity(*patch, 0, "length").value_or(0);
    profile.patch_height = reader.quantity(*patch, 1, "length").value_or(0);
    profile.patch_rim = reader.quantity(*patch, 2, "length").value_or(0);
  }
  const auto optional = [&](const char* key, const char* dimension, double& figure) {
    if (const auto* found = reader.setting(key)) figure = reader.quantity(*found, 0, dimension).value_or(0);
  };
  optional("mass", "mass", profile.mass);
  optional("damping", "viscosity", profile.damping);
  optional("friction", "force", profile.friction);
  // One value for both axes, or one for each.
  const auto per_axis = [&](const char* key, const char* dimension, double& x, double& y) {
    const auto* found = reader.setting(key);
    if (found == nullptr) return;
    x = reader.quantity(*found, 0, dimension).value_or(0);
    y = found->items.size() > 1 ? reader.quantity(*found, 1, dimension).value_or(0) : x;
    if (x < 0 || y < 0)
      reader.report(Code::value_out_of_range, found->span, fmt::format("`{}` is not less than nothing", key),
                    fmt::format("leave out the `-`, or `{}` where nobody knows it", key));
  };
  per_axis("delay", "time", profile.delay_x, profile.delay_y);
  per_axis("bandwidth", "frequency", profile.bandwidth_x, profile.bandwidth_y);
  for (const auto& setting : record.settings)
    for (const auto& item : setting.items)
      if (has_word(item, "assumed")) device.assumed.push_back(setting.key.text);
  const auto known = [&](const char* key) {
    return reader.setting(key) && std::ranges::find(device.assumed, key) == device.assumed.end();
  };
  profile.damping_known = known("damping");
  profile.friction_known = known("friction");
  for (const Setting* setting : reader.settings("realise"))
    for (const auto& item : setting->items) {
      if (item.words.size() == 1 && item.equals)
        device.realise[item.words[0].text] = {&reader.tree, *item.equals, &declarations};
      else
        reader.report(Code::wrong_type, item.span, "a realisation is a force for a percept",
                      "write, for example, `realise roughness = lateral(grating(x, period: 2.5 mm))`");
    }
  device.source = reader.text("source");
  const std::string name = profile.name;
  declarations.devices.add(name,
                           {.what = std::move(device), .declared = record.name.span, .exported = record.exported});
}

void declare_levels(RecordReader& reader, Declarations& declarations) {
  Levels levels{.percept = reader.record.name.text, .levels = {}, .span = reader.record.name.span};
  levels.exported = reader.record.exported;
  if (!declarations.percepts.contains(levels.percept))
    reader.report(Code::unknown_name, levels.span, fmt::format("nothing declares a percept `{}`", levels.percept),
                  did_you_mean(levels.span, levels.percept, declarations.percepts.spellings(),
                               "declare it, as in schema/percepts.wale"));
  for (const auto& setting : reader.record.settings) {
    reader.setting(setting.key.text);  // every key is a name of the author's
    const auto value = reader.quantity(setting, 0, "number");
    if (!value) continue;
    if (!(*value >= 0 && *value <= 1))
      reader.report(Code::level_out_of_range, setting.span,
                    fmt::format("the level `{}` is outside 0 .. 1", setting.key.text),
                    Advice("1 is the percept's reference stimulus").fact("low", 0).fact("high", 1));
    else
      levels.levels.push_back({setting.key.text, *value, setting.key.span});
  }
  declarations.own_levels.push_back(std::move(levels));
}

void declare_hand(RecordReader& reader, Declarations& declarations) {
  const RecordDecl& record = reader.record;
  HandDeclaration hand{.name = record.name.text, .span = record.name.span};
  if (const auto* other = declarations.hands.entry(hand.name))
    return reader.reject(Code::declared_twice, record.name.span,
                         fmt::format("a hand `{}` is declared already", hand.name), another_name(*other));
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
