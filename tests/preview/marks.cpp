// Colours, marks, and the state of a program after a rehearsal.

#include "compiler/preview/marks.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "compiler/measure/rehearsal.hpp"
#include "compiler/modules/load_modules.hpp"
#include "compiler/preview/exhibit.hpp"
#include "compiler/preview/preview.hpp"
#include "tests/preview/hand_made.hpp"

namespace wale::marks_test {
namespace {

// The picture's square on the page, in pixels, shows the patch's 80 mm.
constexpr int picture_left = 64, picture_top = 196, picture_side = 580;
constexpr double side = 0.08;

struct Pixel {
  int red, green, blue;
};

/// The pixel at a place of the patch, in m.
Pixel at(const Drawing& drawing, double x, double y) {
  const int column = picture_left + static_cast<int>(std::floor((x / side + 0.5) * picture_side)),
            row = picture_top + static_cast<int>(std::floor((0.5 - y / side) * picture_side));
  const auto* p = &drawing.rgb[static_cast<std::size_t>((row * drawing.width + column) * 3)];
  return {p[0], p[1], p[2]};
}

bool is_red(Pixel p) { return p.red > 180 && p.green < 60 && p.blue < 60; }

/// The number of the picture's pixels in the red of the marks; nothing else on the page is red.
int count_red(const Drawing& drawing) {
  int count = 0;
  for (int y = 0; y < picture_side; ++y)
    for (int x = 0; x < picture_side; ++x)
      count += is_red(at(drawing, ((x + 0.5) / picture_side - 0.5) * side, (0.5 - (y + 0.5) / picture_side) * side));
  return count;
}

/// The hand that strokes a program before it is drawn.
const HandDeclaration* showing_hand() { return common_modules()->declarations.hands.find("showing"); }

Drawing draw(const Bank& bank) { return draw_preview(bank, {}, common_modules()->declarations)->page->pixels(); }

/// Only the marks, at their places on the page, on white. It is faster than a page.
Drawing marks_of(const Bank& bank) {
  const auto page = *new_canvas(picture_left + picture_side + 60, picture_top + picture_side + 60, {1, 1, 1});
  const Rehearsal rehearsal = rehearse(bank, showing_hand());
  const PageBox box = {picture_left, picture_top, picture_left + picture_side, picture_top + picture_side};
  draw_marks(*page, box, {.side = side}, rehearsal);
  return page->pixels();
}

constexpr std::uint32_t red = 0xd01010;

/// A patch without relief or force that shows one mark of constant values.
Bank still(MarkKind kind, std::vector<float> values) {
  HandMade made;
  made.program.picture.relief = made.constant(0);
  Mark mark{.kind = kind, .operands = {}, .colour = red};
  for (std::size_t i = 0; i < values.size(); ++i) mark.operands[i] = made.constant(values[i]);
  made.program.picture.marks = {mark};
  made.push(made.constant(0), made.constant(0), 1);
  return made.bank();
}

/// A program with a state that begins at 0 and increases by `each_tick` (m) per tick, and a mark whose operand
/// `operand` is that state.
Bank moving(float each_tick, MarkKind kind, std::vector<float> values, std::size_t operand) {
  HandMade made;
  const auto zero = made.constant(0), step = made.constant(each_tick);
  made.program.picture.relief = zero;
  const auto state = made.add_state({.name = "s", .low = -0.04f, .high = 0.04f, .initial = zero, .next = zero});
  made.program.states[0].next = made.add(made.program.tick, Operation::add, state, step);
  Mark mark{.kind = kind, .operands = {}, .colour = red};
  for (std::size_t i = 0; i < values.size(); ++i) mark.operands[i] = i == operand ? state : made.constant(values[i]);
  made.program.picture.marks = {mark};
  made.push(zero, zero, 1);
  return made.bank();
}

TEST(Marks, AreWhereTheirPlacesAre) {
  const Drawing point = draw(still(MarkKind::point, {0.02f, 0.01f, 0.006f}));
  EXPECT_TRUE(is_red(at(point, 0.02, 0.01)));
  EXPECT_TRUE(is_red(at(point, 0.023, 0.01)));    // its radius is 3 mm
  EXPECT_FALSE(is_red(at(point, 0.0215, 0.01)));  // so large a point is a ring, which covers nothing
  EXPECT_FALSE(is_red(at(point, 0.0237, 0.01)));
  const Drawing dot = draw(still(MarkKind::point, {0.02f, 0.01f, 0.003f}));
  EXPECT_TRUE(is_red(at(dot, 0.0212, 0.01)));    // a small one is a dot
  EXPECT_FALSE(is_red(at(point, 0.02, -0.01)));  // y goes up

  const Drawing circle = marks_of(still(MarkKind::circle, {0, 0, 0.02f}));
  EXPECT_FALSE(is_red(at(circle, 0, 0)));
  for (const double angle : {0.3, 1.9, 4.0})
    EXPECT_TRUE(is_red(at(circle, 0.02 * std::cos(angle), 0.02 * std::sin(angle)))) << angle;

  const Drawing line = marks_of(still(MarkKind::line, {-0.03f, -0.02f, 0.03f, 0.02f}));
  EXPECT_TRUE(is_red(at(line, 0.015, 0.01)));
  EXPECT_FALSE(is_red(at(line, 0.015, -0.01)));
}

TEST(Marks, ABoxTurnsCounterclockwise) {
  const float eighth = static_cast<float>(pi / 4);
  const Drawing level = marks_of(still(MarkKind::box, {0, 0, 0.04f, 0.008f, 0})),
                turned = marks_of(still(MarkKind::box, {0, 0, 0.04f, 0.008f, eighth}));
  EXPECT_TRUE(is_red(at(level, 0.02, 0)));
  EXPECT_TRUE(is_red(at(level, 0.01, 0.004)));
  EXPECT_FALSE(is_red(at(level, 0.01, 0))) << "what it marks stays visible";
  const double end = 0.02 * std::sqrt(0.5);
  EXPECT_TRUE(is_red(at(turned, end, end)));
  EXPECT_FALSE(is_red(at(turned, end, -end)));
  EXPECT_FALSE(is_red(at(turned, 0.02, 0)));
  // An edge of 3 pixels around 40 mm by 8 mm, at 580 pixels for 80 mm.
  const double edge = 3 * 2 * (0.04 + 0.008) * picture_side / side;
  for (const Drawing* drawing : {&level, &turned}) {
    EXPECT_LT(count_red(*drawing), 1.1 * edge);
    EXPECT_GT(count_red(*drawing), 0.55 * edge) << "the pixels of its sides are mixed with the light beside it";
  }
}

TEST(Marks, ASpringIsAZigzagWithinItsWidth) {
  const Drawing drawing = marks_of(still(MarkKind::spring, {-0.03f, 0, 0.03f, 0, 0.01f}));
  EXPECT_TRUE(is_red(at(drawing, -0.0299, 0)));
  EXPECT_TRUE(is_red(at(drawing, 0.0299, 0)));
  // A line at a fifth of the width beside the axis crosses each of the 8 turns on its side twice.
  for (const double beside : {0.002, -0.002}) {
    int crossings = 0;
    bool before = false;
    for (double x = -0.035; x < 0.035; x += 0.00005) {
      const bool here = is_red(at(drawing, x, beside));
      crossings += here && !before;
      before = here;
    }
    EXPECT_EQ(crossings, 16) << beside;
  }
  for (double x = -0.035; x < 0.035; x += 0.0005) EXPECT_FALSE(is_red(at(drawing, x, 0.0062))) << x;
}

TEST(Marks, MarksWithoutAFinitePlaceAreNotDrawn) {
  const float none = std::nanf(""), endless = 1e38f;
  EXPECT_EQ(count_red(marks_of(still(MarkKind::point, {none, 0, 0.01f}))), 0);
  EXPECT_EQ(count_red(marks_of(still(MarkKind::point, {endless, 0, 0.01f}))), 0);
  EXPECT_EQ(count_red(marks_of(still(MarkKind::line, {0, 0, endless, endless}))), 0);
  EXPECT_EQ(count_red(marks_of(still(MarkKind::box, {0, 0, endless, 0.01f, 0}))), 0);
  EXPECT_EQ(count_red(marks_of(still(MarkKind::circle, {0, 0, endless}))), 0);
  EXPECT_EQ(count_red(marks_of(still(MarkKind::spring, {0, 0, 0.01f, 0, none}))), 0);
  // A mark that is larger than the picture is clipped to it.
  const Drawing wide = marks_of(still(MarkKind::box, {0, 0, 1, 1, 0})),
                page = marks_of(still(MarkKind::box, {1, 1, 0, 0, 0}));
  for (int y = 0; y < wide.height; ++y)
    for (const int x : {picture_left - 4, picture_left + picture_side + 3}) {
      const auto i = static_cast<std::size_t>((y * wide.width + x) * 3);
      ASSERT_EQ(wide.rgb[i], page.rgb[i]) << x << ", " << y;
    }
}

TEST(Marks, MoveWithTheState) {
  // 20 um per tick at 900 Hz: the 901 ticks from 0 to 1 s end at 18.02 mm, the place of the spring's far end.
  const Drawing drawing = marks_of(moving(20e-6f, MarkKind::spring, {-0.03f, 0.02f, 0, 0.02f, 0.006f}, 2));
  EXPECT_TRUE(is_red(at(drawing, 0.01795, 0.02)));
  EXPECT_FALSE(is_red(at(drawing, 0.0195, 0.02)));
  const Drawing back = marks_of(moving(-20e-6f, MarkKind::spring, {-0.03f, 0.02f, 0, 0.02f, 0.006f}, 2));
  EXPECT_TRUE(is_red(at(back, -0.01795, 0.02)));
  EXPECT_FALSE(is_red(at(back, -0.015, 0.02)));
}

TEST(Marks, ATrajectoryIsThePathOfItsLastSeconds) {
  // From 0 to 18 mm in a second; the last half of it began at 9 mm.
  const Bank bank = moving(20e-6f, MarkKind::trajectory, {0, -0.02f, 0.5f}, 0);
  const Rehearsal rehearsal = rehearse(bank, showing_hand());
  ASSERT_EQ(rehearsal.paths.size(), 1u);
  EXPECT_NEAR(rehearsal.paths[0].front().x, 0.009, 1e-4);
  EXPECT_NEAR(rehearsal.paths[0].back().x, 0.018, 1e-4);
  const Drawing drawing = marks_of(bank);
  EXPECT_TRUE(is_red(at(drawing, 0.0175, -0.02)));
  EXPECT_FALSE(is_red(at(drawing, 0.005, -0.02)));
}

TEST(Rehearsal, LastsAsLongAsTheLongestTrajectoryUpToFiveSeconds) {
  const auto seconds = [](float shown) {
    return rehearse(still(MarkKind::trajectory, {0, 0, shown}), showing_hand()).seconds;
  };
  EXPECT_EQ(seconds(0.1f), 1);
  EXPECT_EQ(seconds(3), 3);
  EXPECT_EQ(seconds(1e30f), 5);
  EXPECT_EQ(seconds(std::nanf("")), 1);
  EXPECT_EQ(rehearse(sine_grating(0.004f, 1), showing_hand()).seconds, 0);
}

TEST(Rehearsal, TheHandGoesAlongTheWayThatIsChosen) {
  const Bank bank = moving(0, MarkKind::point, {0, 0, 0.001f}, 0);
  const Rehearsal along_x = rehearse(bank, showing_hand()), along_y = rehearse(bank, showing_hand(), {}, 0.5 * pi);
  ASSERT_EQ(along_x.places.size(), along_y.places.size());
  for (std::size_t i = 0; i < along_x.places.size(); ++i) {
    EXPECT_NEAR(along_x.places[i].x, along_y.places[i].y, 1e-6);
    EXPECT_NEAR(along_x.places[i].y, -along_y.places[i].x, 1e-6);
  }
}

TEST(Rehearsal, TheHandRubsToAndFroOnThePatch) {
  const Rehearsal rehearsal = rehearse(moving(0, MarkKind::point, {0, 0, 0.001f}, 0), showing_hand());
  EXPECT_EQ(rehearsal.places.front(), glm::vec2(0));
  float least = 1, most = -1;
  double longest_step = 0;
  for (std::size_t i = 1; i < rehearsal.places.size(); ++i) {
    least = std::min(least, rehearsal.places[i].x), most = std::max(most, rehearsal.places[i].x);
    const glm::vec2 step = rehearsal.places[i] - rehearsal.places[i - 1];
    longest_step = std::max(longest_step, std::hypot(double{step.x}, double{step.y}));
  }
  EXPECT_LT(least, -0.015);
  EXPECT_GT(most, 0.015);
  EXPECT_LT(std::max(most, -least), side / 2);
  EXPECT_LT(longest_step * 900, 0.5) << "m/s";
}

TEST(Colour, LevelGroundIsTheAuthorsColour) {
  HandMade made;
  made.program.picture.relief = made.constant(0);
  made.program.picture.colour = {made.constant(0.2f), made.constant(0.6f), made.constant(0.4f)};
  made.push(made.constant(0), made.constant(0), 1);
  const Drawing drawing = draw(made.bank());
  for (const double x : {-0.03, 0.0, 0.03}) {
    const Pixel pixel = at(drawing, x, 0.01);
    EXPECT_NEAR(pixel.red, 51, 1);
    EXPECT_NEAR(pixel.green, 153, 1);
    EXPECT_NEAR(pixel.blue, 102, 1);
  }
}

TEST(Colour, IsShaded) {
  const auto grating = [](bool coloured) {
    HandMade made;
    auto& picture = made.program.picture;
    const auto turns = made.constant(static_cast<float>(2 * pi / 0.02));
    picture.relief = made.add(picture.code, Operation::sine, made.add(picture.code, Operation::multiply, 0, turns));
    if (coloured) picture.colour = {made.constant(0.5f), made.constant(0.5f), made.constant(0.5f)};
    made.push(made.constant(0), made.constant(0), 1);
    return draw(made.bank());
  };
  const Drawing plaster = grating(false), grey = grating(true);
  // The grey has the same ratio of lit to shadowed flanks as the plain relief.
  const Pixel lit = at(grey, 0, 0.03), dark = at(grey, 0.01, 0.03);
  EXPECT_GT(lit.green, dark.green + 40);
  EXPECT_NEAR(double(lit.green) / dark.green, double(at(plaster, 0, 0.03).green) / at(plaster, 0.01, 0.03).green, 0.06);
}

TEST(Exhibit, MarksAreShownOnTheWholePatch) {
  HandMade made;
  auto& picture = made.program.picture;
  const auto turns = made.constant(static_cast<float>(2 * pi / 0.0025));
  picture.relief = made.add(picture.code, Operation::sine, made.add(picture.code, Operation::multiply, 0, turns));
  made.push(made.constant(0), made.constant(0), 1);
  EXPECT_NEAR(exhibit_of(made.bank()).side, 0.02, 1e-5);
  const auto zero = made.constant(0);
  picture.marks = {{.kind = MarkKind::point, .operands = {zero, zero, zero}, .colour = red}};
  EXPECT_NEAR(exhibit_of(made.bank()).side, 0.08, 1e-6);
}

TEST(Preview, HeightsAreInTheUnitTheProgramSays) {
  // A relief of 0.03 is a length only when the program says so.
  const auto picture_of = [](float height, bool is_length) {
    HandMade made;
    auto& picture = made.program.picture;
    const auto turns = made.constant(static_cast<float>(2 * pi / 0.02)), size = made.constant(height);
    const auto wave = made.add(picture.code, Operation::sine, made.add(picture.code, Operation::multiply, 0, turns));
    picture.relief = made.add(picture.code, Operation::multiply, wave, size);
    picture.relief_is_length = is_length;
    made.push(made.constant(0), made.constant(0), 1);
    return draw(made.bank());
  };
  if (!(*new_canvas(1, 1, {}))->has_text()) GTEST_SKIP() << "no font is installed";
  // The unit stands right above the labels of the plot's y axis.
  const auto unit_is_written = [](const Drawing& drawing) {
    for (int y = 196; y < 216; ++y)
      for (int x = 715; x < 754; ++x)
        if (drawing.rgb[static_cast<std::size_t>((y * drawing.width + x) * 3)] < 180) return true;
    return false;
  };
  EXPECT_TRUE(unit_is_written(picture_of(0.03f, true)));
  EXPECT_FALSE(unit_is_written(picture_of(0.03f, false)));
  EXPECT_FALSE(unit_is_written(picture_of(1e-6f, false)));
}

}  // namespace
}  // namespace wale::marks_test
