#include "compiler/check/check.hpp"

#include <algorithm>

#include "compiler/check/check_experiment.hpp"
#include "compiler/check/check_material.hpp"
#include "compiler/check/check_names.hpp"
#include "compiler/check/check_presentation.hpp"
#include "compiler/check/check_workspace.hpp"
#include "compiler/modules/library_index.hpp"

namespace wale {

namespace {

/// Checks all constants of the file. Elsewhere a constant is read only where it is used, which would hide errors in
/// unused ones.
void check_constants(const SyntaxTree& tree, const Surroundings& surroundings) {
  Terms terms;
  std::vector<HeightTable> tables;
  ExpressionChecker checker(surroundings, terms, tables);
  for (const auto& declaration : tree.declarations)
    if (const auto* constant = std::get_if<Constant>(&declaration)) {
      Scope scope;
      const auto* declared = surroundings.declarations.constants.find(constant->name.text);
      if (declared && declared->node == constant) checker.named(constant->name, scope);
    }
}

/// Looks up unknown names among the exports of the library. The library is listed once, at the first unknown name.
FindExporter exporters_for(Resolver& resolver, const std::string& file) {
  return [&resolver, file,
          index = std::shared_ptr<const LibraryIndex>()](std::string_view name) mutable -> std::optional<Exporter> {
    if (!index) index = library_index(resolver, file);
    const ExportedName* found = index->exported(name);
    return found ? std::optional(Exporter{found->module, found->what}) : std::nullopt;
  };
}

}  // namespace

const CheckedMaterial* CheckedModule::material(const std::string& name) const {
  for (const auto& material : materials)
    if (name.empty() || material.name == name) return &material;
  return nullptr;
}

const CheckedWorkspace* CheckedModule::workspace(const std::string& name) const {
  const auto found = std::ranges::find(workspaces, name, &CheckedWorkspace::name);
  return found == workspaces.end() ? nullptr : &*found;
}

const CheckedExperiment* CheckedModule::experiment(const std::string& name) const {
  for (const CheckedExperiment& each : experiments)
    if (name.empty() || each.name == name) return &each;
  return nullptr;
}

CheckedModule check(ModuleSet modules, const SourceSet& sources, Resolver& resolver, Diagnostics& diagnostics) {
  CheckedModule checked;
  checked.modules = std::move(modules);
  const ModuleSet& all = checked.modules;
  const SyntaxTree* own = all.modules.empty() ? nullptr : &all.modules.back()->tree;
  for (const auto& tree : all.common->trees)
    if (tree->source == all.source) own = tree.get();
  if (!own) return checked;

  const FindExporter find_exporter = exporters_for(resolver, sources[all.source].name);
  const Surroundings surroundings{sources, checked.declarations(), diagnostics, &resolver, &find_exporter};
  const bool whole = !diagnostics.has_errors();
  check_constants(*own, surroundings);
  check_functions(*own, surroundings);
  for (const auto& declaration : own->declarations)
    if (const auto* node = std::get_if<MaterialDecl>(&declaration))
      if (const auto* declared = checked.declarations().materials.find(node->name.text);
          declared && declared->node == node)
        checked.materials.push_back(check_material(*declared, surroundings, whole));
  for (const auto& declaration : own->declarations)
    if (const auto* node = std::get_if<WorkspaceDecl>(&declaration))
      if (const auto* declared = checked.declarations().workspaces.find(node->name.text);
          declared && declared->node == node)
        checked.workspaces.push_back(check_workspace(*declared, surroundings, whole));
  check_presentations(*own, surroundings, checked);
  check_experiments(*own, surroundings, checked);
  if (whole && !diagnostics.has_errors() && !all.modules.empty()) warn_of_unused_declarations(all, surroundings);
  return checked;
}

}  // namespace wale
