// What every material of the library is asked for, what it reads, and on what evidence, compared exactly with
// tests/library/feels.txt. No shipped material reads otherwise than asked.
//
// After an intended change, write the file again and read the difference before you commit it:
//
//   WALE_UPDATE_GOLDEN=1 build/tests/test_library --gtest_filter='LibraryFeels*'; git diff tests/library/feels.txt

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <fstream>
#include <iterator>

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

TEST(LibraryFeels, IsAsItWas) {
  const auto common = common_modules();
  const std::filesystem::path root(WALE_SOURCE_DIR);
  std::string text;
  for (const std::string& path : shelf::library_files()) {
    shelf::Checked checked(path);
    for (const auto& material : checked.module.materials) {
      const auto program = checked.program(material.name);
      ASSERT_TRUE(program) << path;
      const Description description = describe(Bank(*program), common->declarations);
      text += fmt::format("{} {}\n", std::filesystem::relative(path, root).string(), material.name);
      for (const DescribedPercept& percept : description.percepts) text += line_of(percept, description);
    }
    for (const Diagnostic& each : checked.diagnostics.all())
      EXPECT_NE(each.code, Code::delivered_otherwise) << path << ": " << each.message;
  }
  const auto golden = root / "tests/library/feels.txt";
  if (std::getenv("WALE_UPDATE_GOLDEN")) {
    std::ofstream(golden, std::ios::binary) << text;
    GTEST_SKIP() << "written: " << golden;
  }
  std::ifstream file(golden, std::ios::binary);
  ASSERT_TRUE(file) << golden << " is missing";
  EXPECT_EQ(text, std::string(std::istreambuf_iterator<char>(file), {}));
}

}  // namespace
}  // namespace wale::feels_test
