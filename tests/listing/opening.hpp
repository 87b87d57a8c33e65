#pragma once

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <stdexcept>
#include <string>
#include <vector>

#include "compiler/build_stage.hpp"
#include "compiler/diagnostics/render.hpp"

namespace wale::listing {

inline const std::filesystem::path library = std::filesystem::path(WALE_SOURCE_DIR) / "library";

inline std::string complaints(const Diagnostics& diagnostics, const SourceSet& sources) {
  std::string text;
  for (const auto& each : diagnostics.all()) text += render_text(each, sources, false);
  return text;
}

/// A Wale file, opened as on the command line. Throws std::runtime_error with the diagnostics when there are errors.
struct File {
  FileRequest request;
  OpenedFile opened;

  explicit File(const std::string& path, const std::string& device = default_device)
      : request{.file = path, .device = device, .roots = {}}, opened(*open_file(request)) {
    if (opened.diagnostics.has_errors()) throw std::runtime_error(complaints(opened.diagnostics, opened.sources));
  }

  Program program(const std::string& material) const {
    Diagnostics diagnostics;
    const auto program = compile_opened(opened, request, material, diagnostics);
    if (!program) throw std::runtime_error(complaints(diagnostics, opened.sources));
    return *program;
  }

  std::string stage(const std::string& material, BuildStage stage) const {
    Diagnostics diagnostics;
    const auto text = build_stage(opened, request, material, stage, diagnostics);
    if (!text || !*text) throw std::runtime_error(complaints(diagnostics, opened.sources));
    return **text;
  }
};

/// One in six of the library's files with materials, except library/sandpaper; with WALE_ALL_MATERIALS in the environment,
/// all of them, which takes minutes.
inline std::vector<std::string> shipped_files() {
  std::vector<std::string> files;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(library)) {
    const std::string folder = entry.path().parent_path().filename().string();
    if (entry.path().extension() == ".wale" && folder != "std" && folder != "sandpaper" && folder != "library")
      files.push_back(entry.path().string());
  }
  std::ranges::sort(files);
  std::size_t at = 0;
  if (!std::getenv("WALE_ALL_MATERIALS")) std::erase_if(files, [&](const std::string&) { return at++ % 6 != 0; });
  return files;
}

}  // namespace wale::listing
