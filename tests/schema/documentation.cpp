// schema/PATCH_PROGRAM.md against the tables in the code.

#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

#include "schema/patch_program_format.hpp"
#include "tests/schema/example_program.hpp"
#include "tests/schema/wpp_bytes.hpp"
#include "wale/instruction.hpp"

namespace wale::documentation_test {
namespace {

std::vector<std::string> lines_of_documentation() {
  std::ifstream file(WALE_SOURCE_DIR "/schema/PATCH_PROGRAM.md");
  std::vector<std::string> lines;
  for (std::string line; std::getline(file, line);) lines.push_back(line);
  return lines;
}

std::string row(int number, std::string name, std::string fields, int results, int cost, std::string meaning) {
  std::ostringstream row;
  row << "| " << number << " | " << name << " | `" << fields << "` | " << results << " | " << cost << " | " << meaning
      << " |";
  return row.str();
}

TEST(Documentation, ListsEveryInstruction) {
  const std::vector<std::string> expected = {
// clang-format off
#define INSTRUCTION(number, name, fields, results, cost, meaning, range, derivative) \
      row(number, #name, fields, results, cost, "`" #meaning "`"),
#define SPECIAL(number, name, fields, results, cost) row(number, #name, fields, results, cost, "see below"),
#include "wale/instruction.def"
      // clang-format on
  };
  const std::vector<std::string> lines = lines_of_documentation();
  const std::string header = "| number | name | fields | results | cost | meaning |";
  const auto table = std::find(lines.begin(), lines.end(), header);
  ASSERT_NE(table, lines.end());
  std::vector<std::string> found;
  for (auto line = table + 2; line < lines.end() && line->starts_with("|"); ++line) found.push_back(*line);
  EXPECT_EQ(found, expected);
}

TEST(Documentation, ListsEverySectionInOrder) {
  std::vector<std::string> expected;
  for (const auto& section : patch_program_format::section_kinds) {
    expected.push_back("| `" + std::string(section.name) + "` | " + (section.required ? "yes" : "no") + " |");
  }
  std::vector<std::string> found;
  for (const std::string& line : lines_of_documentation()) {
    const std::size_t end = line.find(" |", 11);
    if (line.starts_with("| `") && line.substr(7, 4) == "` | ") found.push_back(line.substr(0, end + 2));
  }
  EXPECT_EQ(found, expected);
}

// The numbers of the format's first version, written by hand, since they never change.
TEST(Documentation, NumbersNeverChange) {
  const std::vector<std::string_view> names = {"add",     "subtract", "multiply",   "divide",      "negate", "absolute",
                                               "minimum", "maximum",  "floor",      "square_root", "less",   "select",
                                               "sine",    "cosine",   "exp2",       "log2",        "normal", "limit",
                                               "sample",  "peak",     "arctangent", "hash",        "recall", "cell"};
  EXPECT_FALSE(operation_facts(0));
  for (unsigned number = 1; number <= names.size(); ++number) {
    ASSERT_TRUE(operation_facts(number));
    EXPECT_EQ(operation_facts(number)->name, names[number - 1]);
  }
}

}  // namespace
}  // namespace wale::documentation_test
