// The printed stages of small programs, line by line.

#include <gtest/gtest.h>

#include "compiler/cpp/cpp_names.hpp"
#include "compiler/listing/figures.hpp"
#include "compiler/listing/print_program.hpp"
#include "tests/listing/opening.hpp"
#include "tests/schema/example_program.hpp"

namespace wale::listing::stages_test {
namespace {

bool has(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

TEST(Listing, NamesRegistersAndCountsCosts) {
  const std::string text = print_program(example::program());
  EXPECT_TRUE(has(text, "program bench grating for bench")) << text;
  EXPECT_TRUE(has(text, "r36    parameter  period = 0.002 m in 0.001 .. 0.01")) << text;
  EXPECT_TRUE(has(text, "    0  r38 = divide 6.2831855 period")) << text;
  EXPECT_TRUE(has(text, "    1  r39 = peak 0")) << text;
  EXPECT_TRUE(has(text, "    0  r43 = multiply x r38")) << text;
  EXPECT_TRUE(has(text, "    2  r45..r47 = sample x y table 0")) << text;
  EXPECT_TRUE(has(text, "    1  r43..r45 = recall x r46 trace")) << text;
  EXPECT_TRUE(has(text, "force x is r47 within r40 N")) << text;
  EXPECT_TRUE(has(text, "force y is r48 within 5 N")) << text;
  EXPECT_TRUE(has(text, "wear becomes r44 in -1 .. 1")) << text;
  EXPECT_TRUE(has(text, "trace at r43 y becomes r44")) << text;
  EXPECT_TRUE(has(text, "spring in #102030 at x y 0 0 0.5")) << text;
  EXPECT_TRUE(has(text, "std.grain:70000")) << text;
  // multiply, cosine, multiply, multiply, subtract, limit, limit
  EXPECT_TRUE(has(text, "tick: 7 instructions, cost 16")) << text;
  // divide 4, limit 2, divide 4, and 4096 points of multiply, cosine, multiply and absolute, plus one for each point
  EXPECT_TRUE(has(text, std::to_string(4 + 2 + 4 + 4096 * (1 + 8 + 1 + 1 + 1)) + " a change of parameters")) << text;
}

TEST(Listing, ShowsIntervalsThatAreHandedIn) {
  const std::string text =
      print_program(example::program(), [](CodeSection section, std::size_t, std::size_t instruction) {
        return section == CodeSection::tick && instruction == 1 ? std::optional<std::string>("-1 .. 1") : std::nullopt;
      });
  const std::size_t at = text.find("[-1 .. 1]");
  ASSERT_NE(at, std::string::npos);
  EXPECT_EQ(text.find("[-1 .. 1]", at + 1), std::string::npos);
  const std::string line = text.substr(text.rfind('\n', at) + 1, at - text.rfind('\n', at));
  EXPECT_TRUE(has(line, "r44 = cosine r43")) << line;
}

TEST(Figures, AreTheShortestWithTheSameValue) {
  EXPECT_EQ(figure(0.1f), "0.1");
  EXPECT_EQ(figure(0.1), "0.1");
  EXPECT_EQ(figure(-2.0f), "-2");
  EXPECT_EQ(figure(16777216.0f), "16777216");
}

TEST(CppNames, AreLegalAndDifferent) {
  CppNames names;
  EXPECT_EQ(names.take("wale"), "wale");
  EXPECT_EQ(names.take("wale"), "wale_2");
  EXPECT_EQ(names.take("double"), "double_2");
  EXPECT_EQ(names.take("t12"), "t12_value");
  EXPECT_EQ(names.take("a.b"), "a_b");
  EXPECT_EQ(names.take("7up"), "v7up");
  EXPECT_EQ(names.take("\xc3\xa4__x"), "v_x");
}

TEST(Stages, AnUnknownMaterialIsAnErrorAfterTheTree) {
  const File file((library / "fabric/corduroy.wale").string());
  EXPECT_TRUE(has(file.stage("", BuildStage::tree), "(material corduroy\n"));
  Diagnostics diagnostics;
  const auto checked = build_stage(file.opened, file.request, "velours", BuildStage::checked, diagnostics);
  ASSERT_TRUE(checked);
  EXPECT_FALSE(checked->has_value());
  EXPECT_EQ(diagnostics.error_count(), 1u);
}

}  // namespace
}  // namespace wale::listing::stages_test
