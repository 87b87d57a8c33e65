#include "library/survey/changes.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <map>
#include <nlohmann/json.hpp>
#include <set>

#include "compiler/describe/describe_figure.hpp"
#include "compiler/text/readable.hpp"

namespace wale {
namespace {

const CueFacts& facts_of(CueKind kind) { return cue_table()[static_cast<std::size_t>(kind)]; }

std::vector<std::string> words_changed(const Entry& a, const Entry& b) {
  std::vector<std::string> words;
  const auto note = [&](bool differs, const char* what) {
    if (differs) words.emplace_back(what);
  };
  note(a.title != b.title, "title"), note(a.kind != b.kind, "kind"), note(a.names != b.names, "names");
  note(a.licence != b.licence, "licence"), note(a.sources != b.sources, "sources");
  note(a.documentation != b.documentation, "documentation");
  const auto asked = [](const Entry& entry) {
    std::map<std::string, std::optional<double>> levels;
    for (const EntryPercept& each : entry.felt.percepts)
      if (each.asked) levels[each.name] = each.asked;
    return levels;
  };
  note(asked(a) != asked(b), "levels asked for");
  return words;
}

ChangedMaterial change_of(const Entry& a, const Entry& b, const Comparer& comparer) {
  ChangedMaterial change;
  change.name = a.name, change.words = words_changed(a, b);
  if (a.felt.cues && b.felt.cues) {
    change.comparison = comparer.compare(*a.felt.cues, *b.felt.cues);
    // What nobody could notice, such as the last bits of a spectrum, is no change.
    constexpr double least = 0.05;  // just noticeable differences
    std::erase_if(change.comparison.cues, [](const CueDifference& cue) {
      return cue.a == cue.b || (cue.noticeable && *cue.noticeable < least);
    });
    if (const CueDifference* plainest = change.comparison.plainest())
      change.noticeable = plainest->noticeable.value_or(0);
  } else if (a.program.empty() || b.program.empty()) {
    change.trouble = a.program.empty() ? "the old one cannot be built: " + a.trouble
                                       : "the new one cannot be built: " + b.trouble;
  } else {
    change.trouble = "it only vibrates, and materials are compared by their forces";
  }
  return change;
}

/// Whether the hand or the eye finds something changed.
bool differs(const ChangedMaterial& change) {
  return !change.comparison.cues.empty() || !change.words.empty() || !change.trouble.empty();
}

std::string noticeable_text(const std::optional<double>& noticeable) {
  if (!noticeable) return "unknown";
  return *noticeable > 20 ? "more than 20" : readable("{:.1f}", *noticeable);
}

const char* verdict_word(const ChangedMaterial& change) {
  if (!change.trouble.empty()) return "not compared";
  if (change.comparison.cues.empty()) return "the same to the hand";
  switch (change.comparison.verdict) {
    case Verdict::apart: return "plainly different";
    case Verdict::alike: return "hardly told apart";
    case Verdict::unknown: break;
  }
  return "differs in cues that have no known threshold";
}

std::string cue_value(CueKind kind, const std::optional<double>& value) {
  if (!value) return "none";
  const std::string unit = facts_of(kind).unit;
  if (unit == "m") return with_digits(1e3 * *value, 3) + " mm";
  return with_digits(*value, 3) + (unit.empty() ? "" : " " + unit);
}

std::string change_text(const ChangedMaterial& change) {
  std::string text = verdict_word(change);
  if (!change.trouble.empty()) text += ": " + change.trouble;
  if (!change.words.empty()) text += fmt::format("; also changed: {}", fmt::join(change.words, ", "));
  text += "\n";
  for (const CueDifference& cue : change.comparison.cues)
    text += readable("    {:<22} {} -> {}, {} noticeable differences\n", facts_of(cue.kind).name,
                     cue_value(cue.kind, cue.a), cue_value(cue.kind, cue.b), noticeable_text(cue.noticeable));
  return text;
}

nlohmann::ordered_json change_json(const ChangedMaterial& change) {
  using Json = nlohmann::ordered_json;
  const auto value = [](const std::optional<double>& each) { return each ? Json(*each) : Json(nullptr); };
  Json cues = Json::object();
  for (const CueDifference& cue : change.comparison.cues)
    cues[facts_of(cue.kind).name] = {{"old", value(cue.a)},
                                     {"new", value(cue.b)},
                                     {"unit", facts_of(cue.kind).unit},
                                     {"noticeable", value(cue.noticeable)}};
  return {{"verdict", verdict_word(change)},
          {"noticeable", change.noticeable},
          {"cues", std::move(cues)},
          {"words", change.words},
          {"trouble", change.trouble.empty() ? Json(nullptr) : Json(change.trouble)}};
}

}  // namespace

bool LibraryChanges::keeps_promises() const {
  return removed.empty() && ambiguous.empty() && unbuilt.empty() && std::ranges::none_of(changed, [](const ChangedMaterial& each) {
           return !each.comparison.cues.empty() && each.comparison.verdict == Verdict::apart;
         });
}

LibraryChanges changes_between(const std::vector<Entry>& before, const std::vector<Entry>& after,
                               const Comparer& comparer) {
  LibraryChanges changes;
  std::map<std::string, const Entry*> now;
  std::map<std::string, std::vector<const Entry*>> heirs;
  std::set<std::string> known, succeeds;
  for (const Entry& each : after) {
    now.emplace(each.name, &each);
    for (const std::string& old : each.replaces) heirs[old].push_back(&each);
    if (!each.trouble.empty()) changes.unbuilt.push_back({each.name, each.trouble});
  }
  for (const Entry& old : before) {
    if (!known.insert(old.name).second) continue;  // a name that two files have
    changes.device = old.device;
    if (const auto found = now.find(old.name); found != now.end()) {
      ChangedMaterial change = change_of(old, *found->second, comparer);
      if (differs(change))
        changes.changed.push_back(std::move(change));
      else
        ++changes.same;
    } else if (const auto heir = heirs.find(old.name); heir != heirs.end()) {
      for (const Entry* each : heir->second) succeeds.insert(each->name);
      if (heir->second.size() > 1) {
        auto& all = changes.ambiguous.emplace_back(LibraryChanges::Ambiguous{.old_name = old.name, .heirs = {}});
        for (const Entry* each : heir->second) all.heirs.push_back(each->name);
        continue;
      }
      const Entry& only = *heir->second.front();
      changes.superseded.push_back({old.name, only.name, change_of(old, only, comparer)});
    } else {
      changes.removed.push_back(old.name);
    }
  }
  for (const auto& [name, entry] : now)
    if (!known.contains(name) && !succeeds.contains(name)) changes.added.push_back(name);
  if (changes.device.empty() && !after.empty()) changes.device = after.front().device;
  std::ranges::sort(changes.removed);
  std::ranges::stable_sort(changes.changed, std::greater<>(), &ChangedMaterial::noticeable);
  return changes;
}

std::string changes_text(const LibraryChanges& changes) {
  std::string text;
  const auto list = [&](const char* what, const std::vector<std::string>& names) {
    if (!names.empty()) text += fmt::format("{}: {}\n", what, fmt::join(names, ", "));
  };
  list("added", changes.added);
  list("removed, and nothing replaces it", changes.removed);
  for (const LibraryChanges::Ambiguous& each : changes.ambiguous)
    text += fmt::format("{} is replaced by several, so that its name means none: {}\n", each.old_name, fmt::join(each.heirs, ", "));
  const std::set<std::string> added(changes.added.begin(), changes.added.end());  // of others it is told below
  for (const LibraryChanges::Unbuilt& each : changes.unbuilt)
    if (added.contains(each.name)) text += fmt::format("{} of the new version cannot be built: {}\n", each.name, each.why);
  for (const SupersededMaterial& each : changes.superseded)
    text += fmt::format("{} is now {}: {}", each.old_name, each.new_name, change_text(each.change));
  for (const ChangedMaterial& each : changes.changed) text += fmt::format("{}: {}", each.name, change_text(each));
  return text + readable("on {}: {} added, {} removed, {} superseded, {} changed, {} the same\n", changes.device,
                         changes.added.size(), changes.removed.size(), changes.superseded.size(),
                         changes.changed.size(), changes.same);
}

std::string changes_json(const LibraryChanges& changes) {
  using Json = nlohmann::ordered_json;
  Json superseded = Json::array(), changed = Json::object(), ambiguous = Json::object(), unbuilt = Json::object();
  for (const LibraryChanges::Ambiguous& each : changes.ambiguous) ambiguous[each.old_name] = each.heirs;
  for (const LibraryChanges::Unbuilt& each : changes.unbuilt) unbuilt[each.name] = each.why;
  for (const SupersededMaterial& each : changes.superseded) {
    Json one = {{"old", each.old_name}, {"new", each.new_name}};
    one.update(change_json(each.change));
    superseded.push_back(std::move(one));
  }
  for (const ChangedMaterial& each : changes.changed) changed[each.name] = change_json(each);
  const Json json = {{"device", changes.device},     {"added", changes.added},
                     {"removed", changes.removed},   {"superseded", std::move(superseded)},
                     {"changed", std::move(changed)}, {"ambiguous", std::move(ambiguous)},
                     {"unbuilt", std::move(unbuilt)}, {"same", changes.same},
                     {"keeps_promises", changes.keeps_promises()}};
  return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

}  // namespace wale
