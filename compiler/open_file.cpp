#include "compiler/open_file.hpp"

#include <fmt/format.h>

#include "compiler/solve/level_scale.hpp"

namespace wale {

Result<OpenedFile> open_file(const FileRequest& request) {
  auto named = find_named(request.file, request.roots);
  if (!named) return named.error();
  return open_named(*std::move(named), request);
}

Result<OpenedFile> open_named(NamedFile named, const FileRequest& request) {
  OpenedFile opened;
  opened.name = named.name, opened.material = named.material, opened.taken = named.taken;
  opened.is_on_disk = !named.embedded;
  std::string& bytes = named.bytes;
  if (is_patch_program(opened.name, bytes)) {
    auto loaded = Program::load(std::as_bytes(std::span(bytes)));
    if (!loaded) {
      Error error = loaded.error();
      error.sentence = "cannot be loaded: " + error.sentence;
      error.place = {.name = opened.name};
      error.led_to.clear();  // the sentence contains it
      return error;
    }
    opened.program = *std::move(loaded);
    return opened;
  }
  const auto resolver = file_resolver(request.roots, request.looked_for, request.sandbox, request.devices);
  opened.source = named.embedded ? *named.embedded : opened.sources.add(opened.name, std::move(bytes));
  opened.module = check_source(opened.sources, opened.source, *resolver, opened.diagnostics);
  if (!opened.diagnostics.has_errors())
    check_levels(opened.module->declarations(), opened.source, request.device, opened.diagnostics);
  return opened;
}

std::optional<Program> compile_opened(const OpenedFile& opened, const FileRequest& request, const std::string& material,
                                      Diagnostics& diagnostics) {
  const auto resolver = file_resolver(request.roots, request.looked_for, request.sandbox, request.devices);
  return compile_material(*opened.module, material.empty() ? opened.material : material, request.device, opened.sources,
                          opened.source, *resolver, diagnostics);
}

std::vector<std::string> materials_of(const OpenedFile& opened) {
  if (!opened.material.empty()) return {opened.material};
  std::vector<std::string> names;
  if (opened.module)
    for (const auto& material : opened.module->materials) names.push_back(material.name);
  return names;
}

}  // namespace wale
