#include "library/licence/passing_on.hpp"

#include <fmt/format.h>

#include <filesystem>
#include <set>

#include "compiler/modules/library_index.hpp"
#include "compiler/parse/parse.hpp"
#include "compiler/text/resolver.hpp"
#include "library/licence/licence.hpp"

namespace wale {
namespace {

namespace fs = std::filesystem;

/// The licences of what a text holds, where `over` stands over its file.
std::set<std::string> licences_in(SourceSet& sources, SourceId source, const std::string& over) {
  Diagnostics ignored;
  LibraryIndex index;
  index.add("", "", parse(sources, source, ignored));
  std::set<std::string> licences;
  for (const IndexedMaterial& each : index.materials()) licences.insert(each.licence.empty() ? over : each.licence);
  if (index.materials().empty()) licences.insert(over);  // functions, which programs hold too
  return licences;
}

}  // namespace

std::string project_over(const std::string& file) {
  std::error_code ignored;
  for (fs::path folder = fs::absolute(file, ignored).parent_path(); !folder.empty(); folder = folder.parent_path()) {
    if (fs::exists(folder / project_marker, ignored)) return folder.string();
    if (folder == folder.parent_path()) break;
  }
  return {};
}

std::string licence_over(const std::string& file) {
  const std::string folder = project_over(file);
  const auto stated = folder.empty() ? Result<std::string>(std::string()) : licence_of_library(folder);
  return stated ? *stated : std::string();
}

std::string why_kept_back(const std::string& licence) {
  if (licence.empty()) return "it states no licence, so nobody may pass it on";
  if (may_be_shared(licence)) return {};
  return fmt::format("its licence, {}, does not let everybody pass it on", licence);
}

std::string why_imports_keep_back(OpenedFile& opened) {
  for (std::size_t i = 0; i < opened.sources.size(); ++i) {
    const auto id = static_cast<SourceId>(i);
    if (id == opened.source) continue;
    for (const std::string& licence : licences_in(opened.sources, id, licence_over(opened.sources[id].name)))
      if (!may_be_shared(licence))
        return fmt::format("it rests on a file {}",
                           licence.empty() ? "without a licence" : "whose licence, " + licence + ", does not allow it");
  }
  return {};
}

std::vector<std::string> projects_under(const OpenedFile& opened) {
  std::set<std::string> projects;
  for (std::size_t i = 0; i < opened.sources.size(); ++i)
    if (const std::string folder = project_over(opened.sources[static_cast<SourceId>(i)].name); !folder.empty())
      projects.insert((fs::path(folder) / project_marker).string());
  return {projects.begin(), projects.end()};
}

}  // namespace wale
