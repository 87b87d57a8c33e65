// Every material of the library has no diagnostics, is documented, and compiles to the same bytes every time.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "tests/library/shelf.hpp"

namespace wale::materials_test {
namespace {

using shelf::Checked;
using shelf::library_files;

class LibraryFile : public testing::TestWithParam<std::string> {};

std::string name_of(const testing::TestParamInfo<std::string>& file) {
  const std::filesystem::path path(file.param);
  return path.parent_path().filename().string() + "_" + path.stem().string();
}

std::string folder_of(const std::string& file) {
  return std::filesystem::path(file).parent_path().filename().string();
}

TEST_P(LibraryFile, HasNoComplaintsAndCompilesToTheSameBytesTwice) {
  Checked first(GetParam()), second(GetParam());
  for (const auto& material : first.module.materials) {
    const auto once = first.program(material.name), again = second.program(material.name);
    ASSERT_TRUE(once && again) << material.name;
    const auto bytes = write_patch_program(once->description());
    EXPECT_EQ(bytes, write_patch_program(again->description())) << material.name;
    const auto loaded = Program::load(bytes);
    ASSERT_TRUE(loaded) << in_words(loaded.error());
    EXPECT_EQ(loaded->description(), once->description()) << material.name;
  }
  EXPECT_EQ(first.complaints(), "");
}

TEST_P(LibraryFile, SaysWhatItsMaterialsAre) {
  const Checked checked(GetParam());
  for (const auto& [name, entry] : checked.module.declarations().materials.own()) {
    const auto& declared = entry.what;
    if (declared.tree->source != checked.source) continue;
    EXPECT_NE(declared.node->documentation, "") << declared.node->name.text;
  }
  // The patches of library/sandpaper are those of 1995. All others are what a library takes in (library/CONTRIBUTING.md).
  const bool is_historical = folder_of(GetParam()) == "sandpaper", is_of_a_kind = !is_historical && folder_of(GetParam()) != "std";
  for (const auto& material : checked.module.materials) {
    std::set<std::string> settings;
    bool translated = false;
    for (const auto& [key, texts] : material.layers.representative) {
      translated |= key.starts_with("called ");
      settings.insert(key.substr(0, key.find(' ')));
      EXPECT_FALSE(texts.empty() || texts.front().empty()) << material.name << " " << key;
    }
    settings.erase("feels");
    EXPECT_EQ(translated, !is_historical) << material.name;
    EXPECT_EQ(settings, is_historical ? (std::set<std::string>{"called", "kind", "title"})
                                      : (std::set<std::string>{"called", "kind", "source", "title"}))
        << material.name;
    for (const auto& parameter : material.parameters) {
      EXPECT_NE(parameter.description, "") << material.name << " " << parameter.name;
      EXPECT_LT(parameter.low, parameter.high) << material.name << " " << parameter.name;
    }
    // What carries a percept asks for one, unless its force is fixed.
    const bool is_fixed = std::ranges::none_of(material.carriers, &Carrier::open);
    EXPECT_TRUE(is_fixed || !material.percepts.empty()) << material.name;
    EXPECT_TRUE(!is_of_a_kind || material.carriers.empty() || !material.percepts.empty()) << material.name;
    for (const AskedPercept& asked : material.percepts)
      EXPECT_TRUE(is_historical || asked.evidence || asked.blended || asked.made_at) << material.name << " " << asked.name;
  }
}

TEST_P(LibraryFile, StandsInTheFolderOfItsKind) {
  Checked checked(GetParam());
  const std::string folder = folder_of(GetParam());
  for (const auto& material : checked.module.materials) {
    for (const auto& [key, texts] : material.layers.representative) {
      if (key != "kind") continue;
      EXPECT_EQ(texts.front().substr(0, texts.front().find('.')), folder) << material.name;
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Library, LibraryFile, testing::ValuesIn(library_files()), name_of);

}  // namespace
}  // namespace wale::materials_test
