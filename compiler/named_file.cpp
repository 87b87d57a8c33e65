#include "compiler/named_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <utility>

#include "compiler/modules/find_materials.hpp"
#include "compiler/modules/library_index.hpp"
#include "compiler/modules/meant_material.hpp"
#include "compiler/text/embedded_files.hpp"
#include "compiler/text/other_file.hpp"
#include "compiler/text/resolver.hpp"
#include "schema/closest_names.hpp"
#include "schema/patch_program_format.hpp"

namespace wale {
namespace {

namespace fs = std::filesystem;

bool exists(const std::string& path) {
  std::error_code ignored;
  return fs::exists(path, ignored);
}

bool is_folder(const std::string& path) {
  std::error_code ignored;
  return fs::is_directory(path, ignored);
}

/// Whether a text can only mean a path.
bool is_path(const std::string& text) {
  return text.empty() || text.find('/') != std::string::npos || text.ends_with(".wale") || text.ends_with(".wpp");
}

/// An embedded module of the library, by its path in the source tree; empty for other paths.
std::optional<NamedFile> shipped_file(const std::string& path) {
  const std::string name = fs::path(path).lexically_normal().generic_string();
  const auto files = embedded_files();
  const auto found =
      std::ranges::find_if(files, [&](const EmbeddedFile& each) { return !each.common && each.name == name; });
  if (found == files.end()) return std::nullopt;
  return NamedFile{.name = name,
                   .bytes = std::string(found->text),
                   .embedded = embedded_source(static_cast<std::size_t>(found - files.begin())),
                   .material = {},
                   .taken = {}};
}

/// Reads a file. A file on disk takes precedence over a shipped one with the same path: in a checkout it is newer.
Result<NamedFile> read_named(const std::string& path, const std::string& material) {
  if (!exists(path))
    if (auto shipped = shipped_file(path)) {
      shipped->material = material;
      return *std::move(shipped);
    }
  auto read = read_file(path);
  if (read) {
    if (auto right = is_wale_or_program(path, read->bytes); !right) return std::move(right.error());
    return NamedFile{.name = path, .bytes = std::move(read->bytes), .embedded = {}, .material = material, .taken = {}};
  }
  Error error = read.error();
  error.sentence = "cannot be read: " + error.sentence;
  error.place.name = path.empty() ? "path" : path;
  if (error.mend.empty())
    error.mend = exists(path) ? mend_of_path(path) : "`wale find` lists the materials of the library";
  return error;
}

/// The index of what a file in the current folder could import.
std::shared_ptr<const LibraryIndex> index_here(const std::vector<std::string>& roots) {
  return library_index(*file_resolver(roots), "here");
}

/// The sentence that says which of two was taken, where a person's own material goes before a shipped one.
std::string instead_of_shipped(const LibraryIndex& index, const std::string& name, const IndexedMaterial& meant) {
  const auto all = index.meant_by(name);
  const auto shipped = std::ranges::find(all, true, &IndexedMaterial::shipped);
  if (meant.shipped() || shipped == all.end()) return {};
  return fmt::format("`{}` is your own `{}:{}`; the shipped one is `{}:{}`", name, meant.file, meant.name,
                     (*shipped)->file, (*shipped)->name);
}

/// The first bytes of a name that may be as long as its author likes.
std::string shortened(const std::string& name) {
  constexpr std::size_t longest = 200;
  return name.size() <= longest ? name : name.substr(0, longest) + "…";
}

/// The first names of materials of a kind: at most three, and of each of its own kinds one before a second.
std::vector<std::string> some_of_kind(const LibraryIndex& index, const std::string& kind) {
  constexpr std::size_t most = 3;
  std::vector<std::string> names, kinds;
  for (const bool anew : {true, false})
    for (const IndexedMaterial& each : index.materials()) {
      const bool is_of_kind = each.kind == kind || each.kind.starts_with(kind + ".");
      if (!is_of_kind || each.origin == Origin::hidden || names.size() == most) continue;
      if (anew && std::ranges::find(kinds, each.kind) != kinds.end()) continue;
      if (std::ranges::find(names, each.name) != names.end()) continue;
      names.push_back(each.name);
      kinds.push_back(each.kind);
    }
  return names;
}

/// Materials with a word that begins so in their name, title or what they are called: at most three, each name once.
std::vector<std::string> some_with_word(const LibraryIndex& index, const std::string& word) {
  constexpr std::size_t most = 3, least_letters = 3;
  std::vector<std::string> names;
  if (word.size() < least_letters) return names;
  for (const FoundMaterial& each : find_materials(index, {word}, "")) {
    const bool is_named_so = each.by == FoundBy::name || each.by == FoundBy::title || each.by == FoundBy::called;
    if (!is_named_so || each.material->origin == Origin::hidden || names.size() == most) continue;
    if (std::ranges::find(names, each.material->name) == names.end()) names.push_back(each.material->name);
  }
  return names;
}

/// Adds the names of materials that are least far from `name`, up to three in all.
void fill_up(std::vector<std::string>& nearest, const LibraryIndex& index, const std::string& name) {
  constexpr std::size_t most = 3;
  if (nearest.size() >= most) return;
  std::vector<std::string> names;
  for (const IndexedMaterial& each : index.materials())
    if (each.origin != Origin::hidden && std::ranges::find(nearest, each.name) == nearest.end())
      names.push_back(each.name);
  for (std::string& each : closest_names(name, names, most - nearest.size())) nearest.push_back(std::move(each));
}

/// `is_not` goes on with the sentence of the error: "`corderoy` …".
Result<NamedFile> find_by_name(const std::string& name, const std::vector<std::string>& roots,
                               std::string_view is_not) {
  const std::shared_ptr<const LibraryIndex> index = index_here(roots);
  if (name.find('.') != std::string::npos) {
    const auto in_module = std::ranges::find(index->materials(), name, &IndexedMaterial::module);
    if (in_module != index->materials().end()) return read_named(in_module->file, "");
  }
  const auto meant = meant_material(*index, name);
  if (meant) {
    auto found = read_named((*meant)->file, (*meant)->name);
    if (found) found->taken = instead_of_shipped(*index, name, **meant);
    return found;
  }
  Error error = meant.error();
  error.place = {.text = name};  // the sentence names it
  if (error.code == Code::unknown_name) {
    error.sentence = fmt::format("`{}` {}", shortened(name), is_not);
    const auto kinds = kinds_in(*index);
    const bool is_kind = std::ranges::find(kinds, name) != kinds.end();
    if (is_kind) {
      error.sentence = fmt::format("`{}` is a kind of material, not a material", name);
      error.nearest = some_of_kind(*index, name);
      error.mend = fmt::format("ask for one of its materials, as for `{}`; `wale find --kind {}` lists all",
                               fmt::join(error.nearest, "`, `"), name);
    } else if (const auto near = nearest_materials(*index, name); !near.empty()) {
      error.mend = fmt::format("the nearest: {}; `wale find` lists all", listed_near(near));
      for (const NearMaterial& each : near) error.nearest.push_back(each.material->name);
    } else if (auto with_word = some_with_word(*index, name); !with_word.empty()) {
      error.mend = fmt::format("its word is in: `{}`; `wale find` lists all", fmt::join(with_word, "`, `"));
      error.nearest = std::move(with_word);
    } else
      error.mend = "`wale find` lists the materials of the library";
    if (!is_kind) fill_up(error.nearest, *index, name);
    if (!index->left_out().empty())
      error.sentence += fmt::format(" in the first {} MB of modules, which are read", most_indexed >> 20);
  }
  return error;
}

/// The file that `name` means in `name:material`: the module of that name that has this material, else the module of that
/// name, else the file of the material of that name.
Result<NamedFile> find_in_module(const std::string& name, const std::string& material,
                                 const std::vector<std::string>& roots, std::string_view is_not) {
  const std::shared_ptr<const LibraryIndex> index = index_here(roots);
  std::vector<const IndexedMaterial*> exactly;
  for (const IndexedMaterial& each : index->materials())
    if (each.module == name && each.name == material) exactly.push_back(&each);
  keep_preferred(exactly, {});
  if (!exactly.empty()) return read_named(exactly.front()->file, material);
  const auto in_module = std::ranges::find(index->materials(), name, &IndexedMaterial::module);
  const bool is_material =
      std::ranges::find(index->materials(), name, &IndexedMaterial::name) != index->materials().end();
  return in_module != index->materials().end() && !is_material ? read_named(in_module->file, material)
                                                               : find_by_name(name, roots, is_not);
}

}  // namespace

bool is_patch_program(std::string_view path, std::string_view bytes) {
  const auto& magic = patch_program_format::magic;
  return path.ends_with(".wpp") || std::ranges::equal(magic, bytes.substr(0, magic.size()), {}, {},
                                                      [](char byte) { return static_cast<std::uint8_t>(byte); });
}

NamedMaterial named_material(const std::string& argument) {
  const auto colon = argument.rfind(':');
  if (colon == std::string::npos || colon + 1 == argument.size() || exists(argument)) return {argument, {}};
  return {argument.substr(0, colon), argument.substr(colon + 1)};
}

bool is_searched_for(const std::string& argument) {
  const std::string file = named_material(argument).file;
  return !is_path(file) && (!exists(file) || is_folder(file));
}

Result<NamedFile> find_named_material(const std::string& name, const std::vector<std::string>& roots) {
  constexpr std::string_view is_not = "is not the name of a material";
  const auto colon = name.find(':');
  if (colon == std::string::npos) return find_by_name(name, roots, is_not);
  const std::string module = name.substr(0, colon), material = name.substr(colon + 1);
  if (module.empty() || material.empty() || material.find(':') != std::string::npos)
    return Error{.code = Code::malformed_value,
                 .sentence = fmt::format("expected MODULE:MATERIAL, found `{}`", shortened(name)),
                 .mend = "write a module or a material, one colon, and a material of that file",
                 .place = {.text = name}};
  auto found = find_in_module(module, material, roots, is_not);
  if (found) found->material = material;
  return found;
}

Result<NamedFile> read_named_file(const std::string& path) { return read_named(path, ""); }

Result<> is_wale_or_program(const std::string& path, std::string_view bytes) {
  const auto other = is_patch_program(path, bytes) ? std::nullopt : other_file(path, bytes);
  if (!other) return {};
  return Error{.code = Code::damaged_file,
               .sentence = fmt::format("this is {}, not a Wale file or a patch program", other->what),
               .mend = std::string(other->mend),
               .place = {.name = path}};
}

Result<NamedFile> find_named(const std::string& argument, const std::vector<std::string>& roots) {
  const auto [file, material] = named_material(argument);
  if (file.ends_with(':') && !exists(file))
    return Error{.code = Code::malformed_value,
                 .sentence = fmt::format("`{}` names no material after its colon", argument),
                 .mend = "write FILE:MATERIAL, or leave out the colon",
                 .place = {.text = argument}};
  const bool is_file = exists(file) && !is_folder(file);
  if (file.empty() || (!is_file && !is_path(file) && file.find(':') != std::string::npos))
    return Error{.code = Code::malformed_value,
                 .sentence = fmt::format("expected FILE:MATERIAL, found `{}`", argument),
                 .mend = "write a file or the name of a material, one colon, and a material of that file",
                 .place = {.text = argument}};
  if (!is_file && !is_path(file)) {
    constexpr std::string_view is_not = "is neither a file nor a material";
    auto found = material.empty() ? find_by_name(file, roots, is_not) : find_in_module(file, material, roots, is_not);
    if (!found && is_folder(file)) return read_named(file, "");
    if (found && !material.empty()) found->material = material;
    return found;
  }
  auto found = read_named(file, material);
  if (found && is_file && !is_path(file)) {
    const std::shared_ptr<const LibraryIndex> index = index_here(roots);
    if (const auto meant = meant_material(*index, file))
      found->taken = fmt::format("`{}` is a file here; the material of that name is `{}:{}`", file, (*meant)->file,
                                 (*meant)->name);
  }
  return found;
}

}  // namespace wale
