// The output of `wale build --emit` for materials of every kind, compared exactly with tests/listing/golden/.
//
// After an intended change of the compiler, write the files again and read the difference before you commit it:
//
//   WALE_UPDATE_GOLDEN=1 build/tests/test_listing --gtest_filter='*Golden*'; git diff tests/listing/golden

#include <gtest/gtest.h>

#include <cstdlib>
#include <fstream>
#include <iterator>

#include "tests/listing/opening.hpp"

namespace wale::listing::golden_test {
namespace {

void compare_with_golden(const std::string& name, const std::string& text) {
  const auto path = std::filesystem::path(WALE_SOURCE_DIR) / "tests/listing/golden" / name;
  if (std::getenv("WALE_UPDATE_GOLDEN")) {
    std::ofstream(path, std::ios::binary) << text;
    GTEST_SKIP() << "written: " << path;
  }
  std::ifstream file(path, std::ios::binary);
  ASSERT_TRUE(file) << path << " is missing";
  const std::string expected{std::istreambuf_iterator<char>(file), {}};
  EXPECT_EQ(text, expected);
}

struct Shown {
  const char* file;
  const char* material;
};

class GoldenListing : public testing::TestWithParam<Shown> {};

TEST_P(GoldenListing, IsAsItWas) {
  const auto& [file, material] = GetParam();
  const File opened((library / file).string());
  compare_with_golden(material + std::string(".listing"), opened.stage(material, BuildStage::listing));
}

INSTANTIATE_TEST_SUITE_P(Library, GoldenListing,
                         testing::Values(Shown{"fabric/corduroy.wale", "corduroy"}, Shown{"fabric/denim.wale", "denim"},
                                         Shown{"fabric/workwear.wale", "workwear"},  // a blend
                                         Shown{"fabric/velvet.wale", "velvet"},      // a nap that leans
                                         Shown{"fluid/oil.wale", "oil"},             // velocity
                                         Shown{"mechanism/spring.wale", "spring"},
                                         Shown{"mechanism/toggle.wale", "toggle"},
                                         Shown{"earth/sand.wale", "sandpit"},  // a memory
                                         Shown{"stone/slate.wale", "slate"},   // an image
                                         Shown{"sandpaper/prototypes.wale", "Viscous"},
                                         Shown{"sandpaper/prototypes.wale", "Nap"},
                                         Shown{"sandpaper/dynamics.wale", "BrickOnASpring"},  // states and marks
                                         Shown{"metal/grille.wale", "grille"}),
                         [](const auto& shown) { return std::string(shown.param.material); });

TEST(GoldenStages, OfCorduroy) {
  const File opened((library / "fabric/corduroy.wale").string());
  compare_with_golden("corduroy.tree", opened.stage("corduroy", BuildStage::tree));
  compare_with_golden("corduroy.checked", opened.stage("corduroy", BuildStage::checked));
  compare_with_golden("corduroy.ir", opened.stage("corduroy", BuildStage::ir));
}

TEST(GoldenStages, OfABrickOnASpring) {
  const File opened((library / "sandpaper/dynamics.wale").string());
  compare_with_golden("BrickOnASpring.checked", opened.stage("BrickOnASpring", BuildStage::checked));
  compare_with_golden("BrickOnASpring.ir", opened.stage("BrickOnASpring", BuildStage::ir));
}

}  // namespace
}  // namespace wale::listing::golden_test
