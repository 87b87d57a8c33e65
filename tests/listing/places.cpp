// Instructions carry the line of the Wale file that they come from.

#include <gtest/gtest.h>

#include <fstream>

#include "schema/patch_program_format.hpp"
#include "tests/listing/opening.hpp"
#include "tests/temporary_folder.hpp"

namespace wale::listing::places_test {
namespace {

namespace fs = std::filesystem;

/// The lines that the instructions of a section come from, sorted and without repetition.
std::vector<std::uint32_t> lines_of(const PatchProgram& program, CodeSection section, std::size_t index,
                                    const std::string& file) {
  std::vector<std::uint32_t> lines;
  for (std::size_t i = 0; i < program.code(section, index).size(); ++i) {
    const auto place = program.place_of(section, index, i);
    EXPECT_TRUE(place) << i;
    if (!place) continue;
    EXPECT_EQ(place->file, file);
    lines.push_back(place->line);
  }
  std::ranges::sort(lines);
  const auto twice = std::ranges::unique(lines);
  lines.erase(twice.begin(), twice.end());
  return lines;
}

TEST(Places, AreThoseOfTheAuthorsOwnFile) {
  const TemporaryFolder folder;
  const File file(folder.write("m.wale",
                               "wale 1\n"
                               "import std.friction\n"
                               "\n"
                               "function twice(k) = 2 * k\n"
                               "material m {\n"
                               "  perceptual { roughness 0.5 }\n"
                               "  physical {\n"
                               "    param k = 3 N/m in 0 N/m .. 9 N/m\n"
                               "    height h = grating(x, period: 3 mm)\n"
                               "    force texture = lateral(h)\n"
                               "    force pull = -twice(k) * hand\n"
                               "    force drag = viscous(2 N s/m)\n"
                               "  }\n"
                               "}\n"));
  const Program compiled = file.program("m");
  const PatchProgram& program = compiled.description();
  // The height's slope, the three layers, and their sum on the material's line.
  EXPECT_EQ(lines_of(program, CodeSection::tick, 0, "m.wale"), (std::vector<std::uint32_t>{5, 9, 10, 11, 12}));
  // The amplitude is solved on the line of the percept, and 2 * k is computed on line 4.
  const auto setup = lines_of(program, CodeSection::setup, 0, "m.wale");
  for (const std::uint32_t line : {4u, 6u}) EXPECT_TRUE(std::ranges::binary_search(setup, line)) << line;
  EXPECT_EQ(program.place_of(CodeSection::prediction, 0, 0)->file, "minsky1995.wale");
}

TEST(Places, OfAnImportedMaterialGoByTheModulesName) {
  const TemporaryFolder folder;
  folder.write("cloth/base.wale",
               "wale 1\nmaterial base {\n  physical {\n    param k = 3 N/m in 0 N/m .. 9 N/m\n    force = -k * hand\n"
               "  }\n}\n");
  const File file(folder.write("m.wale", "wale 1\nimport cloth.base\nmaterial m = base(k: 4 N/m) { }\n"));
  const Program program = file.program("m");
  const auto place = program.description().place_of(CodeSection::tick, 0, 0);
  EXPECT_EQ(place, (SourceLine{"cloth.base", 5}));
}

TEST(Places, DoNotDependOnTheFolder) {
  const TemporaryFolder one, other;
  const std::string base =
      "wale 1\nmaterial base {\n  physical {\n    force = -3 N/m * hand + lateral(grating(x, period: 2 mm), "
      "amplitude: 1 N)\n  }\n}\n";
  const std::string text =
      "wale 1\nimport cloth.base\nmaterial m = base\nmaterial n { physical { force = viscous(2 N s/m) } }\n";
  one.write("cloth/base.wale", base);
  other.write("deeper/still/cloth/base.wale", base);
  const File first(one.write("m.wale", text)), second(other.write("deeper/still/m.wale", text));
  for (const char* material : {"m", "n"}) {
    EXPECT_EQ(write_patch_program(first.program(material).description()),
              write_patch_program(second.program(material).description()));
    EXPECT_EQ(first.stage(material, BuildStage::listing), second.stage(material, BuildStage::listing));
  }
}

TEST(Places, OfAllThatIsShippedAreKnown) {
  for (const auto& path : shipped_files()) {
    const File file(path);
    for (const auto& material : materials_of(file.opened)) {
      const Program compiled = file.program(material);
      const PatchProgram& program = compiled.description();
      for (const auto& [section, index] : patch_program_format::code_of(program)) {
        for (std::size_t i = 0; i < program.code(section, index).size(); ++i) {
          const auto place = program.place_of(section, index, i);
          ASSERT_TRUE(place) << path << " " << material;
          ASSERT_GT(place->line, 0u);
          // Only predictions of percepts name a file of the language.
          if (section != CodeSection::prediction) {
            EXPECT_NE(place->file, "functions.wale") << material;
            EXPECT_FALSE(place->file.starts_with("std.") && fs::path(path).stem() == "corduroy") << material;
          }
        }
      }
    }
  }
}

}  // namespace
}  // namespace wale::listing::places_test
