#include <gtest/gtest.h>

#include "compiler/compile.hpp"
#include "compiler/diagnostics/render.hpp"
#include "compiler/image/image.hpp"
#include "compiler/text/embedded_files.hpp"
#include "compiler/text/resolver.hpp"
#include "library/pictures/slate_heights.hpp"

namespace wale::slate_test {
namespace {

TEST(Slate, ThePictureIsThatOfItsProgram) {
  auto file = read_file(std::string(WALE_SOURCE_DIR) + "/library/stone/slate.png");
  ASSERT_TRUE(file);
  const auto read = read_height_image(std::as_bytes(std::span(file->bytes)), "slate.png", 0);
  ASSERT_TRUE(read);
  const HeightTable& table = read->table;
  EXPECT_EQ(table.width, SlateHeights::side);
  EXPECT_EQ(table.height, SlateHeights::side);
  EXPECT_EQ(table.heights, SlateHeights::draw());
}

TEST(Slate, TheEmbeddedFilesAreTheShippedOnes) {
  EXPECT_FALSE(embedded_assets().empty());
  for (const auto files : {embedded_files(), embedded_assets()})
    for (const EmbeddedFile& embedded : files) {
      const auto file = read_file(std::string(WALE_SOURCE_DIR) + "/" + std::string(embedded.name));
      ASSERT_TRUE(file) << embedded.name;
      EXPECT_TRUE(file->bytes == embedded.text) << embedded.name;
    }
}

TEST(Slate, HasItsPictureWithoutTheLibrarysFolder) {
  SourceSet sources;
  Diagnostics diagnostics;
  const auto resolver = file_resolver({});
  const SourceId source =
      sources.add("/nowhere/mine.wale", "wale 1\nmaterial mine { representative { like \"riven slate\" } }\n");
  const auto program = compile(sources, source, "mine", default_device, *resolver, diagnostics);
  ASSERT_TRUE(program) << render_text(diagnostics.all().front(), sources, false);
  ASSERT_EQ(program->description().tables.size(), 1u);
  EXPECT_EQ(program->description().tables.front().width, SlateHeights::side);
}

}  // namespace
}  // namespace wale::slate_test
