#include "compiler/open_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>

#include "compiler/solve/level_scale.hpp"
#include "schema/patch_program_format.hpp"

namespace wale {

NamedMaterial named_material(const std::string& name) {
  const auto colon = name.rfind(':');
  if (colon == std::string::npos || std::filesystem::exists(name)) return {name, {}};
  return {name.substr(0, colon), name.substr(colon + 1)};
}

OpenedFile open_file(const FileRequest& request) {
  OpenedFile opened;
  auto read = read_file(request.file);
  if (!read) {
    opened.refusal = fmt::format("`{}` cannot be read: {}", request.file, read.error().sentence);
    return opened;
  }
  auto& bytes = read->bytes;
  const bool patch_program =
      std::ranges::equal(patch_program_format::magic, bytes.substr(0, patch_program_format::magic.size()),
                         [](std::uint8_t a, char b) { return a == static_cast<std::uint8_t>(b); });
  if (patch_program || request.file.ends_with(".wpp")) {
    auto loaded = Program::load(std::as_bytes(std::span(bytes)));
    if (!loaded)
      opened.refusal = fmt::format("`{}` is refused: {}", request.file, in_words(loaded.error()));
    else
      opened.program = *std::move(loaded);
    return opened;
  }
  const auto resolver = file_resolver(request.roots, request.looked_for);
  opened.source = opened.sources.add(request.file, std::move(bytes));
  opened.module = check_source(opened.sources, opened.source, *resolver, opened.diagnostics);
  if (!opened.diagnostics.has_errors())
    check_levels(opened.module->declarations(), opened.source, request.device, opened.diagnostics);
  return opened;
}

std::optional<Program> compile_opened(const OpenedFile& opened, const FileRequest& request, const std::string& material,
                                      Diagnostics& diagnostics) {
  const auto resolver = file_resolver(request.roots, request.looked_for);
  return compile_material(*opened.module, material, request.device, opened.sources, opened.source, *resolver,
                          diagnostics);
}

std::vector<std::string> materials_of(const OpenedFile& opened) {
  std::vector<std::string> names;
  if (opened.module)
    for (const auto& material : opened.module->materials) names.push_back(material.name);
  return names;
}

}  // namespace wale
