#include <fmt/format.h>

#include <set>

#include "compiler/check.hpp"
#include "compiler/declare.hpp"
#include "compiler/embedded_files.hpp"
#include "compiler/parse.hpp"

namespace wale {

namespace {

/// Follows imports depth first, so that what a file refers to is declared before it.
class ModuleLoader {
 public:
  ModuleLoader(SourceSet& sources, Resolver& resolver, Diagnostics& diagnostics, ModuleSet& modules)
      : sources_(sources), resolver_(resolver), diagnostics_(diagnostics), modules_(modules) {}

  void add(SyntaxTree tree) {
    const std::string name = sources_[tree.source].name;
    open_.insert(name);
    for (const auto& declaration : tree.declarations)
      if (const auto* import = std::get_if<Import>(&declaration)) follow(import->module, name);
    open_.erase(name);
    done_.insert(name);
    modules_.trees.push_back(std::make_unique<SyntaxTree>(std::move(tree)));
    declare(*modules_.trees.back(), sources_, modules_.declarations, diagnostics_);
  }

 private:
  void follow(const Word& module, const std::string& from) {
    auto resolved = resolver_.module(module.text, from);
    if (const auto* problem = std::get_if<ResolveProblem>(&resolved)) {
      diagnostics_.report({.code = Code::unknown_import,
                           .span = module.span,
                           .message = fmt::format("`{}` cannot be imported: {}", module.text, problem->reason),
                           .help = "dots stand for folders: `import fabric.denim` is the file fabric/denim.wale"});
      return;
    }
    auto& file = std::get<ResolvedFile>(resolved);
    if (done_.contains(file.name)) return;
    if (open_.contains(file.name)) {
      diagnostics_.report({.code = Code::cyclic_import,
                           .span = module.span,
                           .message = fmt::format("`{}` imports this file, directly or through others", module.text),
                           .help = "move what both need into a third file"});
      return;
    }
    const SourceId source = sources_.add(file.name, std::move(file.bytes));
    add(parse(sources_, source, diagnostics_));
  }

  SourceSet& sources_;
  Resolver& resolver_;
  Diagnostics& diagnostics_;
  ModuleSet& modules_;
  std::set<std::string> open_, done_;
};

}  // namespace

ModuleSet load_modules(SyntaxTree tree, SourceSet& sources, Resolver& resolver, Diagnostics& diagnostics) {
  ModuleSet modules;
  ModuleLoader loader(sources, resolver, diagnostics, modules);
  modules.source = tree.source;
  const std::string name = sources[tree.source].name;
  bool added = false;
  for (const auto& file : embedded_files()) {
    // Whoever edits one of these files means it to stand in its own place, not beside itself.
    if (!added && (name == file.name || name.ends_with("/" + std::string(file.name)))) {
      loader.add(std::move(tree));
      added = true;
      continue;
    }
    const SourceId source = sources.add(std::string(file.name), std::string(file.text));
    loader.add(parse(sources, source, diagnostics));
  }
  if (!added) loader.add(std::move(tree));
  return modules;
}

}  // namespace wale
