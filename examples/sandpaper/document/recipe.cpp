#include "document/recipe.hpp"

#include <algorithm>
#include <filesystem>
#include <regex>
#include <set>
#include <sstream>
#include <system_error>

namespace sandpaper {
namespace {

constexpr double usual_side = 0.05;  // m, of a patch whose recipe gives no size

/// A text in which words that name a material have other names: behind `material` and `like`, and on the line behind
/// the `=` of a material, a patch or a colour. A function or an argument of that name stays.
std::string renamed(const std::string& text, const std::map<std::string, std::string>& names) {
  const auto words = wale::coloured_words(text);
  const auto word = [&](std::size_t i) {
    return i < words.size() ? text.substr(words[i].begin, words[i].end - words[i].begin) : std::string();
  };
  std::string result;
  std::size_t kept = 0;
  bool refers = false;
  for (std::size_t i = 0; i < words.size(); ++i) {
    const std::string each = word(i), before = i > 0 ? word(i - 1) : "", first = i > 1 ? word(i - 2) : "";
    if (i > 0 && text.substr(words[i - 1].end, words[i].begin - words[i - 1].end).find('\n') != std::string::npos)
      refers = false;
    if (each == "{" || each == ";" || each == "}") refers = false;
    if (each == "=" && (first == "material" || first == "patch" || first == "colour")) refers = true;
    const auto found = names.find(each);
    if (found == names.end() || !(before == "material" || before == "like" || (refers && word(i + 1) != ":"))) continue;
    result += text.substr(kept, words[i].begin - kept) + found->second;
    kept = words[i].end;
  }
  return result + text.substr(kept);
}

/// The declarations of a recipe without its version, its workspaces and the imports that a file already has.
std::string declarations_of(const std::string& recipe, const std::vector<wale::Layout>& layouts,
                            const std::string& file) {
  std::string text = recipe;
  for (auto each = layouts.rbegin(); each != layouts.rend(); ++each)
    text.erase(each->begin, std::min(each->end, text.size()) - each->begin);
  std::set<std::string> imports;
  static const std::regex import(R"(\s*import\s+([\w.]+)\s*)"), version(R"(\s*wale\s+\d+\s*)");
  std::smatch found;
  std::istringstream theirs(file);
  for (std::string line; std::getline(theirs, line);)
    if (std::regex_match(line, found, import)) imports.insert(found[1]);
  std::istringstream lines(text);
  std::string kept;
  for (std::string line; std::getline(lines, line);) {
    if (std::regex_match(line, version)) continue;
    if (std::regex_match(line, found, import) && !imports.insert(found[1]).second) continue;
    if (line.empty() && (kept.empty() || kept.ends_with("\n\n"))) continue;
    kept += line + "\n";
  }
  while (kept.ends_with("\n")) kept.pop_back();
  return kept.empty() ? kept : kept + "\n\n";
}

}  // namespace

std::vector<std::string> recipes_of(const std::string& page, const std::string& folder) {
  std::vector<std::string> recipes;
  std::istringstream lines(page);
  static const std::regex opening(R"((\s*)```wale\s*)");
  std::size_t indent = 0;
  bool inside = false;
  std::smatch found;
  for (std::string line; std::getline(lines, line);) {
    if (!inside && std::regex_match(line, found, opening)) {
      inside = true, indent = found[1].length();
      recipes.emplace_back();
    } else if (inside && line.find_first_not_of(' ') != std::string::npos &&
               line.substr(line.find_first_not_of(' ')).starts_with("```")) {
      inside = false;
    } else if (inside) {
      recipes.back() += line.substr(std::min(indent, line.size())) + "\n";
    }
  }
  for (std::string& recipe : recipes) recipe = with_paths(recipe, folder);
  return recipes;
}

std::string with_paths(const std::string& text, const std::string& folder) {
  static const std::regex picture(R"~("([^"\\\n]+\.(png|jpg|jpeg|tif|tiff|pgm|csv))")~");
  std::string resolved, rest = text;
  for (std::smatch found; std::regex_search(rest, found, picture);) {
    const std::filesystem::path path = std::filesystem::path(folder) / found[1].str();
    std::error_code ignored;
    resolved +=
        found.prefix().str() + (std::filesystem::exists(path, ignored) ? "\"" + path.string() + "\"" : found[0].str());
    rest = std::string(found.suffix());
  }
  return resolved + rest;
}

WithRecipe with_recipe(const wale::LanguageService& language, const Contents& contents, const std::string& recipe,
                       glm::dvec2 at, const std::string& workspace) {
  const wale::CompileOptions options{.name = contents.file.empty() ? "untitled.wale" : contents.file};
  const std::vector<std::string> theirs = language.check(contents.surroundings(), options).materials;
  std::set<std::string> taken(theirs.begin(), theirs.end());
  std::map<std::string, std::string> names;
  for (const std::string& each : language.check(recipe, options).materials) {
    std::string name = each;
    for (int i = 2; taken.contains(name); ++i) name = each + "_" + std::to_string(i);
    taken.insert(name);
    names[each] = name;
  }
  const std::string text = renamed(recipe, names);
  const wale::CheckedText checked = language.check(text, options);

  WithRecipe result{contents, {}};
  Contents& next = result.contents;
  if (!next.head.empty() && !next.head.ends_with("\n")) next.head += "\n";
  next.head += declarations_of(text, checked.layouts, contents.surroundings());
  std::vector<wale::LaidOutPatch> patches;
  if (!checked.layouts.empty()) {
    const auto wanted = std::ranges::find(checked.layouts, workspace, &wale::Layout::name);
    patches = (wanted == checked.layouts.end() ? checked.layouts.front() : *wanted).patches;
  } else if (!checked.materials.empty()) {
    static const std::regex sized(R"(\n\s*patch\s+[\d.])");
    wale::LaidOutPatch patch{.name = checked.materials.front(), .made_of = checked.materials.front()};
    if (!std::regex_search(text, sized)) patch.size = glm::dvec2(usual_side);
    patches.push_back(patch);
  }
  for (wale::LaidOutPatch& each : patches) {
    if (each.is_of_picture) continue;  // the statement before it lays it out
    if (!each.verbatim.empty()) {
      static const std::regex placed(R"(\n\s*at\s)");
      const std::size_t brace = each.verbatim.find('{');
      if (brace != std::string::npos && !std::regex_search(each.verbatim, placed))
        each.verbatim.insert(brace + 1, "\n    at " + written(at.x, "mm", 1e-3) + ", " + written(at.y, "mm", 1e-3));
    } else {
      each.at += at;
      each.name = next.new_name(each.name);
      result.patches.push_back(each.name);
    }
    next.placed.push_back(std::make_shared<const Placed>(Placed{.patch = each, .compiled_from = each.made_of}));
  }
  return result;
}

}  // namespace sandpaper
