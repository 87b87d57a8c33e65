#include "compiler/build_all.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>

#include "compiler/cpp/print_header.hpp"

namespace wale {

namespace fs = std::filesystem;

namespace {

Error unwritable(const std::string& path, std::string sentence) {
  return {.code = Code::unwritable_file, .sentence = std::move(sentence), .place = {.name = path}};
}

}  // namespace

std::size_t BuiltCollection::built() const {
  return static_cast<std::size_t>(std::ranges::count_if(materials, [](const auto& one) { return !one.path.empty(); }));
}

WrittenForm as_patch_program() {
  return {".wpp", [](const Program& program) -> Result<std::string> {
            const auto bytes = write_patch_program(program.description());
            return std::string(reinterpret_cast<const char*>(bytes.data()), bytes.size());
          }};
}

WrittenForm as_cpp_header(std::vector<std::string> live) {
  return {".hpp", [live = std::move(live)](const Program& program) -> Result<std::string> {
            const auto parts = live_parts(program.description(), live);
            if (!parts) return parts.error();
            return print_header(program, *parts);
          }};
}

Result<BuiltCollection> build_all(const OpenedFile& opened, const FileRequest& request, const std::string& folder,
                                  const InputFiles& inputs, const WrittenForm& form) {
  BuiltCollection collection;
  const auto names = materials_of(opened);
  if (names.empty())
    return Error{.code = Code::unknown_material, .sentence = fmt::format("`{}` has no material to build", opened.name)};
  std::error_code error;
  if (fs::exists(folder, error) && !fs::is_directory(folder, error))
    return unwritable(folder, "this is a file; with --all, -o names a folder");
  if (fs::create_directories(folder, error); error)
    return unwritable(folder, "cannot make this folder: " + error.message());
  for (const auto& name : names) {
    BuiltMaterial built{.material = name, .path = {}, .bytes = 0, .written = {}, .diagnostics = {}};
    if (const auto program = compile_opened(opened, request, name, built.diagnostics)) {
      const std::string path = (fs::path(folder) / (name + form.ending)).string();
      const auto content = form.of(*program);
      built.written = content ? write_file(path, *content, inputs) : Result<>(content.error());
      if (built.written) built.path = path, built.bytes = content->size();
    }
    collection.materials.push_back(std::move(built));
  }
  return collection;
}

}  // namespace wale
