// Files are read on all cores. The results are the same, and in the same order, as when files are read one by one. Run
// this with the preset `tsan` too.

#include <gtest/gtest.h>

#include <fstream>

#include "compiler/compare/compare_files.hpp"
#include "compiler/modules/load_modules.hpp"

namespace wale::compare_files_test {
namespace {

const std::string library = std::string(WALE_SOURCE_DIR) + "/library/";

const Declarations& known() {
  static const auto common = common_modules();
  return common->declarations;
}

/// The cues, computed one file and one material at a time.
std::vector<Cues> one_by_one(const std::vector<std::string>& names) {
  std::vector<Cues> all;
  for (const std::string& name : names) {
    const auto [file, material] = named_material(name);
    OpenedFile opened = *open_file({file});
    for (const std::string& each : material.empty() ? materials_of(opened) : std::vector{material})
      all.push_back(cues_of(Bank(*compile_opened(opened, {file}, each, opened.diagnostics)), known()));
  }
  return all;
}

// `denim` of two files is told apart by the file; what has a name of its own keeps it.
TEST(ComparedFiles, AreNamedWhereTwoHaveAMaterialOfOneName) {
  const std::string copy = testing::TempDir() + "another_denim.wale", denim = library + "fabric/denim.wale";
  std::ofstream(copy) << "wale 1\nmaterial denim { perceptual { roughness 0.3 } }\n";
  const auto files = read_cues({denim + ":denim", copy, library + "fluid/oil.wale:oil", copy}, {}, known());
  EXPECT_EQ(files.at(0).cues.at(0).material, "denim (" + denim + ")");
  EXPECT_EQ(files.at(1).cues.at(0).material, "denim (" + copy + ")");
  EXPECT_EQ(files.at(2).cues.at(0).material, "oil");
}

TEST(ComparedFiles, AreReadAsOneAfterTheOther) {
  // Files that import one another, a file with several materials, and the same file twice. None reads a picture, since
  // the thread sanitizer reports races in OpenImageIO, which is built without it.
  const std::vector<std::string> names = {library + "fabric/workwear.wale", library + "fabric/velvet.wale",
                                          library + "fabric/canvas.wale",   library + "fabric/denim.wale:denim",
                                          library + "fluid/oil.wale",       library + "fabric/workwear.wale"};
  const std::vector<Cues> expected = one_by_one(names);
  for (int again = 0; again < 2; ++again) {
    const std::vector<ComparedFile> files = read_cues(names, {}, known());
    ASSERT_EQ(files.size(), names.size());
    EXPECT_TRUE(comparable(files));
    std::vector<Cues> all;
    for (const ComparedFile& file : files) all.insert(all.end(), file.cues.begin(), file.cues.end());
    ASSERT_EQ(all.size(), expected.size());
    for (std::size_t i = 0; i < all.size(); ++i) {
      EXPECT_EQ(all[i].material, expected[i].material);
      EXPECT_EQ(all[i].values, expected[i].values) << all[i].material << ": the same bits";
    }
  }
}

TEST(ComparedFiles, HaveTheirErrorsEach) {
  const std::vector<ComparedFile> files =
      read_cues({library + "fabric/denim.wale:velvet", "nowhere.wale", library + "sandpaper/perlin.wale",
                 library + "fabric/denim.wale:denim"},
                {}, known());
  ASSERT_EQ(files.size(), 4u);
  EXPECT_TRUE(files[0].opened->diagnostics.has_errors());
  EXPECT_TRUE(files[0].cues.empty());
  ASSERT_FALSE(files[1].opened);
  EXPECT_EQ(files[1].opened.error().place.name, "nowhere.wale");
  EXPECT_TRUE(files[2].without_material());
  EXPECT_EQ(files[3].cues.size(), 1u);
  EXPECT_EQ(comparable(files).error().code, Code::unknown_material);
}

TEST(ComparedFiles, AreComparedOnOneDevice) {
  std::vector<ComparedFile> files(2);
  files[0].cues = {{"a", "sandpaper", {}}};
  files[1].cues = {{"b", "falcon", {}}};
  EXPECT_EQ(comparable(files).error().sentence, "`a` is built for `sandpaper` and `b` for `falcon`");
}

}  // namespace
}  // namespace wale::compare_files_test
