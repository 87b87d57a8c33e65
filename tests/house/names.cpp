// One name, one type. Two types of one qualified name in different files compile, and then a program has the destructor of
// one of them for both: the linker takes the first and tells nobody.

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <map>
#include <regex>
#include <set>
#include <sstream>
#include <string>
#include <vector>

namespace wale::names_test {
namespace {

namespace fs = std::filesystem;

/// The types that a text in our style defines outside unnamed namespaces, each with its namespaces.
std::set<std::string> types_in(std::istream& text) {
  static const std::regex opened(R"(^namespace ?([\w:]*) ?\{)"), closed(R"(^\}  // (anonymous )?namespace)"),
      type(R"(^(?:template ?<.*> ?)?(?:struct|class|enum class) (?:alignas\(.*?\) )?([A-Z]\w*)(?: final)?(?: : [^;]*)? ?\{)");
  std::set<std::string> types;
  std::vector<std::string> within;
  for (std::string line; std::getline(text, line);) {
    // Regular expressions are slow, and most lines begin otherwise.
    if (line.empty() || std::string("nsce}t").find(line.front()) == std::string::npos) continue;
    std::smatch match;
    if (std::regex_search(line, match, opened)) {
      within.push_back(match.str(1));
    } else if (std::regex_search(line, closed)) {
      if (!within.empty()) within.pop_back();
    } else if (std::regex_search(line, match, type)) {
      std::string name;
      bool is_own = false;
      for (const std::string& each : within) is_own |= each.empty(), name += each + "::";
      if (!is_own) types.insert(name + match.str(1));
    }
  }
  return types;
}

TEST(Names, AreOfOneTypeEach) {
  std::map<std::string, std::vector<std::string>> files;
  for (const char* folder : {"schema", "runtime", "compiler", "calibration", "library", "examples/sandpaper"})
    for (const auto& entry : fs::recursive_directory_iterator(fs::path(WALE_SOURCE_DIR) / folder)) {
      const std::string ending = entry.path().extension();
      if (ending != ".cpp" && ending != ".hpp") continue;
      std::ifstream in(entry.path());
      for (const std::string& type : types_in(in)) files[type].push_back(fs::relative(entry.path(), WALE_SOURCE_DIR));
    }
  EXPECT_GT(files.size(), 300u);
  for (const auto& [type, where] : files)
    EXPECT_EQ(where.size(), 1u) << type << " is defined in " << where.front() << " and in " << where.back();
}

TEST(Names, AreFoundInOurStyle) {
  std::istringstream text(
      "namespace wale {\nnamespace {\nstruct Own {\n};\n}  // namespace\nclass Told final : public Base {\n};\n"
      "struct Only;\nstruct Told::Inner {\n};\nenum class Kind : int { a };\n}  // namespace wale\nnamespace other {\nstruct Told {\n};\n}\n");
  EXPECT_EQ(types_in(text), (std::set<std::string>{"wale::Told", "wale::Kind", "other::Told"}));
}

}  // namespace
}  // namespace wale::names_test
