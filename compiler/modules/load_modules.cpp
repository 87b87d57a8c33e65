#include "compiler/modules/load_modules.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <functional>
#include <map>
#include <mutex>
#include <set>

#include "compiler/diagnostics/advice.hpp"
#include "compiler/expression/written_out.hpp"
#include "compiler/modules/declare.hpp"
#include "compiler/modules/library_index.hpp"
#include "compiler/parse/parse.hpp"
#include "compiler/text/embedded_files.hpp"

namespace wale {

namespace {

/// A file that could be imported by this name is: its exported devices are those of the project.
constexpr const char* project_devices = "devices";

/// A file's imports may have imports, and so on, so deep.
constexpr std::size_t deepest_import = 64;

SourceId embedded_source(std::size_t index) { return first_embedded_source + static_cast<SourceId>(index); }

/// Whether a file of this name, "…/schema/units.wale", is meant to stand in the place of an embedded one.
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
  if (replaced.empty()) common->written_out = std::make_shared<WrittenOutFunctions>(common->declarations);
  return common;
}

void report_all(const Diagnostics& found, Diagnostics& diagnostics) {
  for (const Diagnostic& each : found.all()) diagnostics.report(each);
}

/// What a setting `like X`, `like "deep wale corduroy"` or `like fabric.woven` says; nothing of any other, nor where it
/// makes no sense, which `assemble` reports.
std::optional<Word> liked_by(const Setting& setting, const SyntaxTree& tree) {
  if (setting.key.text != "like" || setting.items.size() != 1) return std::nullopt;
  const SettingItem& item = setting.items.front();
  if (item.words.size() == 1 && !item.value) return item.words.front();
  const auto* text = item.value ? std::get_if<TextLiteral>(&tree.expr(*item.value)) : nullptr;
  return text ? std::optional(Word{text->text, tree.span(*item.value)}) : std::nullopt;
}

/// Of several materials those whose files are imported, if there are any.
void choose_nearest(const SyntaxTree& tree, std::vector<const IndexedMaterial*>& found) {
  const auto is_imported = [&](const IndexedMaterial* each) {
    return std::ranges::any_of(tree.declarations, [&](const Declaration& declaration) {
      const auto* import = std::get_if<Import>(&declaration);
      return import && import->module.text == each->module;
    });
  };
  if (std::ranges::any_of(found, is_imported)) std::erase_if(found, std::not_fn(is_imported));
  const auto is_own = [](const IndexedMaterial* each) { return !each->shipped; };
  if (std::ranges::any_of(found, is_own)) std::erase_if(found, std::not_fn(is_own));
}

/// Follows imports depth first, so that what a file refers to is declared before it.
class ModuleLoader {
 public:
  ModuleLoader(SourceSet& sources, Resolver& resolver, Diagnostics& diagnostics, ModuleSet& modules)
      : sources_(sources), resolver_(resolver), diagnostics_(diagnostics), modules_(modules) {}

  /// The file itself, with all that its imports and its `like`s bring, each before what uses it. It knows the devices
  /// of its project besides.
  void load(SyntaxTree tree) {
    add_project_devices_of(sources_[tree.source].name);
    const std::shared_ptr<const Module> file = add(std::move(tree));
    modules_.modules.pop_back();
    // What is brought may bring more.
    for (std::size_t i = 0; i < added_.size(); ++i) find_likes(*std::shared_ptr(added_[i]));
    modules_.modules.push_back(file);
  }

 private:
  std::shared_ptr<const Module> add(SyntaxTree tree) {
    const std::string name = sources_[tree.source].name;
    path_.push_back(name);
    auto module = std::make_shared<Module>(std::move(tree), modules_.common->declarations, names_);
    module->name = name;
    for (const auto& declaration : module->tree.declarations)
      if (const auto* import = std::get_if<Import>(&declaration))
        if (const auto imported = follow(import->module, name)) {
          modules_.imports[import] = imported;
          import_names(imported->declarations, *import, module->declarations, sources_, diagnostics_);
        }
    declare(module->tree, sources_, module->declarations, diagnostics_);
    if (devices_ && path_.size() == 1) add_project_devices(module->declarations);
    path_.pop_back();
    loaded_[name] = module;
    modules_.modules.push_back(module);
    added_.push_back(module);
    return module;
  }

  void add_project_devices_of(const std::string& name) {
    auto resolved = resolver_.module(project_devices, name);
    // One that is just being written is still empty.
    if (resolved && resolved->name != name && !resolved->bytes.empty()) {
      const SourceId source = sources_.add(resolved->name, std::move(resolved->bytes));
      devices_ = add(parse(sources_, source, diagnostics_));
    }
  }

  /// What the file declares or imports by the same names goes before them.
  void add_project_devices(Declarations& declarations) const {
    for (const auto& [name, entry] : devices_->declarations.devices.own()) {
      if (!entry.exported || entry.imported || declarations.devices.own().contains(name)) continue;
      auto imported = entry;
      imported.imported = true;
      declarations.devices.add(name, std::move(imported));
    }
  }

  std::shared_ptr<const Module> follow(const Word& module, const std::string& from) {
    auto resolved = resolver_.module(std::string(module.text), from);
    if (!resolved) {
      if (auto embedded = embedded_module(module)) return *embedded;
      diagnostics_.report(
          {.code = Code::unknown_import,
           .span = module.span,
           .message = fmt::format("`{}` cannot be imported: {}", module.text, resolved.error().sentence),
           .help = "dots stand for folders: `import fabric.denim` is the file fabric/denim.wale"});
      return nullptr;
    }
    ResolvedFile& file = *resolved;
    if (const auto known = loaded_.find(file.name); known != loaded_.end()) return known->second;
    if (circular(module, file.name) || too_deep(module)) return nullptr;
    const SourceId source = sources_.add(file.name, std::move(file.bytes));
    return add(parse(sources_, source, diagnostics_));
  }

