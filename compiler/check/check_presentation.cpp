#include "compiler/check/check_presentation.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <set>
#include <string>

#include "compiler/modules/declare_records.hpp"

namespace wale {
namespace {

class PresentationChecker {
 public:
  PresentationChecker(const SyntaxTree& tree, const Surroundings& surroundings, CheckedModule& module)
      : tree_(tree), surroundings_(surroundings), module_(module), whole_(!surroundings.diagnostics.has_errors()) {}

  void check(const RecordDecl& record) {
    const std::string keyword(record.keyword.text);
    if (keyword != "movie" && keyword != "keys" && keyword != "groups") return;
    RecordReader reader(tree_, record, surroundings_.sources, surroundings_.declarations, surroundings_.diagnostics);
    const std::size_t errors_before = surroundings_.diagnostics.error_count();
    const auto [first, is_new] = declared_.emplace(std::pair(keyword, std::string(record.name.text)), record.name.span);
    if (!is_new)
      return reader.report(
          Code::declared_twice, record.name.span,
          fmt::format("there are two {} `{}`", keyword == "movie" ? "movies" : keyword, record.name.text),
          another_name(first->second));
    const auto keep = [&](auto& all, auto checked) {
      reader.report_keys();
      if (surroundings_.diagnostics.error_count() > errors_before) return;
      checked.named = {std::string(record.name.text), record.name.span};
      checked.statement = record.span;
      checked.documentation = record.documentation;
      all.push_back(std::move(checked));
    };
    if (keyword == "movie") keep(module_.movies, movie(reader));
    if (keyword == "keys") keep(module_.keys, keys(reader));
    if (keyword == "groups") keep(module_.groups, groups(reader));
  }

 private:
  CheckedMovie movie(RecordReader& reader) {
    CheckedMovie movie;
    const auto all = reader.settings("frames");
    if (all.empty()) reader.required("frames", "kitchen, workshop");
    for (const Setting* setting : all)
      for (const SettingItem& item : setting->items)
        if (const auto* word = only_word(item, reader, "a frame is the name of a workspace",
                                         "write, for example, `frames kitchen, workshop`"))
          if (find_workspace(*word, reader)) movie.frames.push_back({std::string(word->text), word->span});
    return movie;
  }

  CheckedKeys keys(RecordReader& reader) {
    CheckedKeys keys;
    keys.workspace = workspace_of(reader);
    keys.area = lengths(reader, reader.required("area", "80 mm, 80 mm"), true).value_or(keys.area);
    keys.at = lengths(reader, reader.setting("at"), false).value_or(keys.at);
    if (reader.setting("key")) keys.key = reader.positive("key", 0, "length", "25 mm");
    if (const Setting* labels = reader.setting("labels")) {
      const std::string said = labels->items.size() == 1 && !labels->items[0].value ? words_of(labels->items[0]) : "";
      if (said != "random" && said != "names")
        reader.report(Code::wrong_type, labels->span, "the labels of keys are `names` or `random` numbers",
                      "write `labels random` for three digits that are new before each sort");
      keys.numbered_at_random = said == "random";
    }
    return keys;
  }

  CheckedGroups groups(RecordReader& reader) {
    CheckedGroups groups;
    groups.workspace = workspace_of(reader);
    std::map<std::string_view, Span> sorted;
    const auto all = reader.settings("group");
    if (all.empty()) reader.required("group", "board, cloth, \"rough\"");
    for (const Setting* setting : all) {
      CheckedGroups::Group group;
      group.span = setting->span;
      for (const SettingItem& item : setting->items) {
        const auto* text = item.value ? std::get_if<TextLiteral>(&tree_.expr(*item.value)) : nullptr;
        if (text && item.words.empty() && group.says.empty()) {
          group.says = text->text;
          continue;
        }
        const auto* word = only_word(item, reader, "a group has names of patches, and a text in quotes",
                                     "write, for example, `group board, cloth, \"rough\"`");
        if (!word) continue;
        const auto [first, is_new] = sorted.emplace(word->text, word->span);
        if (!is_new)
          reader.report(Code::declared_twice, word->span, fmt::format("`{}` is in two groups", word->text),
                        Advice("leave it in one of them").see(first->second, "the first one"));
        else if (has_patch(groups.workspace.name, *word, reader))
          group.patches.push_back({std::string(word->text), word->span});
      }
      groups.groups.push_back(std::move(group));
    }
    return groups;
  }

