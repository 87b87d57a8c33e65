#include "compiler/modules/load_modules.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <functional>
#include <map>
#include <mutex>
#include <set>

#include "compiler/diagnostics/advice.hpp"
#include "compiler/modules/declare.hpp"
#include "compiler/modules/find_materials.hpp"
#include "compiler/modules/library_index.hpp"
#include "compiler/modules/meant_material.hpp"
#include "compiler/parse/made_from.hpp"
#include "compiler/parse/parse.hpp"
#include "compiler/text/embedded_files.hpp"
#include "schema/spelling.hpp"

namespace wale {

namespace {

/// A module of this name is imported automatically: its exported devices are those of the project.
constexpr const char* project_devices = "devices";

/// How deep imports may be nested.
constexpr std::size_t deepest_import = 64;

/// Whether a file of this name, "…/schema/units.wale", replaces an embedded one.
bool stands_for(const std::string& name, const EmbeddedFile& file) {
  if (!name.ends_with(file.name)) return false;
  return name.size() == file.name.size() || name[name.size() - file.name.size() - 1] == '/';
}

std::shared_ptr<const CommonModules> load_common(std::optional<SyntaxTree> replacement, const std::string& replaced,
                                                 const SourceSet& sources) {
  auto common = std::make_shared<CommonModules>();
  Diagnostics& diagnostics = common->problems;
  for (std::size_t i = 0; i < embedded_files().size(); ++i) {
    const EmbeddedFile& file = embedded_files()[i];
    if (!file.common) continue;
    SyntaxTree tree = replacement && stands_for(replaced, file) ? *std::move(replacement)
                                                                : parse(sources, embedded_source(i), diagnostics);
    common->trees.push_back(std::make_unique<SyntaxTree>(std::move(tree)));
    declare(*common->trees.back(), sources, common->declarations, diagnostics);
  }
  return common;
}

void report_all(const Diagnostics& found, Diagnostics& diagnostics) {
  for (const Diagnostic& each : found.all()) diagnostics.report(each);
}

std::vector<std::string_view> imported_modules(const SyntaxTree& tree) {
  std::vector<std::string_view> modules;
  for (const Declaration& declaration : tree.declarations)
    if (const auto* import = std::get_if<Import>(&declaration)) modules.push_back(import->module.text);
  return modules;
}

/// Follows imports depth first, so that a file is declared after all files that it refers to.
class ModuleLoader {
 public:
  ModuleLoader(SourceSet& sources, Resolver& resolver, Diagnostics& diagnostics, ModuleSet& modules)
      : sources_(sources), resolver_(resolver), diagnostics_(diagnostics), modules_(modules) {}

  /// Loads the file itself, its imports and the files of the library materials that it names, each before the files
  /// that use it. The file also knows the devices of its project.
  void load(SyntaxTree tree) {
    add_project_devices_of(sources_[tree.source].name);
    add_owners_devices();
    const std::shared_ptr<const Module> file = add(std::move(tree));
    modules_.modules.pop_back();
    // `added_` grows while files that it adds need more files.
    for (std::size_t i = 0; i < added_.size(); ++i) find_materials(*std::shared_ptr(added_[i]));
    modules_.modules.push_back(file);
  }

 private:
  struct Loaded {
    std::shared_ptr<const Module> module;
    std::size_t depth = 1;  ///< how many files one below another it consists of, with itself
  };

  SyntaxTree parsed(SourceId source) {
    diagnostics_.allow_text(sources_[source].text.size());
    return parse(sources_, source, diagnostics_);
  }

  std::shared_ptr<const Module> add(SyntaxTree tree) {
    const std::string name = sources_[tree.source].name;
    path_.push_back(name);
    const std::size_t depth_before = std::exchange(depth_, 0);
    auto module = std::make_shared<Module>(std::move(tree), modules_.common->declarations, names_);
    module->name = name;
    for (const auto& declaration : module->tree.declarations)
      if (const auto* import = std::get_if<Import>(&declaration))
        if (const auto imported = follow(import->module, name)) {
          modules_.imports[import] = imported;
          import_names(imported->declarations, *import, module->declarations, sources_, diagnostics_);
        }
    declare(module->tree, sources_, module->declarations, diagnostics_);
    if (path_.size() == 1)
      for (const auto& devices : devices_) add_devices(*devices, module->declarations);
    path_.pop_back();
    const std::size_t depth = depth_ + 1;
    depth_ = std::max(depth_before, depth);
    loaded_[name] = {module, depth};
    modules_.modules.push_back(module);
    added_.push_back(module);
    return module;
  }

  void add_project_devices_of(const std::string& name) {
    auto resolved = resolver_.module(project_devices, name);
    // An empty file is ignored: an editor may be writing it at this moment.
    if (resolved && resolved->name != name && !resolved->bytes.empty()) {
      const SourceId source = sources_.add(resolved->name, std::move(resolved->bytes));
      devices_.push_back(add(parsed(source)));
    }
  }

