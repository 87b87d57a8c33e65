#include <gtest/gtest.h>

#include "compiler/image/image.hpp"
#include "compiler/text/resolver.hpp"
#include "library/stone/slate_heights.hpp"

namespace wale::slate_test {
namespace {

TEST(Slate, ThePictureIsWhatItsProgramDraws) {
  auto file = read_file(std::string(WALE_SOURCE_DIR) + "/library/stone/slate.png");
  ASSERT_TRUE(std::holds_alternative<ResolvedFile>(file));
  const auto read = read_height_image(std::as_bytes(std::span(std::get<ResolvedFile>(file).bytes)), "slate.png", 0);
  ASSERT_TRUE(std::holds_alternative<HeightImage>(read));
  const HeightTable& table = std::get<HeightImage>(read).table;
  EXPECT_EQ(table.width, SlateHeights::side);
  EXPECT_EQ(table.height, SlateHeights::side);
  EXPECT_EQ(table.heights, SlateHeights::draw());
}

}  // namespace
}  // namespace wale::slate_test
