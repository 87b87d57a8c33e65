#pragma once

#include <algorithm>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "compiler/compile.hpp"
#include "compiler/diagnostics/render.hpp"

namespace wale::shelf {

/// A file of the library, read and checked.
struct Checked {
  SourceSet sources;
  Diagnostics diagnostics;
  std::unique_ptr<Resolver> resolver = file_resolver({});
  SourceId source = 0;
  CheckedModule module;

  explicit Checked(const std::string& path) {
    auto read = read_file(path);
    source = sources.add(path, read->bytes);
    module = check_source(sources, source, *resolver, diagnostics);
  }

  std::optional<Program> program(const std::string& material) {
    return compile_material(module, material, default_device, sources, source, *resolver, diagnostics);
  }

  std::string complaints() const {
    std::string text;
    for (const auto& each : diagnostics.all()) text += render_text(each, sources, false);
    return text;
  }
};

/// All Wale files of the library, in the order of their paths.
inline std::vector<std::string> library_files() {
  std::vector<std::string> files;
  const std::filesystem::path library = std::filesystem::path(WALE_SOURCE_DIR) / "library";
  for (const auto& entry : std::filesystem::recursive_directory_iterator(library))
    if (entry.path().extension() == ".wale") files.push_back(entry.path().string());
  std::ranges::sort(files);
  return files;
}

/// Every material of the library.
inline std::vector<Program> programs() {
  std::vector<Program> all;
  for (const auto& path : library_files()) {
    Checked checked(path);
    for (const auto& material : checked.module.materials)
      if (auto program = checked.program(material.name)) all.push_back(std::move(*program));
  }
  return all;
}

}  // namespace wale::shelf