  void add_owners_devices() {
    std::vector<std::shared_ptr<const Module>> owners;
    for (ResolvedFile& file : resolver_.devices()) {
      if (loaded_.contains(file.name)) continue;
      const SourceId source = sources_.add(file.name, std::move(file.bytes));
      owners.push_back(add(parsed(source)));
    }
    devices_.insert(devices_.end(), owners.begin(), owners.end());
  }

  /// Declarations and imports of the file itself take precedence over devices of the same names.
  static void add_devices(const Module& devices, Declarations& declarations) {
    for (const auto& [name, entry] : devices.declarations.devices.own()) {
      if (!entry.exported || entry.imported || declarations.devices.own().contains(name)) continue;
      auto imported = entry;
      imported.imported = true;
      declarations.devices.add(name, std::move(imported));
    }
  }

  std::shared_ptr<const Module> follow(const Word& module, const std::string& from) {
    // What is known is not read again.
    const std::string expected = resolver_.module_name(std::string(module.text), from);
    if (const auto known = loaded_.find(expected); known != loaded_.end()) return again(module, known->second);
    if (circular(module, expected) || too_deep(module, 1)) return nullptr;
    auto resolved = resolver_.module(std::string(module.text), from);
    if (!resolved) {
      if (resolved.error().code == Code::too_much_read) return report_too_much(module, resolved.error()), nullptr;
      if (auto embedded = embedded_module(module)) return *embedded;
      diagnostics_.report(
          did_you_mean(module.span, module.text, embedded_modules(),
                       "dots separate folders: `import fabric.denim` means the file fabric/denim.wale; if that is in "
                       "the folder of a library, name it with `--library DIR` or in the environment's `WALE_LIBRARY`")
              .about(Code::unknown_import, module.span,
                     fmt::format("`{}` cannot be imported: {}", module.text, resolved.error().sentence)));
      return nullptr;
    }
    ResolvedFile& file = *resolved;
    if (const auto known = loaded_.find(file.name); known != loaded_.end()) return again(module, known->second);
    if (circular(module, file.name)) return nullptr;
    const SourceId source = sources_.add(file.name, std::move(file.bytes));
    return add(parsed(source));
  }

  /// The names under which the modules that are part of the binary are imported.
  static std::vector<std::string> embedded_modules() {
    constexpr std::string_view folder = "library/", ending = ".wale";
    std::vector<std::string> names;
    for (const EmbeddedFile& file : embedded_files()) {
      std::string name(file.name);
      if (file.common || !name.starts_with(folder) || !name.ends_with(ending)) continue;
      name = name.substr(folder.size(), name.size() - folder.size() - ending.size());
      std::ranges::replace(name, '/', '.');
      names.push_back(std::move(name));
    }
    return names;
  }

  /// A module that is part of the binary, such as `std.friction`, unless the importing file is that module itself.
  std::optional<std::shared_ptr<const Module>> embedded_module(const Word& word) {
    std::string name = fmt::format("library/{}", word.text);
    std::replace(name.begin(), name.end(), '.', '/');
    name += ".wale";
    for (std::size_t i = 0; i < embedded_files().size(); ++i) {
      const EmbeddedFile& file = embedded_files()[i];
      if (file.common || file.name != name) continue;
      if (const auto known = loaded_.find(name); known != loaded_.end()) return again(word, known->second);
      if (circular(word, name)) return nullptr;
      return add(parsed(embedded_source(i)));
    }
    return std::nullopt;
  }

  bool circular(const Word& module, const std::string& name) {
    const auto first = std::ranges::find_if(path_, [&](const std::string& open) {
      return open == name || (name.starts_with("library/") && open.ends_with("/" + name));
    });
    if (first == path_.end()) return false;
    std::string circle;
    Advice advice = "move what both need into a third file";
    for (auto each = first; each != path_.end(); ++each) {
      circle += fmt::format("`{}` imports ", *each);
      advice = std::move(advice).fact("file", *each);
    }
    Diagnostic diagnostic =
        std::move(advice).about(Code::cyclic_import, module.span,
                                fmt::format("`{}` imports this file, directly or through others", module.text));
    diagnostic.expected = "imports without a circle";
    diagnostic.found = circle + fmt::format("`{}`", name);
    diagnostics_.report(std::move(diagnostic));
    return true;
  }

  /// A module that was loaded before. It counts as deep as it is, in whatever order the imports are written.
  std::shared_ptr<const Module> again(const Word& word, const Loaded& loaded) {
    if (too_deep(word, loaded.depth)) return nullptr;
    depth_ = std::max(depth_, loaded.depth);
    return loaded.module;
  }

