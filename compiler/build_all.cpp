#include "compiler/build_all.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>

namespace wale {

namespace fs = std::filesystem;

namespace {

/// Writes a whole program or says why not; half of one is removed.
std::string write_program(const std::string& path, const std::vector<std::byte>& bytes) {
  std::ofstream file(path, std::ios::binary);
  if (!file) return fmt::format("cannot write `{}`: {}", path, std::strerror(errno));
  file.write(reinterpret_cast<const char*>(bytes.data()), static_cast<std::streamsize>(bytes.size())).flush();
  if (file) return {};
  const std::string reason = fmt::format("cannot write `{}`: {}", path, std::strerror(errno));
  std::error_code ignored;
  if (fs::is_regular_file(path, ignored)) fs::remove(path, ignored);
  return reason;
}

}  // namespace

std::size_t BuiltCollection::built() const {
  return static_cast<std::size_t>(std::ranges::count_if(materials, [](const auto& one) { return !one.path.empty(); }));
}

BuiltCollection build_all(const OpenedFile& opened, const FileRequest& request, const std::string& folder) {
  BuiltCollection collection;
  const auto names = materials_of(opened);
  std::error_code error;
  if (names.empty()) {
    collection.refusal = fmt::format("`{}` has no material to build", request.file);
  } else if (fs::exists(folder, error) && !fs::is_directory(folder, error)) {
    collection.refusal = fmt::format("`{}` is a file; with --all, -o names a folder", folder);
  } else if (fs::create_directories(folder, error); error) {
    collection.refusal = fmt::format("cannot make the folder `{}`: {}", folder, error.message());
  }
  if (!collection.refusal.empty()) return collection;
  for (const auto& name : names) {
    BuiltMaterial built{.material = name, .path = {}, .bytes = 0, .problem = {}, .diagnostics = {}};
    if (const auto program = compile_opened(opened, request, name, built.diagnostics)) {
      const auto bytes = write_patch_program(program->description());
      const std::string path = (fs::path(folder) / (name + ".wpp")).string();
      built.problem = write_program(path, bytes);
      if (built.problem.empty()) built.path = path, built.bytes = bytes.size();
    }
    collection.materials.push_back(std::move(built));
  }
  return collection;
}

}  // namespace wale
