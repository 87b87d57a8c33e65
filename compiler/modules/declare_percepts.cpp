#include <fmt/format.h>

#include <algorithm>

#include "compiler/modules/declare_evidence.hpp"
#include "compiler/modules/representative.hpp"

namespace wale {

namespace {

const std::pair<const char*, Extractor> extractor_words[] = {{"lateral_force", Extractor::lateral_force},
                                                             {"opposing_force", Extractor::opposing_force},
                                                             {"damping", Extractor::damping},
                                                             {"stiffness", Extractor::stiffness},
                                                             {"wall_stiffness", Extractor::wall_stiffness},
                                                             {"wall_damping", Extractor::wall_damping},
                                                             {"inertia", Extractor::inertia},
                                                             {"vibration", Extractor::vibration},
                                                             {"steepness", Extractor::steepness},
                                                             {"periodicity", Extractor::periodicity}};

/// The dimension of a carrier, "lateral amplitude", from the declaration of the function's argument.
std::optional<Dimension> carrier_dimension(const Declarations& declarations, const std::vector<Word>& words) {
  if (words.size() != 2) return std::nullopt;
  const auto* function = declarations.functions.find(words[0].text);
  if (!function) return std::nullopt;
  for (const auto& formal : function->node->parameters)
    if (formal.name.text == words[1].text && formal.dimension)
      if (const auto known = function->home->dimension_named(formal.dimension->text)) return *known;
  return std::nullopt;
}

void read_carrier(RecordReader& reader, const SettingItem& item, Percept& percept) {
  percept.carrier = words_of(item);
  if (const auto dimension = carrier_dimension(reader.declarations, item.words))
    percept.carrier_dimension = *dimension;
  else
    reader.report(Code::unknown_name, item.span,
                  fmt::format("`{}` is not an argument of a force function", percept.carrier),
                  "name the function and its argument, as in `lateral amplitude`");
}

/// `one lateral amplitude 194 pu, period 10 mm on sandpaper`, or `one none`.
void read_reference(RecordReader& reader, const Setting& one, Percept& percept) {
  if (one.items.empty()) return;
  const SettingItem& item = one.items.front();
  if (words_of(item) == "none" && !item.value) return;
  percept.has_reference = true;
  if (one.on) percept.reference_device = one.on->text;
  const std::size_t errors_before = reader.diagnostics.error_count();
  const std::string carrier = percept.carrier;
  read_carrier(reader, item, percept);
  if (reader.diagnostics.error_count() > errors_before) return;
  if (!carrier.empty() && carrier != percept.carrier)
    reader.report(Code::wrong_type, item.span,
                  fmt::format("the reference stimulus is of `{}`, but the carrier is `{}`", percept.carrier, carrier),
                  "name the same function and argument in both");
  const auto size = item.value ? reader.value(*item.value, percept.carrier_dimension) : std::optional<double>(0.0);
  percept.one = size.value_or(0);
  if (size && !(*size > 0))
    reader.report(Code::value_out_of_range, item.span, "the reference stimulus has no size",
                  "give it one, as in `lateral amplitude 194 pu`");
}

/// `extractor lateral_force, period 0.7 mm .. 10 mm`.
void read_extractor(RecordReader& reader, const Setting& setting, Percept& percept) {
  for (const auto& item : setting.items) {
    if (words_of(item) == "period" && item.value && item.range_end) {
      const auto length = reader.declarations.dimension("length");
      percept.period = {reader.value(*item.value, length).value_or(0),
                        reader.value(*item.range_end, length).value_or(0)};
      if (!(percept.period.low >= 0 && percept.period.high > percept.period.low))
        reader.report(Code::value_out_of_range, item.span, "this band of periods is empty",
                      "write, for example, `period 0.7 mm .. 10 mm`");
      continue;
    }
    const auto found =
        std::ranges::find(extractor_words, words_of(item), [](const auto& entry) { return std::string(entry.first); });
    if (found != std::end(extractor_words)) {
      percept.extractor = found->second;
      continue;
    }
    std::vector<std::string> known;
    for (const auto& [word, extractor] : extractor_words) known.emplace_back(word);
    reader.report(Code::unknown_name, item.span, fmt::format("no extractor is called `{}`", words_of(item)),
                  did_you_mean(item.span, words_of(item), known, "schema/LANGUAGE.md lists them"));
  }
}

/// Reads `least_share 3 %, irregular assumed 10 %`. Without `irregular` both are the same.
void read_least_share(RecordReader& reader, const Setting& setting, Percept& percept) {
  for (const auto& item : setting.items) {
    const std::vector<std::string_view> words = plain_words(item);
    const bool irregular = words.size() == 1 && words[0] == "irregular";
    const auto share =
        item.value && (words.empty() || irregular) ? reader.value(*item.value, Dimension{}) : std::optional<double>();
    if (!share || !(*share >= 0 && *share < 1)) {
      reader.report(Code::value_out_of_range, item.span, "expected a share from 0 % to less than 100 %",
                    "write, for example, `least_share assumed 3 %, irregular assumed 10 %`");
      continue;
    }
    percept.least_irregular_share = *share;
    if (!irregular) percept.least_share = *share;
  }
}

/// Reads `exerts 0.25 m/s`: the factor that makes a carrier, here a viscosity, a force.
void read_exertion(RecordReader& reader, Percept& percept) {
  const Dimension force = reader.declarations.dimension("force");
  const Setting* setting = reader.setting("exerts");
  if (!setting) {
    percept.exerts = percept.carrier_dimension == force ? 1 : 0;
    return;
  }
  if (setting->items.size() != 1 || !setting->items[0].value) return;
  percept.exerts = reader.value(*setting->items[0].value, force / percept.carrier_dimension).value_or(0);
}

/// `words "rough", "coarse"`, or `words de "rau", "grob"` in another language, by its code.
void add_words(RecordReader& reader, const Setting& setting, std::vector<std::string>& words) {
  Setting texts = setting;
  if (!texts.items.empty() && texts.items.front().words.size() == 1 && texts.items.front().value) {
    const Word& language = texts.items.front().words.front();
    if (!is_language(language.text))
      reader.report(Code::wrong_type, language.span, fmt::format("`{}` is no language", language.text),
                    "write its code of two or three small letters (ISO 639): `de`, `fr`, `ja`");
    texts.items.front().words.clear();
  }
  for (std::string& word : reader.texts(texts)) words.push_back(std::move(word));
}

}  // namespace

void declare_percept(RecordReader& reader, Declarations& declarations) {
  const RecordDecl& record = reader.record;
  Percept percept{.name = std::string(record.name.text),
                  .documentation = std::string(record.documentation),
                  .span = record.name.span};
  if (const auto* other = declarations.percepts.entry(percept.name))
    return reader.reject(Code::declared_twice, record.name.span,
                         fmt::format("a percept `{}` is declared already", percept.name),
                         another_name(other->declared));
  if (const auto other = declarations.percept_named(percept.name); other.percept)
    return reader.reject(Code::declared_twice, record.name.span,
                         fmt::format("`{}` is the antonym of `{}` already", percept.name, other.percept->name),
                         another_name(other.percept->span));
  if (const auto* carrier = reader.setting("carrier"); carrier && !carrier->items.empty())
    read_carrier(reader, carrier->items.front(), percept);
  if (const auto* one = reader.required("one", "lateral amplitude 194 pu on sandpaper"))
    read_reference(reader, *one, percept);
  reader.setting("zero");
  if (const auto* absent = reader.setting("absent")) {
    percept.absent_is_unknown = absent->items.size() == 1 && words_of(absent->items.front()) == "unknown";
    if (!percept.absent_is_unknown)
      reader.report(Code::unknown_name, absent->span, "what is absent may be `unknown`, or else has the level 0",
                    "write `absent unknown`, or leave it out");
  }
  for (const Setting* words : reader.settings("words")) add_words(reader, *words, percept.words);
  if (const auto* antonym = reader.setting("antonym"); antonym && !antonym->items.empty()) {
    Setting texts = *antonym;
    percept.antonym = words_of(texts.items.front());
    if (!texts.items.front().value) texts.items.erase(texts.items.begin());
    for (std::string& word : reader.texts(texts)) percept.antonym_words.push_back(std::move(word));
    if (declarations.percept_named(percept.antonym).percept || percept.antonym.empty())
      reader.report(Code::declared_twice, antonym->span,
                    percept.antonym.empty() ? "an antonym needs a name"
                                            : fmt::format("`{}` names a percept already", percept.antonym),
                    "write, for example, `antonym smoothness \"smooth\"`");
  }
  for (const Setting* words : reader.settings("antonym_words")) add_words(reader, *words, percept.antonym_words);
  if (const auto* extractor = reader.setting("extractor")) read_extractor(reader, *extractor, percept);
  if (const auto* share = reader.setting("least_share")) read_least_share(reader, *share, percept);
  if (const auto* cue = reader.setting("cue"); cue && !cue->items.empty()) percept.cue = words_of(cue->items.front());
  read_exertion(reader, percept);
  if (const auto* threshold = reader.setting("near_threshold"))
    percept.near_threshold = reader.quantity(*threshold, 0, "number").value_or(0);
  declarations.percepts.add(percept.name, {.what = percept, .declared = record.name.span, .exported = record.exported});
}

void read_realisations(RecordReader& reader, const Declarations& declarations, const std::string& owner,
                       std::map<std::string, Realisation>& realise) {
  for (const Setting* setting : reader.settings("realise")) {
    const SettingItem& item = setting->items.front();
    Realisation realisation{.tree = &reader.tree, .home = &declarations, .owner = owner};
    bool good = item.words.size() == 1 && item.equals;
    for (std::size_t i = 1; i < setting->items.size(); ++i) {
      const SettingItem& further = setting->items[i];
      const std::string_view word = further.words.empty() ? "" : further.words[0].text;
      good = good && ((word == "by" && further.words.size() == 2) || (word == "active" && further.value) ||
                      (word == "rate" && further.equals) || (word == "period" && further.value));
      if (good && word == "by") realisation.by = further.words[1].text;
      if (good && word == "active")
        realisation.active_watt = reader.value(*further.value, declarations.dimension("power")).value_or(0);
      if (good && word == "rate") realisation.rate = *further.equals;
      if (good && word == "period")
        realisation.period = reader.value(*further.value, declarations.dimension("length")).value_or(0);
    }
    good = good && (realisation.rate || realisation.period == 0);
    if (!good) {
      reader.report(Code::wrong_type, setting->span,
                    "a realisation must give a force for a percept, or the shaking of a pad",
                    "write, for example, `realise roughness = lateral(grating(x, period: 2.5 mm))`, followed by "
                    "`, by NAME` to choose a map; for a pad `realise vibration = shaking, rate = 120 Hz`");
      continue;
    }
    realisation.force = *item.equals;
    const std::string name(item.words[0].text);
    if (!declarations.percepts.contains(name))
      reader.report(Code::unknown_name, item.words[0].span, fmt::format("nothing declares a percept `{}`", name),
                    did_you_mean(item.words[0].span, name, declarations.percepts.spellings(),
                                 "declare it, as in schema/percepts.wale"));
    realise[name] = realisation;
  }
}

void declare_class(RecordReader& reader, Declarations& declarations) {
  const RecordDecl& record = reader.record;
  DeviceClass of_devices{.name = std::string(record.name.text),
                         .documentation = std::string(record.documentation),
                         .span = record.name.span};
  if (const auto* other = declarations.classes.entry(of_devices.name))
    return reader.reject(Code::declared_twice, record.name.span,
                         fmt::format("a class of devices `{}` is declared already", of_devices.name),
                         another_name(other->declared));
  read_realisations(reader, declarations, of_devices.name, of_devices.realise);
  declarations.classes.add(record.name.text,
                           {.what = of_devices, .declared = record.name.span, .exported = record.exported});
}

}  // namespace wale