  void report_too_much(const Word& module, const Error& error) {
    diagnostics_.report({.code = error.code, .span = module.span, .message = error.sentence, .help = error.mend});
  }

  /// Whether the imports are nested too deep with a file that has `depth` files one below another, which is reported.
  /// They are followed recursively.
  bool too_deep(const Word& module, std::size_t depth) {
    if (path_.size() + depth <= deepest_import) return false;
    diagnostics_.report(Advice("import directly the files that this file needs, or combine some of the files")
                            .fact("limit", static_cast<double>(deepest_import))
                            .about(Code::nested_too_deep, module.span,
                                   fmt::format("imports are nested more than {} files deep", deepest_import)));
    return true;
  }

  /// Finds the library materials that a file's materials and patches are made from but that it neither declares nor
  /// imports.
  void find_materials(Module& module) {
    const auto find = [&](const std::vector<Word>& words, std::string_view asking) {
      for (const Word& word : words)
        if (!module.declarations.materials.contains(word.text))
          module.declarations.library_materials[word.span.begin] = find_in_library(module, asking, word);
    };
    for (const Declaration& declaration : module.tree.declarations) {
      if (const auto* material = std::get_if<MaterialDecl>(&declaration))
        find(made_from(*material, module.tree), material->name.text);
      if (const auto* record = std::get_if<RecordDecl>(&declaration); record && record->keyword.text == "experiment")
        find(presented_by(*record, module.tree), "");
      const auto* workspace = std::get_if<WorkspaceDecl>(&declaration);
      if (!workspace) continue;
      // A patch may have the name of the material that it is of.
      for (const PlacedStatement& placed : workspace->placed) {
        if (const auto* patch = std::get_if<PatchPlacing>(&placed)) {
          find(made_from(patch->material, module.tree), "");
          continue;
        }
        for (const Setting& setting : std::get<PicturePlacing>(placed).settings)
          for (const SettingItem& item : setting.items)
            if (setting.key.text == "colour" && item.equals) find(made_from(*item.equals, module.tree), "");
      }
    }
  }

  /// The material that a word means. Materials of the file itself take precedence over imported ones, and those over
  /// others. The material `asking` is never meant. Null if none or several are found, which is reported.
  const Declared<MaterialDecl>* find_in_library(const Module& module, std::string_view asking, const Word& word) {
    LibraryIndex own;
    own.add(module.name, module.name, module.tree);
    const auto others = [&](std::vector<const IndexedMaterial*> found) {
      std::erase_if(found, [&](const IndexedMaterial* each) {
        return each->origin == Origin::hidden || (each->name == asking && is_file(module, *each));
      });
      return found;
    };
    if (const auto near = others(own.meant_by(word.text)); near.size() == 1)
      return module.declarations.materials.find(near.front()->name);
    const std::shared_ptr<const LibraryIndex> index = library_index(resolver_, module.name);
    std::vector<const IndexedMaterial*> found = others(index->meant_by(word.text));
    keep_preferred(found, imported_modules(module.tree));
    if (found.empty()) return report_unknown(module, word, own, *index), nullptr;
    if (found.size() > 1) return report_ambiguous(word, found), nullptr;
    const auto file = follow({found.front()->module, word.span}, module.name);
    return file ? file->declarations.materials.find(found.front()->name) : nullptr;
  }

  /// Whether an entry of the index comes from the file itself: "fabric.denim" from "library/fabric/denim.wale".
  static bool is_file(const Module& module, const IndexedMaterial& entry) {
    if (entry.module == module.name) return true;
    std::string path = entry.module;
    std::ranges::replace(path, '.', '/');
    path += ".wale";
    return module.name == path || module.name.ends_with("/" + path);
  }

