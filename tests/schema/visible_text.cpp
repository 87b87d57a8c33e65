// Texts for terminals: by the numbers of the characters in Unicode's tables, not by the code.

#include "schema/visible_text.hpp"

#include <gtest/gtest.h>

#include "tests/schema/example_program.hpp"

namespace wale {
namespace {

TEST(VisibleText, LeavesTextOfAllLanguagesAlone) {
  for (const char* text :
       {"", "corduroy", "Cord, großgerippt", "コーデュロイ", "कॉरडरॉय", "קורדרוי", "👁‍🗨", "a\\u001b"})
    EXPECT_EQ(visible_text(text), text);
}

TEST(VisibleText, ShowsWhatTerminalsObey) {
  EXPECT_EQ(visible_text("a\x1b[31mb"), "a\\u001b[31mb");
  EXPECT_EQ(visible_text("\a\b\t\n\r\x7f"), "\\u0007\\u0008\\u0009\\u000a\\u000d\\u007f");
  EXPECT_EQ(visible_text("\u009b31m"), "\\u009b31m") << "CSI in one character";
  EXPECT_EQ(visible_text("\u0085"), "\\u0085") << "next line";
  EXPECT_EQ(visible_text("\u2028\u2029"), "\\u2028\\u2029");
  for (const char* turns : {"\u061c", "\u200e", "\u200f", "\u202a", "\u202b", "\u202c", "\u202d", "\u202e", "\u2066",
                            "\u2067", "\u2068", "\u2069"})
    EXPECT_EQ(visible_text(turns).size(), 6u) << turns;
}

TEST(VisibleText, ReplacesWhatIsNotUtf8) {
  EXPECT_EQ(visible_text("a\xff"), "a\uFFFD");
  EXPECT_EQ(visible_text("\xc3("), "\uFFFD(");
  EXPECT_EQ(visible_text("\xc0\x8a"), "\uFFFD\uFFFD") << "an overlong line break";
  EXPECT_EQ(visible_text("\xed\xa0\x80"), "\uFFFD\uFFFD\uFFFD") << "a surrogate";
  EXPECT_EQ(visible_text("\x9b"), "\uFFFD") << "CSI of terminals for Latin-1";
}

TEST(VisibleText, OfSeveralLinesKeepsThem) {
  EXPECT_EQ(visible_lines("a\n\tb\r\nc\rd\x1b"), "a\n b\nc\\u000dd\\u001b");
  EXPECT_EQ(visible_text(visible_text("\n\xff")), visible_text("\n\xff"));
}

TEST(VisibleText, OfAProgramIsVisibleEverywhere) {
  PatchProgram program = example::program();
  const PatchProgram honest = program;
  make_visible(program);
  EXPECT_EQ(program, honest);
  program.material = program.device.name = "a\nb";
  program.parameters.at(0).name = program.parameters.at(0).description = "\x1b";
  program.layers.documentation = "two\nlines\x1b";
  make_visible(program);
  EXPECT_EQ(program.material, "a\\u000ab");
  EXPECT_EQ(program.device.name, "a\\u000ab");
  EXPECT_EQ(program.parameters.at(0).name, "\\u001b");
  EXPECT_EQ(program.parameters.at(0).description, "\\u001b");
  EXPECT_EQ(program.layers.documentation, "two\nlines\\u001b");
}

}  // namespace
}  // namespace wale
