// `wale build --emit`: the results of the compiler's stages as text.

#include <gtest/gtest.h>

#include "tests/command_line/running.hpp"

namespace wale::command_line::stages_test {
namespace {

TEST(Emit, WritesEachStageToStandardOutputOrAFile) {
  const TemporaryFolder folder;
  for (const auto& [stage, part] : {std::pair{"tree", "(material corduroy"},
                                    {"checked", "asks roughness 0.6"},
                                    {"ir", "parameter wale"},
                                    {"listing", "= divide x wale"},
                                    {"cpp", "namespace wale_patch_corduroy {"}}) {
    const Outcome shown = wale({"build", corduroy, "--emit", stage});
    EXPECT_EQ(shown.status, 0) << shown.err;
    EXPECT_TRUE(contains(shown.out, part)) << stage << "\n" << shown.out;
    const std::string path = folder / stage;
    EXPECT_EQ(wale({"build", corduroy, "--emit", stage, "-o", path}).status, 0);
    EXPECT_EQ(bytes_of(path), shown.out);
    const Outcome named = wale({"build", corduroy, "--material", "corduroy", "--emit", stage});
    EXPECT_EQ(named.out, std::string(stage) == "tree" ? "" : shown.out);
  }
}

TEST(Emit, AcceptsAPatchProgramForLaterStages) {
  const TemporaryFolder folder;
  const std::string program = folder / "corduroy.wpp";
  ASSERT_EQ(wale({"build", corduroy, "-o", program}).status, 0);
  for (const char* stage : {"listing", "cpp"})
    EXPECT_EQ(wale({"build", program, "--emit", stage}).out, wale({"build", corduroy, "--emit", stage}).out);
  for (const char* stage : {"tree", "checked", "ir"}) {
    const Outcome refused = wale({"build", program, "--emit", stage});
    EXPECT_EQ(refused.status, 2);
    EXPECT_EQ(refused.out, "");
    EXPECT_TRUE(contains(refused.err, "--emit: a patch program has only the stages listing and cpp")) << refused.err;
  }
}

TEST(Emit, UnknownStagesAndConflictingOptionsAreMisuse) {
  const Outcome unknown = wale({"build", corduroy, "--emit", "assembly"});
  EXPECT_EQ(unknown.status, 2);
  for (const char* stage : {"tree", "checked", "ir", "listing", "cpp"})
    EXPECT_TRUE(contains(unknown.err, stage)) << stage;
  for (const auto& [words, said] : {std::pair{std::vector<std::string>{"--emit", "listing", "--all", "-o", "out"},
                                              "with --all only C++ can be written"},
                                    {{"--live", "all", "-o", "out.hpp"}, "only C++ has live parts"},
                                    {{"--live", "all", "--emit", "ir"}, "only C++ has live parts"},
                                    {{"--live", "roghness", "--emit", "cpp"}, "did you mean `roughness`?"},
                                    {{"--live", "wale,nothing like it", "--emit", "cpp"}, "expected one of"}}) {
    std::vector<std::string> all{"build", corduroy};
    all.insert(all.end(), words.begin(), words.end());
    const Outcome misused = wale(all);
    EXPECT_EQ(misused.status, 2) << testing::PrintToString(words);
    EXPECT_EQ(misused.out, "");
    EXPECT_TRUE(contains(misused.err, said)) << misused.err;
  }
  const Outcome neither = wale({"build", corduroy});
  EXPECT_EQ(neither.status, 2);
  EXPECT_TRUE(contains(neither.err, "expected the name of the file to write")) << neither.err;
}

TEST(Emit, WritesAHeaderForEachMaterial) {
  const TemporaryFolder folder;
  const Outcome one = wale({"build", corduroy, "--all", "--emit", "cpp", "--live", "wale", "-o", folder / "one"});
  EXPECT_EQ(one.status, 0) << one.err;
  EXPECT_EQ(bytes_of(folder / "one/corduroy.hpp"), wale({"build", corduroy, "--emit", "cpp", "--live", "wale"}).out);
  EXPECT_TRUE(contains(one.out, "corduroy.hpp")) << one.out;
}

TEST(Emit, KeepsLivePartsAdjustable) {
  const std::string folded = wale({"build", corduroy, "--emit", "cpp"}).out;
  EXPECT_FALSE(contains(folded, "Setup"));
  EXPECT_FALSE(contains(folded, "struct Parameters"));
  const std::string live = wale({"build", corduroy, "--emit", "cpp", "--live", "roughness"}).out;
  EXPECT_TRUE(contains(live, "float roughness = 0.6f;"));
  EXPECT_FALSE(contains(live, "float wale = "));
  EXPECT_TRUE(contains(live, "inline constexpr float half_width"));
  const std::string all = wale({"build", corduroy, "--emit", "cpp", "--live", "all"}).out;
  EXPECT_TRUE(contains(all, "float wale = 0.0025f;"));
  EXPECT_TRUE(contains(all, "struct Patch {"));
  EXPECT_TRUE(contains(all, "stack while setup runs"));
}

TEST(Emit, StopsAtTheFirstStageWithErrors) {
  const TemporaryFolder folder;
  const std::string open =
      folder.write("open.wale", "wale 1\nmaterial a { physical { force = lateral(grating(x, period: 2 mm)) } }\n");
  const Outcome checked = wale({"build", open, "--emit", "checked"});
  EXPECT_EQ(checked.status, 0) << checked.err;
  EXPECT_TRUE(contains(checked.out, "carrier lateral amplitude = ?0, left open"));
  const Outcome ir = wale({"build", open, "--emit", "ir"});
  EXPECT_EQ(ir.status, 1);
  EXPECT_EQ(ir.out, "");
  EXPECT_TRUE(contains(ir.err, "the size of this force is not given")) << ir.err;
}

}  // namespace
}  // namespace wale::command_line::stages_test