  void report_unknown(const Module& module, const Word& word, const LibraryIndex& own, const LibraryIndex& index) {
    if (word.text.empty())
      return diagnostics_.report(
          Advice("write a name or a title, as in `corduroy` or `\"Wide-wale corduroy\"`")
              .about(Code::unknown_name, word.span, "expected the name of a material, found an empty text"));
    const std::string message = fmt::format("no material is called `{}`", word.text);
    const auto kinds = kinds_in(index);
    if (std::ranges::find(kinds, word.text) != kinds.end())
      return diagnostics_.report(
          Advice(fmt::format("name one of its materials; `wale find --kind {}` lists them", word.text))
              .about(Code::unknown_name, word.span,
                     fmt::format("`{}` is a kind of material, not a material", word.text)));
    if (const ExportedName* other = index.exported(word.text))
      return diagnostics_.report(
          Advice(fmt::format("`{}` is a {} of `{}`, and no material; to use it, write `import {}`", word.text,
                             other->what, other->module, other->module))
              .about(Code::unknown_name, word.span, message));
    // Materials that the file declares or imports need no import.
    std::vector<NearMaterial> near = nearest_materials(own, word.text);
    const auto is_own = [&](const NearMaterial& each) {
      return each.material->module == module.name || module.declarations.materials.contains(each.material->name);
    };
    // More than are told, since some are hidden or known already.
    constexpr std::size_t most_looked_at = 20;
    for (NearMaterial& each : nearest_materials(index, word.text, most_looked_at)) {
      const auto same = [&](const NearMaterial& other) { return other.material->name == each.material->name; };
      if (std::ranges::none_of(near, same) && each.material->origin != Origin::hidden) near.push_back(std::move(each));
    }
    std::ranges::stable_sort(near, {}, &NearMaterial::distance);
    constexpr std::size_t most_told = 3;
    if (near.size() > most_told) near.resize(most_told);
    const bool is_dotted = word.text.find('.') != std::string_view::npos;
    if (near.empty())
      return diagnostics_.report(
          Advice(is_dotted ? "take one of the library; `wale find` lists them"
                           : fmt::format("declare it, as in `material {} {{ … }}`, or take one of the library; "
                                         "`wale find` lists them",
                                         word.text))
              .about(Code::unknown_name, word.span, message));
    std::vector<std::string> told;
    for (const NearMaterial& each : near) {
      const auto& called = each.material->called;
      const bool by_text = each.name == each.material->title || std::ranges::find(called, each.name) != called.end();
      std::string text = fmt::format("`{}`", each.material->name);
      if (by_text) text += fmt::format(", called \"{}\"", each.name);
      told.push_back(is_own(each) ? text : fmt::format("{} of `{}`", text, each.material->module));
    }
    const std::string nearest(near.front().material->name);
    const std::string last = std::exchange(told.back(), "");
    told.pop_back();
    // A misspelt name that the file itself knows gets a safe fix.
    std::vector<Fix> fixes = respell(word.span, word.text, module.declarations.materials.spellings());
    if (fixes.empty()) fixes.push_back(replace(word.span, nearest, {}, false));
    diagnostics_.report(Advice(told.empty() ? fmt::format("did you mean {}?", last)
                                            : fmt::format("did you mean {} or {}?", fmt::join(told, ", "), last))
                            .fix(std::move(fixes))
                            .fact("meant", nearest)
                            .about(Code::unknown_name, word.span, message));
  }

  void report_ambiguous(const Word& word, const std::vector<const IndexedMaterial*>& found) {
    const IndexedMaterial& first = *found.front();
    const bool is_one_name = std::ranges::count(found, first.name, &IndexedMaterial::name) > 1;
    const std::string one = is_one_name ? first.module + "." + first.name : first.name;
    diagnostics_.report(
        Advice(fmt::format("name the one that you mean, as in `{}`", one))
            .about(Code::ambiguous_material, word.span,
                   fmt::format("`{}` may be {} materials of the library: {}", word.text, found.size(), listed(found))));
  }

  SourceSet& sources_;
  Resolver& resolver_;
  Diagnostics& diagnostics_;
  ModuleSet& modules_;
  std::shared_ptr<SharedNames> names_ = std::make_shared<SharedNames>(modules_.common->declarations.names());
  std::vector<std::string> path_;  ///< files whose imports are being followed
  std::size_t depth_ = 0;          ///< of the files that the current one imports, so far
  std::map<std::string, Loaded> loaded_;
  std::vector<std::shared_ptr<Module>> added_;          ///< all files loaded so far
  std::vector<std::shared_ptr<const Module>> devices_;  ///< the project's own, then those of the owner's files
};

}  // namespace

std::shared_ptr<const CommonModules> common_modules() {
  static const std::shared_ptr<const CommonModules> common = [] {
    return load_common(std::nullopt, "", SourceSet());
  }();
  return common;
}

ModuleSet load_modules(SyntaxTree tree, SourceSet& sources, Resolver& resolver, Diagnostics& diagnostics) {
  const std::string& name = sources[tree.source].name;
  for (const auto& file : embedded_files())
    if (file.common && stands_for(name, file)) {
      ModuleSet modules;
      modules.source = tree.source;
      modules.common = load_common(std::move(tree), name, sources);
      report_all(modules.common->problems, diagnostics);
      return modules;
    }
  return load_modules(std::move(tree), sources, resolver, diagnostics, common_modules());
}

ModuleSet load_modules(SyntaxTree tree, SourceSet& sources, Resolver& resolver, Diagnostics& diagnostics,
                       std::shared_ptr<const CommonModules> common) {
  ModuleSet modules;
  modules.source = tree.source;
  modules.common = std::move(common);
  report_all(modules.common->problems, diagnostics);
  ModuleLoader(sources, resolver, diagnostics, modules).load(std::move(tree));
  return modules;
}

}  // namespace wale