  /// A module that is part of the binary, `std.friction`, unless the file asking is that module.
  std::optional<std::shared_ptr<const Module>> embedded_module(const Word& word) {
    std::string name = fmt::format("library/{}", word.text);
    std::replace(name.begin(), name.end(), '.', '/');
    name += ".wale";
    for (std::size_t i = 0; i < embedded_files().size(); ++i) {
      const EmbeddedFile& file = embedded_files()[i];
      if (file.common || file.name != name) continue;
      if (const auto known = loaded_.find(name); known != loaded_.end()) return known->second;
      if (circular(word, name) || too_deep(word)) return nullptr;
      return add(parse(sources_, embedded_source(i), diagnostics_));
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
    diagnostic.expected = "imports that come to an end";
    diagnostic.found = circle + fmt::format("`{}`", name);
    diagnostics_.report(std::move(diagnostic));
    return true;
  }

  /// Each import is followed within the one before it, whoever supplies the files.
  bool too_deep(const Word& module) {
    if (path_.size() < deepest_import) return false;
    diagnostics_.report(Advice("let this file import what it needs itself, or put some of the files into one")
                            .fact("limit", static_cast<double>(deepest_import))
                            .about(Code::nested_too_deep, module.span,
                                   fmt::format("more than {} files import one another in a row", deepest_import)));
    return true;
  }

  /// Finds what the materials of a file are like that it neither declares nor imports by that name.
  void find_likes(Module& module) {
    for (const Declaration& declaration : module.tree.declarations)
      if (const auto* material = std::get_if<MaterialDecl>(&declaration))
        for (const Setting& setting : material->representative)
          if (const auto liked = liked_by(setting, module.tree)) {
            if (const auto* named = module.declarations.materials.find(liked->text); !named)
              module.declarations.likes[&setting] = find_in_library(module, std::string(material->name.text), *liked);
            else if (setting.items.front().value)
              module.declarations.likes[&setting] = named;
          }
  }

  /// What a material of a file is like: one of the file itself goes before one that it imports, and that before others.
  const Declared<MaterialDecl>* find_in_library(const Module& module, std::string_view asking, const Word& liked) {
    LibraryIndex own;
    own.add(module.name, module.name, module.tree);
    const auto others = [&](std::vector<const IndexedMaterial*> found) {
      std::erase_if(found, [&](const IndexedMaterial* each) { return each->name == asking && is_file(module, *each); });
      return found;
    };
    if (const auto near = others(own.meant_by(liked.text)); near.size() == 1)
      return module.declarations.materials.find(near.front()->name);
    const std::shared_ptr<const LibraryIndex> index = library_index(resolver_, module.name);
    std::vector<const IndexedMaterial*> found = others(index->meant_by(liked.text));
    if (found.size() > 1) choose_nearest(module.tree, found);
    if (found.size() != 1) return report_likes(module, liked, found, *index), nullptr;
    const auto file = follow({found.front()->module, liked.span}, module.name);
    return file ? file->declarations.materials.find(found.front()->name) : nullptr;
  }

  /// Whether an entry of an index is of the file itself: "fabric.denim" of "library/fabric/denim.wale".
  static bool is_file(const Module& module, const IndexedMaterial& entry) {
    if (entry.module == module.name) return true;
    std::string path = entry.module;
    std::ranges::replace(path, '.', '/');
    path += ".wale";
    return module.name == path || module.name.ends_with("/" + path);
  }

  void report_likes(const Module& module, const Word& liked, const std::vector<const IndexedMaterial*>& found,
                    const LibraryIndex& index) {
    if (found.empty()) {
      std::vector<std::string> candidates = module.declarations.materials.spellings();
      for (std::string& each : index.spellings()) candidates.push_back(std::move(each));
      diagnostics_.report(
          did_you_mean(liked.span, liked.text, candidates,
                       "declare it in this file, or `import` the file that does, as in `import "
                       "fabric.denim`; what the library has is found by itself",
                       false)
              .about(Code::unknown_name, liked.span, fmt::format("no material is called `{}`", liked.text)));
      return;
    }
    std::string all;
    constexpr std::size_t most_told = 5;
    for (std::size_t i = 0; i < std::min(found.size(), most_told); ++i)
      all += fmt::format("{}`{}` of `{}`", i == 0 ? "" : ", ", found[i]->name, found[i]->module);
    if (found.size() > most_told) all += fmt::format(" and {} more", found.size() - most_told);
    const IndexedMaterial& first = *found.front();
    diagnostics_.report(
        Advice(first.name == liked.text ? fmt::format("import the one that is meant, as in `import {}`", first.module)
                                        : fmt::format("name the one that is meant, as in `like {}`", first.name))
            .about(Code::ambiguous_material, liked.span,
                   fmt::format("`{}` may be {} materials of the library: {}", liked.text, found.size(), all)));
  }

  SourceSet& sources_;
  Resolver& resolver_;
  Diagnostics& diagnostics_;
  ModuleSet& modules_;
  std::shared_ptr<SharedNames> names_ = std::make_shared<SharedNames>(modules_.common->declarations.names());
  std::vector<std::string> path_;  ///< files whose imports are being followed
  std::map<std::string, std::shared_ptr<const Module>> loaded_;
  std::vector<std::shared_ptr<Module>> added_;  ///< all of them
  std::shared_ptr<const Module> devices_;       ///< the project's own; may be null
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
