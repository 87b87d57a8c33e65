// schema/LANGUAGE.md: its examples compile, its error is the compiler's, and it names every declaration of schema/.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <map>
#include <memory>
#include <regex>
#include <sstream>
#include <string>
#include <variant>
#include <vector>

#include "compiler/compile.hpp"
#include "compiler/compile_workspace.hpp"
#include "compiler/diagnostics/render.hpp"
#include "compiler/solve/level_scale.hpp"

namespace wale::reference_test {
namespace {

std::string content(const std::string& name) {
  std::ifstream file(std::filesystem::path(WALE_SOURCE_DIR) / name);
  EXPECT_TRUE(file) << name;
  std::ostringstream text;
  text << file.rdbuf();
  return text.str();
}

/// A fenced block: its kind (after the opening fence), its first line in the page, its text, and the file name in the
/// line above, as in "A file `detent.csv`:".
struct Block {
  std::string kind;
  int line = 0;
  std::string text;
  std::string name;
};

std::vector<Block> blocks_of(const std::string& page) {
  std::vector<Block> blocks;
  bool inside = false;
  int number = 0;
  const std::regex naming("file `([^`]+)`:$");
  std::string name;
  std::istringstream lines(page);
  for (std::string line; std::getline(lines, line);) {
    ++number;
    if (line.starts_with("```")) {
      if (!inside) blocks.push_back({line.substr(3), number + 1, "", name});
      inside = !inside;
      name.clear();
    } else if (inside) {
      blocks.back().text += line + "\n";
    } else if (!line.empty()) {
      std::smatch named;
      name = std::regex_search(line, named, naming) ? named[1].str() : "";
    }
  }
  EXPECT_FALSE(inside) << "a block does not end";
  return blocks;
}

/// Resolves the files that the page shows, and the pictures of library/stone.
class PageResolver final : public Resolver {
 public:
  explicit PageResolver(const std::vector<Block>& blocks) {
    for (const Block& block : blocks)
      if (!block.name.empty()) files_[block.name] = block.text;
  }

  Result<ResolvedFile> module(const std::string& path, const std::string& from) override {
    std::string name = path + ".wale";
    std::replace(name.begin(), name.begin() + static_cast<std::ptrdiff_t>(path.size()), '.', '/');
    return file(name, from);
  }

  Result<ResolvedFile> file(const std::string& name, const std::string& from) override {
    if (const auto found = files_.find(name); found != files_.end()) return ResolvedFile{name, found->second};
    return library_->file(name, from);
  }

  std::size_t size() const { return files_.size(); }

 private:
  std::map<std::string, std::string> files_;
  std::unique_ptr<Resolver> library_ = file_resolver({WALE_SOURCE_DIR "/library/stone"});
};

std::string rendered(const Diagnostics& diagnostics, const SourceSet& sources) {
  std::string text;
  for (const auto& each : diagnostics.all()) text += render_text(each, sources, false);
  return text;
}

/// All matches of a pattern's first group.
std::vector<std::string> found_in(const std::string& text, const std::string& pattern) {
  const std::regex regex(pattern);
  std::vector<std::string> found;
  for (std::sregex_iterator match(text.begin(), text.end(), regex), end; match != end; ++match)
    found.push_back((*match)[1]);
  return found;
}

TEST(Reference, ItsExamplesCompile) {
  int compiled = 0;
  const auto blocks = blocks_of(content("schema/LANGUAGE.md"));
  PageResolver resolver(blocks);
  EXPECT_EQ(resolver.size(), 2);
  for (const Block& block : blocks) {
    if (block.kind != "wale") continue;
    SourceSet sources;
    Diagnostics diagnostics;
    const SourceId source = sources.add("example.wale", block.text);
    const CheckedModule module = check_source(sources, source, resolver, diagnostics);
    EXPECT_FALSE(module.materials.empty() && module.workspaces.empty()) << "line " << block.line;
    check_levels(module.declarations(), source, default_device, diagnostics);
    for (const auto& material : module.materials) {
      compile_material(module, material.name, default_device, sources, source, resolver, diagnostics);
      ++compiled;
    }
    for (const auto& workspace : module.workspaces)
      compile_workspace(workspace, module, default_device, sources, source, resolver, diagnostics);
    EXPECT_EQ(rendered(diagnostics, sources), "") << "line " << block.line;
  }
  EXPECT_GE(compiled, 6);
}

TEST(Reference, ItsErrorIsThatOfTheCompiler) {
  const auto blocks = blocks_of(content("schema/LANGUAGE.md"));
  int shown = 0;
  for (std::size_t i = 0; i < blocks.size(); ++i) {
    if (blocks[i].kind != "wale-error") continue;
    SourceSet sources;
    Diagnostics diagnostics;
    const auto resolver = file_resolver({});
    compile(sources, sources.add("detent.wale", blocks[i].text), "", default_device, *resolver, diagnostics);
    ASSERT_LT(i + 1, blocks.size());
    EXPECT_EQ(blocks[i + 1].kind, "text");
    EXPECT_EQ(rendered(diagnostics, sources), blocks[i + 1].text);
    ++shown;
  }
  EXPECT_EQ(shown, 1);
}

TEST(Reference, EveryBlockIsOfAKindThatIsTested) {
  for (const Block& block : blocks_of(content("schema/LANGUAGE.md")))
    EXPECT_TRUE(block.kind == "wale" || block.kind == "wale-error" || block.kind == "text") << "line " << block.line;
}

TEST(Reference, NamesEveryDeclarationOfTheSchema) {
  const std::string page = content("schema/LANGUAGE.md");
  const std::string units = content("schema/units.wale");
  // The page says of a plain number in words that it is one.
  const std::string functions = std::regex_replace(content("schema/functions.wale"), std::regex(": number"), "");
  const auto expect_all = [&](const std::vector<std::string>& names, std::size_t at_least) {
    EXPECT_GE(names.size(), at_least);
    for (const auto& name : names) EXPECT_NE(page.find("`" + name + "`"), std::string::npos) << name;
  };
  expect_all(found_in(units, R"(\nunit (\S+))"), 25);
  expect_all(found_in(units, R"(\ndimension (\w+))"), 15);
  expect_all(found_in(functions, R"(\nfunction ((?:[^=]|= )+?\)) =)"), 9);  // with their arguments
  expect_all(found_in(content("schema/percepts.wale"), R"(\npercept (\w+))"), 11);
  const auto names_in_code = [&](const std::string& name) {  // as in `min(a, b)`
    return page.find("`" + name + "(") != std::string::npos || page.find("`" + name + "`") != std::string::npos;
  };
  const auto built_in =
      found_in(content("compiler/expression/builtin_functions.cpp"), R"row(\n      \{"(\w+)", \{")row");
  EXPECT_GE(built_in.size(), 26u);
  for (const auto& name : built_in) EXPECT_TRUE(names_in_code(name)) << name;
  for (const auto& level : found_in(content("library/levels.wale"), R"(\n  (\w+) +[0-9.]+)"))
    EXPECT_NE(page.find(" " + level + " "), std::string::npos) << level;
}

}  // namespace
}  // namespace wale::reference_test
