#include "library/review/words.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <set>

#include "compiler/diagnostics/advice.hpp"
#include "compiler/modules/representative.hpp"
#include "library/licence/licence.hpp"
#include "library/review/report.hpp"
#include "schema/visible_text.hpp"

namespace wale {
namespace {

bool is_blank(std::string_view text) { return text.find_first_not_of(" \t") == std::string_view::npos; }

std::string without_case(std::string text) {
  for (char& c : text)
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  return text;
}

/// Whether the map of a level is simulated: the one that is named, or, without a name, each one of the percept.
bool rests_on_simulation(const AskedPercept& asked, const Declarations& declarations) {
  bool simulated = false, felt = false;
  declarations.each_map([&](const Map& map) {
    if (map.percept != asked.name || (!asked.by.empty() && map.name != asked.by)) return;
    (map.simulated() ? simulated : felt) = true;
  });
  return simulated && (!felt || !asked.by.empty());
}

}  // namespace

std::string branch_of(std::string_view kind) { return std::string(kind.substr(0, kind.find('.'))); }

MaterialWords tell_words(ReviewedMaterial& material, const MaterialDecl& node, const SyntaxTree& tree, bool is_apart,
                         Diagnostics& diagnostics) {
  MaterialWords words;
  std::set<std::string, std::less<>> has;
  std::set<std::string> english, foreign;  // names
  Span licence_at = node.name.span;
  Diagnostics again;
  for (const Setting& setting : node.representative) {
    if (!is_representative_setting(setting.key.text) || setting.key.text == "like") continue;
    RepresentativeEntry said = representative_entry(setting, tree, again);
    // A licence that says nothing is not that of the library.
    if (said.key == "licence" && std::ranges::all_of(said.values, is_blank)) material.licence.clear();
    std::erase_if(said.values, is_blank);
    if (said.values.empty()) continue;
    has.insert(std::string(setting.key.text));
    const bool in_english = language_of(setting).empty() || language_of(setting) == "en";
    if (setting.key.text == "title" || setting.key.text == "called")
      for (const std::string& each : said.values) (in_english ? english : foreign).insert(without_case(each));
    if (said.key == "title") material.title = said.values.front();
    if (said.key == "kind") material.kind = said.values.front();
    if (said.key == "licence") material.licence = said.values.front(), licence_at = setting.span;
    if (said.key == "replaces") words.replaces = said.values;
    if (setting.key.text == "title" || setting.key.text == "called")
      words.names.insert(words.names.end(), said.values.begin(), said.values.end());
  }
  const auto lacks = [&](const char* what, std::string help) {
    if (is_apart) return;
    report(diagnostics, Code::incomplete_material, node.name.span, fmt::format("`{}` has no {}", material.name, what),
           std::move(help));
  };
  if (!has.contains("title")) lacks("title", "write `title \"…\"` in its representative block");
  if (!has.contains("kind")) lacks("kind", "write, for example, `kind fabric.woven` in its representative block");
  if (!has.contains("called")) lacks("other name", "write, for example, `called \"corduroy\", \"ribbed cotton\"`");
  if (foreign.empty())
    lacks("name in another language", "write, for example, `called de \"Cord\"`");
  else if (!is_apart && std::ranges::includes(english, foreign))
    report(diagnostics, Code::shared_word, node.name.span,
           fmt::format("the names of `{}` in other languages are the English ones", material.name),
           "write what people call it there, or, if they say the same word, one more name");
  if (!has.contains("source"))
    lacks("source", "write `source \"…\"`: where its figures come from, or that they are an estimate, and whose");
  if (node.documentation.empty()) lacks("documentation", "write `/// …` above it: what it is, and how it pushes");
  if (material.licence.empty())
    report(diagnostics, Code::no_licence, node.name.span, fmt::format("`{}` has no licence", material.name),
           "write `licence \"CC0-1.0\"` in it, or in the `wale.project` of the library");
  else if (!may_be_shared(material.licence)) {
    // One that forbids something is no misspelt one that does not.
    const bool forbids = material.licence.find("-NC") != std::string::npos || material.licence.find("-ND") != std::string::npos;
    const auto near = forbids ? std::nullopt : nearest_licence(material.licence);
    report(diagnostics, Code::unfit_licence, licence_at,
           fmt::format("\"{}\" is no licence under which everybody may pass on, change and use a material",
                       visible_text(material.licence)),
           near ? fmt::format("did you mean \"{}\"?", *near)
                : "choose one that SPDX lists and that allows it, as \"CC0-1.0\" or \"CC-BY-4.0\"");
  }
  return words;
}

void tell_layers(const MaterialDecl& node, const CheckedMaterial& checked, const Declarations& declarations, bool whole,
                 Diagnostics& diagnostics) {
  const std::string& name = checked.name;
  if (checked.percepts.empty() && (whole || (!node.perceptual_span && !node.derived_from)))
    report(diagnostics, Code::incomplete_material, node.name.span,
           fmt::format("`{}` does not say how it feels", name),
           "write a `perceptual` block with levels, as in `roughness 0.35 estimated`");
  if (!checked.force && (whole || (!node.physical_span && !node.derived_from)))
    report(diagnostics, Code::incomplete_material, node.name.span, fmt::format("`{}` has no physics", name),
           "write a `physical` block with a force");
  for (const AskedPercept& asked : checked.percepts) {
    if (asked.evidence == Evidence::simulated || rests_on_simulation(asked, declarations))
      report(diagnostics, Code::simulated_figures, asked.place(),
             fmt::format("the {} of `{}` is simulated: nobody has felt it", asked.name, name),
             asked.by.empty() ? "ask people for it, and say `measured` or `estimated`"
                              : "leave out `by`: then a map is taken that people were measured for");
    // A level that follows from those of other materials is as well known as they are.
    if (!asked.evidence && !asked.blended && !asked.made_at)
      report(diagnostics, Code::incomplete_material, asked.place(),
             fmt::format("`{}` does not say how well its {} is known", name, asked.name),
             "write it behind the level: `measured`, `published` with a `source`, or `estimated`");
  }
}

void tell_folder(const std::string& folder, const ReviewedMaterial& material, Span span, Diagnostics& diagnostics) {
  const std::string branch = branch_of(material.kind);
  if (folder.empty() || branch.empty() || folder == branch) return;
  report(diagnostics, Code::elsewhere_in_library, span,
         fmt::format("a material of the kind `{}` lies in the folder `{}`", material.kind, visible_text(folder)),
         fmt::format("move the file into `{}`", branch));
}

}  // namespace wale
