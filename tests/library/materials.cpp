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

TEST_P(LibraryFile, IsWithoutErrorsAndWarnings) {
  Checked checked(GetParam());
  for (const auto& material : checked.module.materials)
    EXPECT_TRUE(checked.program(material.name).has_value()) << material.name;
  EXPECT_EQ(checked.complaints(), "");
}

TEST_P(LibraryFile, CompilesToTheSameBytesTwice) {
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
}

TEST_P(LibraryFile, SaysWhatItsMaterialsAre) {
  const Checked checked(GetParam());
  for (const auto& [name, entry] : checked.module.declarations().materials.own()) {
    const auto& declared = entry.what;
    if (declared.tree->source != checked.source) continue;
    if (declared.node->name.text == "corduroy") continue;  // the first example, which LANGUAGE.md explains
    EXPECT_NE(declared.node->documentation, "") << declared.node->name.text;
  }
  for (const auto& material : checked.module.materials) {
    std::set<std::string> settings;
    for (const auto& [key, texts] : material.layers.representative) {
      settings.insert(key);
      EXPECT_FALSE(texts.empty() || texts.front().empty()) << material.name << " " << key;
    }
    EXPECT_EQ(settings, (std::set<std::string>{"called", "kind", "title"})) << material.name;
    for (const auto& parameter : material.parameters) {
      EXPECT_NE(parameter.description, "") << material.name << " " << parameter.name;
      EXPECT_LT(parameter.low, parameter.high) << material.name << " " << parameter.name;
    }
    // A texture has a percept, unless its force is fixed, as in library/sandpaper.
    const bool is_texture = !material.carriers.empty();
    const bool is_fixed = std::ranges::none_of(material.carriers, &Carrier::open);
    EXPECT_TRUE(is_texture ? is_fixed || !material.percepts.empty() : material.percepts.empty()) << material.name;
  }
}

TEST_P(LibraryFile, StandsInTheFolderOfItsKind) {
  Checked checked(GetParam());
  const std::string folder = std::filesystem::path(GetParam()).parent_path().filename().string();
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
