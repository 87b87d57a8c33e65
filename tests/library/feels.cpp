// What every material of the library is asked for, what it reads, and on what evidence, compared exactly with
// tests/library/feels.txt. No shipped material reads otherwise than asked. One in three of the kinds is read; with
// WALE_ALL_MATERIALS in the environment, all.
//
// After an intended change, write the file again and read the difference before you commit it:
//
//   WALE_UPDATE_GOLDEN=1 WALE_ALL_MATERIALS=1 build/tests/test_library --gtest_filter='LibraryFeels*'; git diff tests/library/feels.txt

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>
#include <string>

#include "compiler/describe/describe.hpp"
#include "compiler/modules/load_modules.hpp"
#include "tests/library/shelf.hpp"

namespace wale::feels_test {
namespace {

std::string line_of(const DescribedPercept& percept, const Description& description) {
  std::string line = fmt::format("  {} asked {} reads {:.2f} {}", percept.name,
                                 percept.asked ? fmt::format("{:.2f}", *percept.asked) : "nothing", percept.level,
                                 evidence_word(percept.evidence()));
  for (const DescribedFate& fate : description.fates)
    if (fate.record.percept && fate.record.name == percept.name)
      line += fmt::format(", {}{}{}", fate_word(fate.record.fate), fate.record.reason.empty() ? "" : ": ",
                          fate.record.reason);
  for (const OutsideRange& outside : percept.outside) line += fmt::format("; {}", in_words(outside));
  return line + (percept.domain_why.empty() ? "" : "; " + percept.domain_why) + "\n";
}

/// The lines of each material, by the line that names it.
std::map<std::string, std::string> blocks_of(const std::filesystem::path& golden) {
  std::map<std::string, std::string> blocks;
  std::ifstream file(golden, std::ios::binary);
  std::string* block = nullptr;
  for (std::string line; std::getline(file, line);)
    if (line.starts_with("  ") && block)
      *block += line + "\n";
    else
      block = &blocks[line];
  return blocks;
}

TEST(LibraryFeels, IsAsItWas) {
  const auto common = common_modules();
  const std::filesystem::path root(WALE_SOURCE_DIR);
  const std::filesystem::path golden = root / "tests/library/feels.txt";
  const bool updates = std::getenv("WALE_UPDATE_GOLDEN") != nullptr;
  const std::map<std::string, std::string> written = blocks_of(golden);
  std::string text;
  for (const std::string& path : shelf::sampled_files(3, 2)) {
    shelf::Checked checked(path);
    for (const auto& material : checked.module.materials) {
      const auto program = checked.program(material.name);
      ASSERT_TRUE(program) << path;
      const Description description = describe(Bank(*program), common->declarations);
      const std::string heading =
          fmt::format("{} {}", std::filesystem::relative(path, root).string(), material.name);
      std::string lines;
      for (const DescribedPercept& percept : description.percepts) lines += line_of(percept, description);
      text += heading + "\n" + lines;
      if (updates) continue;
      const auto known = written.find(heading);
      if (known == written.end())
        ADD_FAILURE() << heading << " is not in " << golden;
      else
        EXPECT_EQ(lines, known->second) << heading;
    }
    for (const Diagnostic& each : checked.diagnostics.all())
      EXPECT_NE(each.code, Code::delivered_otherwise) << path << ": " << each.message;
  }
  if (!updates) {
    // Then nothing may be written of materials that are no more.
    if (std::getenv("WALE_ALL_MATERIALS")) {
      std::ifstream file(golden, std::ios::binary);
      EXPECT_EQ(text, std::string(std::istreambuf_iterator<char>(file), {}));
    }
    return;
  }
  ASSERT_TRUE(std::getenv("WALE_ALL_MATERIALS")) << "only with WALE_ALL_MATERIALS, since all of it is written";
  std::ofstream(golden, std::ios::binary) << text;
  GTEST_SKIP() << "written: " << golden;
}

}  // namespace
}  // namespace wale::feels_test