  /// The name that is all of an item; null if it is something else, which is reported.
  static const Word* only_word(const SettingItem& item, RecordReader& reader, const char* rule, const char* example) {
    if (item.words.size() == 1 && !item.value && !item.equals && item.trailing.empty()) return &item.words.front();
    reader.report(Code::wrong_type, item.span, rule, example);
    return nullptr;
  }

  /// Reads `of kitchen`. An empty name after an error, which is reported.
  NamedThing workspace_of(RecordReader& reader) {
    const Setting* of = reader.required("of", "kitchen");
    if (!of) return {};
    const auto* word = of->items.size() == 1 ? only_word(of->items.front(), reader, "expected the name of a workspace",
                                                         "write, for example, `of kitchen`")
                                             : nullptr;
    if (of->items.size() != 1)
      reader.report(Code::wrong_type, of->span, "expected the name of one workspace",
                    "write, for example, `of kitchen`");
    if (!word || !find_workspace(*word, reader)) return {};
    return {std::string(word->text), word->span};
  }

  /// Whether the file has that workspace; if not, that is reported.
  bool find_workspace(const Word& word, RecordReader& reader) {
    const auto& known = surroundings_.declarations.workspaces;
    if (known.contains(word.text)) return true;
    reader.report(Code::unknown_name, word.span, fmt::format("this file has no workspace `{}`", word.text),
                  did_you_mean(word.span, word.text, known.spellings(),
                               fmt::format("declare it, as in `workspace {} {{ patch board = oak }}`", word.text)));
    return false;
  }

  /// Whether the workspace has that patch; if not, that is reported. Patches with errors are left out of a workspace.
  bool has_patch(const std::string& name, const Word& word, RecordReader& reader) {
    const CheckedWorkspace* workspace = module_.workspace(name);
    if (!workspace) return false;
    std::vector<std::string> known;
    for (const CheckedPatch& each : workspace->patches) known.push_back(each.name);
    if (std::ranges::find(known, word.text) != known.end() || !whole_) return true;
    reader.report(Code::unknown_name, word.span, fmt::format("`{}` has no patch `{}`", name, word.text),
                  did_you_mean(word.span, word.text, known, "name one of its patches"));
    return false;
  }

  /// Two lengths, m; nothing without the setting and after an error, which is reported.
  std::optional<std::array<double, 2>> lengths(RecordReader& reader, const Setting* setting, bool are_sides) {
    if (!setting) return std::nullopt;
    const std::string key(setting->key.text);
    if (setting->items.size() != 2) {
      reader.report(Code::wrong_type, setting->span, fmt::format("`{}` is two lengths", key),
                    fmt::format("write, for example, `{} 80 mm, 80 mm`", key));
      return std::nullopt;
    }
    std::array<double, 2> values{};
    for (std::size_t i = 0; i < 2; ++i) {
      const auto value = reader.quantity(*setting, i, "length");
      if (!value) return std::nullopt;
      if (are_sides && !(*value > 0))
        reader.report(Code::value_out_of_range, setting->items[i].span,
                      fmt::format("the sides of the `{}` must be greater than zero", key),
                      fmt::format("write, for example, `{} 80 mm, 80 mm`", key));
      values[i] = *value;
    }
    return values;
  }

  const SyntaxTree& tree_;
  const Surroundings& surroundings_;
  CheckedModule& module_;
  bool whole_;  ///< the file had no errors so far
  std::map<std::pair<std::string, std::string>, Span> declared_;
};

}  // namespace

void check_presentations(const SyntaxTree& tree, const Surroundings& surroundings, CheckedModule& module) {
  PresentationChecker checker(tree, surroundings, module);
  for (const Declaration& declaration : tree.declarations)
    if (const auto* record = std::get_if<RecordDecl>(&declaration)) checker.check(*record);
}

}  // namespace wale
