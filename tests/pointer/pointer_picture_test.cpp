#include "runtime/device/pointer/pointer_picture.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

namespace wale::test::pointer_picture {
namespace {

using namespace pointer;

/// The contents of a terminal: one character of UTF-8 per cell.
std::vector<std::vector<std::string>> shown(const std::string& text, int columns, int rows) {
  std::vector<std::vector<std::string>> screen(static_cast<std::size_t>(rows),
                                               std::vector<std::string>(static_cast<std::size_t>(columns)));
  std::size_t row = 0, column = 0;
  for (std::size_t i = 0; i < text.size();) {
    if (text[i] == '\033') {
      const std::size_t semicolon = text.find(';', i), end = text.find('H', i);
      row = std::stoul(text.substr(i + 2, semicolon - i - 2)) - 1;
      column = std::stoul(text.substr(semicolon + 1, end - semicolon - 1)) - 1;
      i = end + 1;
      continue;
    }
    const auto first = static_cast<unsigned char>(text[i]);
    const std::size_t bytes = first < 0x80 ? 1 : first < 0xe0 ? 2 : 3;
    screen.at(row).at(column++) = text.substr(i, bytes);
    i += bytes;
  }
  return screen;
}

bool is_braille(const std::string& cell) { return cell.size() == 3 && cell[0] == '\xe2' && (cell[1] & 0x7c) == 0x20; }

TEST(PointerPicture, TheWorkspaceFitsAboveTheLastLine) {
  const WorkspaceView view(0.2, 80, 24, 2);
  // 23 rows of cells twice as high as wide: 46 widths for 200 mm.
  EXPECT_NEAR(view.cells({0.1, 0}).x - view.cells({0, 0}).x, 23, 1e-9);
  EXPECT_NEAR(view.cells({0, 0.1}).y, 0, 1e-9);
  EXPECT_NEAR(view.cells({0, -0.1}).y, 23, 1e-9);
  for (const glm::dvec2 place : {glm::dvec2(0.03, -0.07), glm::dvec2(-0.1, 0.1)}) {
    const glm::dvec2 back = view.place(view.cells(place));
    EXPECT_NEAR(back.x, place.x, 1e-12);
    EXPECT_NEAR(back.y, place.y, 1e-12);
  }
  const WorkspaceView narrow(0.2, 20, 100, 2);
  EXPECT_NEAR(narrow.cells({0.1, 0}).x, 20, 1e-9);
}

TEST(PointerPicture, ShowsHandPatchAndForce) {
  const WorkspaceView view(0.2, 80, 24, 2);
  PointerScene scene{0.2, {0.1, 0.1}, {0.02, -0.02}, {5, 0}, 10};
  const auto screen = shown(draw(scene, view), 80, 24);
  const auto at = [&](double x, double y) {
    const glm::dvec2 cell = view.cells({x, y});
    return screen[static_cast<std::size_t>(cell.y)][static_cast<std::size_t>(cell.x)];
  };
  EXPECT_EQ(at(0.02, -0.02), "●");
  // Half of the full force is half of a third of the workspace: 33 mm to the right.
  EXPECT_TRUE(is_braille(at(0.04, -0.02)));
  EXPECT_TRUE(is_braille(at(0.052, -0.02)));
  EXPECT_EQ(at(0.0, -0.02), " ") << "no force to the left";
  EXPECT_TRUE(is_braille(at(-0.05, 0.0))) << "the patch's edge";
  EXPECT_TRUE(is_braille(at(-0.0999, 0.0))) << "the workspace's edge";
  EXPECT_EQ(at(0.0, 0.02), " ");
  std::string words;
  for (const std::string& cell : screen[0]) words += cell;
  EXPECT_EQ(words.find(" 5.00 N to the right, 0.00 N away: drawn, not felt"), 0u) << words;
  for (std::size_t row = 0; row < 23; ++row) {
    for (const std::string& cell : screen[row]) ASSERT_FALSE(cell.empty()) << "every cell is written";
  }
  for (const std::string& cell : screen[23]) EXPECT_TRUE(cell.empty()) << "the last line is left to others";
}

TEST(PointerPicture, DrawsExtremeValues) {
  const double strange[] = {0, -1, 1e300, -1e300, std::nan(""), HUGE_VAL};
  for (const double value : strange) {
    for (const int size : {-5, 0, 1, 3, 5000}) {
      PointerScene scene{0.2, {0.1, 0.1}, {value, -value}, {value, value}, 10};
      EXPECT_FALSE(draw(scene, WorkspaceView(0.2, size, size / 2, value)).empty());
    }
  }
}

}  // namespace
}  // namespace wale::test::pointer_picture
