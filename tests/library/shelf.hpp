#pragma once

#include <algorithm>
#include <cstdlib>
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

/// Those files with one in `every` of the kinds, beginning with the `first`-th, and all of `std`, for tests that take long
/// for each material. With WALE_ALL_MATERIALS in the environment, all files.
inline std::vector<std::string> sampled_files(std::size_t every, std::size_t first) {
  std::vector<std::string> files = library_files();
  if (std::getenv("WALE_ALL_MATERIALS")) return files;
  std::size_t kinds = 0;
  std::erase_if(files, [&](const std::string& path) {
    return path.find("/library/std/") == std::string::npos && kinds++ % every != first % every;
  });
  return files;
}

/// The materials of a third of the library.
inline std::vector<Program> programs() {
  std::vector<Program> all;
  for (const auto& path : sampled_files(3, 0)) {
    Checked checked(path);
    for (const auto& material : checked.module.materials)
      if (auto program = checked.program(material.name)) all.push_back(std::move(*program));
  }
  return all;
}

}  // namespace wale::shelf
