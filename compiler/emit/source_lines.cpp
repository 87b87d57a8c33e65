#include "compiler/emit/source_lines.hpp"

#include "schema/visible_text.hpp"

namespace wale {

SourceLines::SourceLines(const SourceSet& sources, const ModuleSet& modules) : sources_(sources) {
  for (const auto& module : modules.modules)
    for (const auto& declaration : module->tree.declarations)
      if (const auto* import = std::get_if<Import>(&declaration))
        if (const auto brought = modules.imports.find(import); brought != modules.imports.end() && brought->second)
          imported_.emplace(brought->second->tree.source, import->module.text);
}

std::string SourceLines::file(SourceId source) const {
  if (const auto name = imported_.find(source); name != imported_.end()) return name->second;
  const std::string& path = sources_[source].name;
  return visible_text(path.substr(path.find_last_of("/\\") + 1));
}

}  // namespace wale
