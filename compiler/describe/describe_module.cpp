#include "compiler/describe/describe_module.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <utility>

#include "compiler/describe/describe_figure.hpp"
#include "compiler/modules/library_index.hpp"
#include "compiler/text/json_text.hpp"
#include "compiler/text/readable.hpp"
#include "schema/visible_text.hpp"

namespace wale {
namespace {

/// The entries of one kind that the file itself exports, in the order written.
template <typename T>
std::vector<std::pair<std::string, const typename Names<T>::Entry*>> offered(const Names<T>& names,
                                                                             const CheckedModule& module) {
  const bool common = module.modules.modules.empty();
  std::vector<std::pair<std::string, const typename Names<T>::Entry*>> found;
  for (const auto& [name, entry] : names.own())
    if (!entry.imported && (common || entry.exported) && entry.declared.source == module.modules.source)
      found.emplace_back(name, &entry);
  std::ranges::sort(found, {}, [](const auto& one) { return one.second->declared.begin; });
  return found;
}

std::string written(const SyntaxTree& tree, ExprId expr, const SourceSet& sources) {
  return std::string(sources.text(tree.span(expr)));
}

std::string unit_documentation(const CheckedModule& module, const Span& declared) {
  if (module.modules.modules.empty()) return {};
  for (const auto& declaration : module.modules.modules.back()->tree.declarations)
    if (const auto* unit = std::get_if<UnitDecl>(&declaration); unit && unit->name.span == declared)
      return std::string(unit->documentation);
  return {};
}

/// The records that the file exports. Of a file that every file knows there is no tree here, and so none.
std::vector<DescribedRecord> records_of(const CheckedModule& module, const std::string& file) {
  std::vector<DescribedRecord> records;
  if (module.modules.modules.empty()) return records;
  LibraryIndex index;
  index.add(file, file, module.modules.modules.back()->tree);
  for (const ExportedName& each : index.exports())
    if (each.what != "function" && each.what != "constant" && each.what != "unit" && each.what != "dimension")
      records.push_back({std::string(each.what), each.name});
  return records;
}

/// "woven(place: length, over = 1)", as in its declaration.
std::string signature(const DescribedFunction& function) {
  std::string text;
  for (const auto& argument : function.arguments)
    text += fmt::format("{}{}{}{}", text.empty() ? "" : ", ", argument.name,
                        argument.dimension.empty() ? "" : ": " + argument.dimension,
                        argument.default_value.empty() ? "" : " = " + argument.default_value);
  return fmt::format("{}({})", function.name, text);
}

}  // namespace

ModuleDescription describe_module(const CheckedModule& module, const SourceSet& sources) {
  const Declarations& declarations = module.declarations();
  const DimensionNames& names = declarations.names();
  ModuleDescription description;
  description.file = sources[module.modules.source].name;
  for (const auto& [name, entry] : offered(declarations.functions, module)) {
    const auto& [tree, node, home] = entry->what;
    DescribedFunction function{.name = name, .arguments = {}, .documentation = std::string(node->documentation)};
    for (const auto& parameter : node->parameters)
      function.arguments.push_back(
          {.name = std::string(parameter.name.text),
           .dimension = std::string(parameter.dimension ? parameter.dimension->text : ""),
           .default_value = parameter.default_value ? written(*tree, *parameter.default_value, sources) : ""});
    description.functions.push_back(std::move(function));
  }
  for (const auto& [name, entry] : offered(declarations.constants, module))
    description.constants.push_back({.name = name,
                                     .value = written(*entry->what.tree, entry->what.node->value, sources),
                                     .documentation = std::string(entry->what.node->documentation)});
  for (const auto& [name, entry] : offered(declarations.units, module))
    description.units.push_back({.name = name,
                                 .dimension = names.words(entry->what.dimension),
                                 .in_si = entry->what.factor,
                                 .si_unit = names.unit(entry->what.dimension),
                                 .documentation = unit_documentation(module, entry->declared)});
  for (const auto& [name, entry] : offered(declarations.dimensions, module))
    description.dimensions.push_back({.name = name, .factors = names.factors(entry->what)});
  description.known_everywhere = module.modules.modules.empty();
  description.records = records_of(module, description.file);
  return description;
}

std::string module_text(const ModuleDescription& description) {
  std::string text = visible_text(description.file) + "\n";
  if (!description.functions.empty()) text += "\nfunctions\n";
  for (const auto& function : description.functions) {
    text += fmt::format("  {}\n", signature(function));
    write_documentation(text, 6, function.documentation);
  }
  if (!description.constants.empty()) text += "\nconstants\n";
  for (const auto& constant : description.constants) {
    text += fmt::format("  {} = {}\n", constant.name, constant.value);
    write_documentation(text, 6, constant.documentation);
  }
  if (!description.units.empty()) text += "\nunits\n";
  for (const auto& unit : description.units) {
    text += readable("  {:<12} {:.6g}{}{} ({})\n", unit.name, unit.in_si, unit.si_unit.empty() ? "" : " ", unit.si_unit,
                     unit.dimension);
    write_documentation(text, 6, unit.documentation);
  }
  if (!description.dimensions.empty()) text += "\ndimensions\n";
  for (const auto& dimension : description.dimensions)
    text += fmt::format("  {:<12} {}\n", dimension.name, dimension.factors);
  if (!description.records.empty()) text += "\nrecords\n";
  for (const auto& record : description.records) text += fmt::format("  {:<12} {}\n", record.what, record.name);
  if (description.empty() && !description.known_everywhere) text += "\nexports nothing\n";
  return text;
}

std::string module_json(const ModuleDescription& description) {
  using Json = nlohmann::ordered_json;
  Json json = {{"file", description.file}};
  Json& functions = json["functions"] = Json::array();
  for (const auto& function : description.functions) {
    Json arguments = Json::array();
    for (const auto& argument : function.arguments) {
      Json one = {{"name", argument.name}};
      if (!argument.dimension.empty()) one["dimension"] = argument.dimension;
      if (!argument.default_value.empty()) one["default"] = argument.default_value;
      arguments.push_back(std::move(one));
    }
    functions.push_back(
        {{"name", function.name}, {"arguments", std::move(arguments)}, {"documentation", function.documentation}});
  }
  Json& constants = json["constants"] = Json::array();
  for (const auto& constant : description.constants)
    constants.push_back(
        {{"name", constant.name}, {"value", constant.value}, {"documentation", constant.documentation}});
  Json& units = json["units"] = Json::array();
  for (const auto& unit : description.units)
    units.push_back({{"name", unit.name},
                     {"dimension", unit.dimension},
                     {"in_si", unit.in_si},
                     {"si_unit", unit.si_unit},
                     {"documentation", unit.documentation}});
  Json& dimensions = json["dimensions"] = Json::array();
  for (const auto& dimension : description.dimensions)
    dimensions.push_back({{"name", dimension.name}, {"factors", dimension.factors}});
  Json& records = json["records"] = Json::array();
  for (const auto& record : description.records) records.push_back({{"what", record.what}, {"name", record.name}});
  return json_lines(json);
}

}  // namespace wale
