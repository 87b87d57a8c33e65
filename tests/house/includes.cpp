// Which folder may include which. schema/CONTRIBUTING.md describes the same rule in prose.

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <functional>
#include <map>
#include <regex>
#include <set>
#include <string>
#include <vector>

namespace wale::includes_test {
namespace {

namespace fs = std::filesystem;
using Files = std::set<std::string>;

/// For each file, the files of the project that it includes. All paths are relative to the project's root.
using Includes = std::map<std::string, Files>;

bool is_source(const fs::path& path) {
  return path.extension() == ".cpp" || path.extension() == ".hpp" || path.extension() == ".h" ||
         path.extension() == ".def";
}

/// The sources of the project, without its tests.
Files sources() {
  Files files = {"wale.cpp"};
  for (const char* folder : {"schema", "runtime", "compiler", "calibration", "library", "examples"})
    for (const auto& entry : fs::recursive_directory_iterator(fs::path(WALE_SOURCE_DIR) / folder))
      if (is_source(entry.path())) files.insert(fs::relative(entry.path(), WALE_SOURCE_DIR).generic_string());
  return files;
}

/// The path of the file that an include of `name` means; empty when the file is not of the project.
std::string found(const std::string& name, const Files& files) {
  for (const char* root : {"", "schema/include/", "runtime/include/", "library/include/", "calibration/include/", "examples/sandpaper/"})
    if (files.contains(root + name)) return root + name;
  return {};
}

Includes includes() {
  const std::regex include(R"(^\s*#\s*include\s*[<"]([^>"]+)[>"])");
  const Files files = sources();
  Includes result;
  for (const std::string& file : files) {
    std::ifstream in(fs::path(WALE_SOURCE_DIR) / file);
    for (std::string line; std::getline(in, line);) {
      std::smatch match;
      if (!std::regex_search(line, match, include)) continue;
      EXPECT_FALSE(match.str(1).starts_with(".")) << file << ": names " << match.str(1) << " from its own folder";
      if (const std::string name = found(match.str(1), files); !name.empty()) result[file].insert(name);
    }
  }
  return result;
}

bool is_under(const std::string& file, const std::vector<std::string>& places) {
  return std::ranges::any_of(places, [&](const std::string& place) { return file.starts_with(place); });
}

/// Files in `place` may include files in `place` and in the folders and files of `may`.
struct Rule {
  std::string place;
  std::vector<std::string> may;
};

const std::vector<Rule>& rules() {
  static const std::vector<Rule> all = [] {
    // The public headers that the machine implements. The other public headers belong to the stage and to devices.
    const std::vector<std::string> machine = {
        "schema/",
        "runtime/machine/",
        "runtime/include/wale/program.hpp",
        "runtime/include/wale/batch.hpp",
        "runtime/include/wale/memory.hpp",
        "runtime/include/wale/picture.hpp",
    };
    // A workspace file is written by the compiler too.
    std::vector<std::string> of_compiler = machine;
    for (const char* each : {"runtime/shape/", "runtime/include/wale/shape.hpp", "runtime/include/wale/patch.hpp",
                             "runtime/include/wale/workspace.hpp"})
      of_compiler.emplace_back(each);
    return std::vector<Rule>{
        {"schema/include/", {}},
        {"schema/", {}},
        {"runtime/machine/", machine},
        {"runtime/include/", {"schema/include/"}},
        {"runtime/", {"schema/"}},
        {"compiler/", of_compiler},
        {"calibration/include/", {"schema/include/", "runtime/include/"}},
        {"calibration/", {"schema/", "compiler/", "runtime/"}},
        {"library/include/", {"schema/include/", "runtime/include/"}},
        {"library/", {"schema/", "compiler/", "runtime/", "calibration/feel/trusted_declarations.hpp"}},
        {"examples/", {"schema/include/", "runtime/include/", "library/include/", "calibration/include/"}},
    };
  }();
  return all;
}

TEST(Includes, StayWithinWhatAFolderMayKnow) {
  for (const auto& [file, included] : includes()) {
    const auto rule = std::ranges::find_if(rules(), [&](const Rule& each) { return file.starts_with(each.place); });
    if (rule == rules().end()) continue;  // wale.cpp may include all
    for (const std::string& name : included)
      EXPECT_TRUE(name.starts_with(rule->place) || is_under(name, rule->may)) << file << " includes " << name;
  }
}

/// The name of the entry of folder `parent` that holds the file: a folder in `parent`, or the file itself.
std::string part_of(const std::string& file, const std::string& parent) {
  const std::string rest = file.substr(parent.size());
  return rest.substr(0, rest.find('/'));
}

/// The parts on the first circle that is found, in the order of the includes; empty when there is no circle.
std::vector<std::string> circle_in(const std::map<std::string, Files>& graph) {
  std::vector<std::string> path;
  Files done;
  std::vector<std::string> circle;
  const std::function<void(const std::string&)> visit = [&](const std::string& part) {
    if (!circle.empty() || done.contains(part)) return;
    if (const auto again = std::ranges::find(path, part); again != path.end()) {
      circle.assign(again, path.end());
      return;
    }
    path.push_back(part);
    if (const auto next = graph.find(part); next != graph.end())
      for (const std::string& each : next->second) visit(each);
    path.pop_back();
    done.insert(part);
  };
  for (const auto& [part, next] : graph) visit(part);
  return circle;
}

TEST(Includes, HaveNoCircleInAnyFolder) {
  const Includes all = includes();
  Files folders = {""};
  for (const std::string& file : sources())
    for (std::size_t slash = file.find('/'); slash != std::string::npos; slash = file.find('/', slash + 1))
      folders.insert(file.substr(0, slash + 1));
  for (const std::string& folder : folders) {
    std::map<std::string, Files> graph;
    for (const auto& [file, included] : all)
      for (const std::string& name : included) {
        if (!file.starts_with(folder) || !name.starts_with(folder)) continue;
        const std::string from = part_of(file, folder), to = part_of(name, folder);
        if (from != to) graph[from].insert(to);
      }
    std::string text;
    for (const std::string& part : circle_in(graph)) text += part + " -> ";
    EXPECT_EQ(text, "") << "in `" << folder << "`";
  }
}

TEST(Includes, AreFollowedThroughTheProject) {
  const Includes all = includes();
  EXPECT_GT(all.size(), 300u);
  EXPECT_TRUE(all.at("runtime/machine/verify.cpp").contains("runtime/machine/verify.hpp"));
  EXPECT_TRUE(all.at("examples/roughness_by_name/main.cpp").contains("library/include/wale/wale.hpp"));
  EXPECT_TRUE(all.at("runtime/include/wale/stage.hpp").contains("runtime/include/wale/device.hpp"));
  EXPECT_TRUE(all.at("runtime/include/wale/device.hpp").contains("schema/include/wale/device_profile.hpp"));
  EXPECT_EQ(circle_in({{"a", {"b"}}, {"b", {"c", "d"}}, {"d", {"b"}}}), (std::vector<std::string>{"b", "d"}));
  EXPECT_TRUE(circle_in({{"a", {"b", "c"}}, {"b", {"c"}}}).empty());
}

}  // namespace
}  // namespace wale::includes_test
