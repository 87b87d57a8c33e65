#include "compiler/modules/load_modules.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <mutex>
#include <set>

#include "compiler/diagnostics/advice.hpp"
#include "compiler/modules/declare.hpp"
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
                                                 const SourceSet& sources, Diagnostics& diagnostics) {
  auto common = std::make_shared<CommonModules>();
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

/// Follows imports depth first, so that what a file refers to is declared before it.
class ModuleLoader {
 public:
  ModuleLoader(SourceSet& sources, Resolver& resolver, Diagnostics& diagnostics, ModuleSet& modules)
      : sources_(sources), resolver_(resolver), diagnostics_(diagnostics), modules_(modules) {}

  /// The file itself, which knows the devices of its project besides what it imports.
  void add_first(SyntaxTree tree) {
    const std::string name = sources_[tree.source].name;
    auto resolved = resolver_.module(project_devices, name);
    // One that is just being written is still empty.
    if (auto* file = std::get_if<ResolvedFile>(&resolved); file && file->name != name && !file->bytes.empty()) {
      const SourceId source = sources_.add(file->name, std::move(file->bytes));
      devices_ = add(parse(sources_, source, diagnostics_));
    }
    add(std::move(tree));
  }

 private:
  std::shared_ptr<const Module> add(SyntaxTree tree) {
    const std::string name = sources_[tree.source].name;
    path_.push_back(name);
    auto module = std::make_shared<Module>(std::move(tree), modules_.common->declarations, names_);
    module->name = name;
    for (const auto& declaration : module->tree.declarations)
      if (const auto* import = std::get_if<Import>(&declaration))
        if (const auto imported = follow(*import, name)) {
          modules_.imports[import] = imported;
          import_names(imported->declarations, *import, module->declarations, sources_, diagnostics_);
        }
    declare(module->tree, sources_, module->declarations, diagnostics_);
    if (devices_ && path_.size() == 1) add_project_devices(module->declarations);
    path_.pop_back();
    loaded_[name] = module;
    modules_.modules.push_back(module);
    return module;
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

  std::shared_ptr<const Module> follow(const Import& import, const std::string& from) {
    const Word& module = import.module;
    auto resolved = resolver_.module(module.text, from);
    if (const auto* problem = std::get_if<ResolveProblem>(&resolved)) {
      if (auto embedded = embedded_module(module)) return *embedded;
      diagnostics_.report({.code = Code::unknown_import,
                           .span = module.span,
                           .message = fmt::format("`{}` cannot be imported: {}", module.text, problem->reason),
                           .help = "dots stand for folders: `import fabric.denim` is the file fabric/denim.wale"});
      return nullptr;
    }
    auto& file = std::get<ResolvedFile>(resolved);
    if (const auto known = loaded_.find(file.name); known != loaded_.end()) return known->second;
    if (circular(module, file.name) || too_deep(module)) return nullptr;
    const SourceId source = sources_.add(file.name, std::move(file.bytes));
    return add(parse(sources_, source, diagnostics_));
  }

  /// A module that is part of the binary, `std.friction`, unless the file asking is that module.
  std::optional<std::shared_ptr<const Module>> embedded_module(const Word& word) {
    std::string name = "library/" + word.text;
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

  SourceSet& sources_;
  Resolver& resolver_;
  Diagnostics& diagnostics_;
  ModuleSet& modules_;
  std::shared_ptr<SharedNames> names_ = std::make_shared<SharedNames>(modules_.common->declarations.names());
  std::vector<std::string> path_;  ///< files whose imports are being followed
  std::map<std::string, std::shared_ptr<const Module>> loaded_;
  std::shared_ptr<const Module> devices_;  ///< the project's own; may be null
};

}  // namespace

std::shared_ptr<const CommonModules> common_modules() {
  static const std::shared_ptr<const CommonModules> common = [] {
    Diagnostics diagnostics;  // the tests hold that there are none
    return load_common(std::nullopt, "", SourceSet(), diagnostics);
  }();
  return common;
}

ModuleSet load_modules(SyntaxTree tree, SourceSet& sources, Resolver& resolver, Diagnostics& diagnostics) {
  ModuleSet modules;
  modules.source = tree.source;
  const std::string& name = sources[tree.source].name;
  for (const auto& file : embedded_files())
    if (file.common && stands_for(name, file)) {
      modules.common = load_common(std::move(tree), name, sources, diagnostics);
      return modules;
    }
  modules.common = common_modules();
  ModuleLoader(sources, resolver, diagnostics, modules).add_first(std::move(tree));
  return modules;
}

}  // namespace wale
