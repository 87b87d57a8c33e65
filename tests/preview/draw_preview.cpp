#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>

#include "compiler/describe/describe.hpp"
#include "compiler/drawing/axis.hpp"
#include "compiler/drawing/canvas.hpp"
#include "compiler/image/openimageio.hpp"
#include "compiler/modules/load_modules.hpp"
#include "compiler/preview/exhibit.hpp"
#include "compiler/preview/preview.hpp"
#include "tests/preview/hand_made.hpp"
#include "tests/standard/standard.hpp"

namespace wale::draw_preview_test {
namespace {

// The places of the page's parts, in pixels.
constexpr int picture_left = 64, picture_top = 196, picture_side = 580;
constexpr int force_left = 764, force_right = 1536, force_middle = 655;

struct Pixel {
  int red, green, blue;
  int lightness() const { return red + green + blue; }
  /// The blue in which forces are drawn; the page has no other.
  bool is_force() const { return blue > red + 60; }
};

Pixel at(const Drawing& drawing, int x, int y) {
  const auto* p = &drawing.rgb[static_cast<std::size_t>((y * drawing.width + x) * 3)];
  return {p[0], p[1], p[2]};
}

int darkest(const Drawing& drawing, int left, int top, int right, int bottom) {
  int least = 3 * 255;
  for (int y = top; y < bottom; ++y) {
    for (int x = left; x < right; ++x) least = std::min(least, at(drawing, x, y).lightness());
  }
  return least;
}

Drawing drawn(const Bank& bank, const PreviewText& text) {
  return draw_preview(bank, text, common_modules()->declarations)->page->pixels();
}

Drawing draw(const Bank& bank) { return drawn(bank, preview_text(bank, common_modules()->declarations)); }

TEST(Preview, ReliefRepeatsWithThePeriodAndIsConstantAlongTheRibs) {
  const Drawing drawing = draw(sine_grating(0.004f, 1));
  ASSERT_EQ(drawing.width, 1600);
  ASSERT_EQ(drawing.height, 1330);
  // Eight periods are 580 pixels, so two are 145. The outermost periods are left out, since a hollow there is shaded
  // from one side only.
  constexpr int two_periods = picture_side / 4, edge = picture_side / 8;
  int least = 999, most = 0;
  for (int x = picture_left + edge; x < picture_left + picture_side - two_periods - edge; ++x) {
    const int here = at(drawing, x, picture_top + 100).lightness();
    EXPECT_NEAR(here, at(drawing, x + two_periods, picture_top + 100).lightness(), 9) << x;
    EXPECT_NEAR(here, at(drawing, x, picture_top + 500).lightness(), 3) << x;
    least = std::min(least, here), most = std::max(most, here);
  }
  EXPECT_GT(most - least, 200);  // the relief is visible
}

TEST(Preview, LightComesFromTheLeft) {
  const Drawing drawing = draw(sine_grating(0.004f, 1));
  // sin(2 pi x / period) rises to the right at x = 0, so its flank there faces left and is lit. Half a period further
  // it faces right.
  const int centre = picture_left + picture_side / 2, half_period = picture_side / 16;
  EXPECT_GT(at(drawing, centre, picture_top + 100).lightness(),
            at(drawing, centre + half_period, picture_top + 100).lightness() + 150);
}

TEST(Preview, ForceCurveCrossesZeroTwiceAPeriod) {
  const Drawing drawing = draw(sine_grating(0.004f, 1));
  // Three pixels off the zero line, so that the line itself is not counted.
  int crossings = 0;
  for (int x = force_left + 2; x < force_right; ++x) {
    crossings += at(drawing, x, force_middle - 4).is_force() && !at(drawing, x - 1, force_middle - 4).is_force();
  }
  EXPECT_EQ(crossings, 16);
}

TEST(Preview, WordsAreOnThePage) {
  const Bank bank = sine_grating(0.004f, 1);
  PreviewText text = preview_text(bank, common_modules()->declarations);
  EXPECT_EQ(text.title, "A sine grating");
  EXPECT_EQ(text.names, "grating · washboard");
  const auto maximum = std::ranges::find(text.figures, "maximum force", &PreviewText::Figure::word);
  ASSERT_NE(maximum, text.figures.end());
  EXPECT_EQ(maximum->value, "1 N");
  EXPECT_EQ(text.figures[0].word, "roughness") << "what the force reads, although nobody asked for it";
  const Drawing drawing = drawn(bank, text);
  if (!(*new_canvas(1, 1, {}))->has_text()) GTEST_SKIP() << "no font is installed";
  EXPECT_LT(darkest(drawing, 64, 60, 500, 110), 200);     // title
  EXPECT_LT(darkest(drawing, 64, 860, 300, 920), 200);    // figures
  EXPECT_GT(darkest(drawing, 1100, 30, 1590, 110), 700);  // nothing beside the title

  // Letters outside ASCII are drawn: the accent adds pixels above the letter, and nothing else changes.
  text.title = "Crepe";
  const Drawing plain = drawn(bank, text);
  text.title = "Crêpe";
  const Drawing accented = drawn(bank, text);
  EXPECT_NE(plain, accented);
  for (int y = 80; y < 1000; ++y) {
    for (int x = 0; x < 1600; x += 7)
      ASSERT_EQ(at(plain, x, y).lightness(), at(accented, x, y).lightness()) << x << ", " << y;
  }
}

TEST(Preview, LongAndBrokenWordsStayOnThePage) {
  const Bank bank = spring_and_oil(100, 0);
  PreviewText text;
  text.title = std::string(100000, 'W');
  text.names = "tab\there, newline\nthere, \xff\xfe not UTF-8, \xe2\x82";
  for (int i = 0; i < 40; ++i) text.figures.push_back({std::string(300, 'w'), std::string(300, '8')});
  text.evidence = std::string(5000, 'e');
  const Drawing drawing = drawn(bank, text);
  EXPECT_GT(darkest(drawing, 1545, 0, 1600, 1000), 700);  // the right margin is empty
  const Drawing wordless = drawn(bank, {});
  EXPECT_EQ(wordless.width, drawing.width);
}

TEST(Preview, SameBankSameBytes) {
  const auto png_of = [](const Bank& bank) { return *encode_drawing(draw(bank), "a.png"); };
  EXPECT_EQ(png_of(sine_grating(0.0025f, 1.934f)), png_of(sine_grating(0.0025f, 1.934f)));
  EXPECT_EQ(png_of(spring_and_oil(120, 2)), png_of(spring_and_oil(120, 2)));
}

TEST(Preview, AnEmptyMaterialGivesAPicture) {
  const Drawing drawing = draw(spring_and_oil(0, 0));
  EXPECT_EQ(drawing.rgb.size(), 1600u * 1000u * 3u);
}

TEST(Exhibit, GratingShowsEightPeriods) {
  const Exhibit exhibit = exhibit_of(sine_grating(0.0025f, 1));
  EXPECT_TRUE(exhibit.has_relief);
  EXPECT_TRUE(exhibit.pushes_at_rest);
  EXPECT_FALSE(exhibit.resists_motion);
  ASSERT_TRUE(exhibit.period);
  EXPECT_NEAR(*exhibit.period, 0.0025, 1e-6);
  EXPECT_NEAR(exhibit.side, 0.020, 1e-5);
  EXPECT_EQ(exhibit.way, glm::dvec2(1, 0));
  EXPECT_EQ(exhibit.way_name, "x");
  EXPECT_NEAR(exhibit.patch_side, 0.08, 1e-6);
}

TEST(Exhibit, LongPeriodShowsTheWholePatch) {
  EXPECT_NEAR(exhibit_of(sine_grating(0.02f, 1)).side, 0.08, 1e-6);
  EXPECT_NEAR(exhibit_of(sine_grating(0.5f, 1)).side, 0.08, 1e-6);  // less than one period on the patch
}

TEST(Exhibit, SpringPushesAndOilResists) {
  const Exhibit spring = exhibit_of(spring_and_oil(120, 0)), oil = exhibit_of(spring_and_oil(0, 3));
  EXPECT_FALSE(spring.has_relief);
  EXPECT_TRUE(spring.pushes_at_rest);
  EXPECT_FALSE(spring.resists_motion);
  EXPECT_FALSE(oil.pushes_at_rest);
  EXPECT_TRUE(oil.resists_motion);
}

TEST(Exhibit, ProfilesAreTheForcesOfTheProgram) {
  const Bank oil = spring_and_oil(0, 3);
  const Profile against = force_against_speed(oil, exhibit_of(oil), 11);
  for (std::size_t i = 0; i < 11; ++i) EXPECT_NEAR(against.values[i], -3 * against.at[i], 1e-6);
  const Bank grating = sine_grating(0.004f, 2);
  const Exhibit exhibit = exhibit_of(grating);
  const Profile force = force_along(grating, exhibit, 0, 101), height = height_along(grating, nullptr, exhibit, 101);
  for (std::size_t i = 0; i < 101; ++i) {
    EXPECT_NEAR(force.values[i], -2 * std::cos(2 * pi * force.at[i] / 0.004), 1e-4);
    EXPECT_NEAR(height.values[i], 0.5 + 0.5 * std::sin(2 * pi * height.at[i] / 0.004), 1e-4);
  }
}

/// The force of a sine grating along a section at an angle a has the period divided by cos a, and its size times cos a,
/// since the force points along x.
TEST(Exhibit, ASectionMayGoAnywhere) {
  const Bank grating = sine_grating(0.004f, 2);
  const double angle = pi / 3;
  const Exhibit exhibit = exhibit_of(grating, nullptr, {.along = angle, .at = glm::dvec2(0.003, 0.001), .name = "60°"});
  EXPECT_EQ(exhibit.way_name, "60°");
  const Profile force = force_along(grating, exhibit, 0, 101);
  for (std::size_t i = 0; i < 101; ++i) {
    // Places on the axis count from the foot of the patch's centre.
    const double foot = 0.003 * std::cos(angle) + 0.001 * std::sin(angle);
    const double x = 0.003 + std::cos(angle) * (force.at[i] - foot);
    EXPECT_NEAR(force.values[i], -2 * std::cos(2 * pi * x / 0.004) * std::cos(angle), 1e-4);
  }
  const Exhibit far = exhibit_of(grating, nullptr, {.along = {}, .at = glm::dvec2(0.03, 0), .name = {}});
  EXPECT_EQ(far.centre, glm::dvec2(0.03, 0)) << "the picture is around the place";
  EXPECT_EQ(far.way_name, "x");
}

/// A wall of 600 N/m at x = 20 mm is there on the axis of a section through any place, and no part of the section is
/// outside of the patch.
TEST(Exhibit, PlacesOnASectionAreThoseOnThePatch) {
  const Bank wall(standard::material("material m { physical { force = firm(600 N/m, face: 20 mm) } }", "m"));
  for (const glm::dvec2 place : {glm::dvec2(0.03, 0), glm::dvec2(-0.05, 0.02), glm::dvec2(0.07, -0.03)}) {
    const Exhibit exhibit = exhibit_of(wall, nullptr, {.along = 0, .at = place, .name = "x"});
    const Profile force = force_along(wall, exhibit, 0, 321);
    EXPECT_NEAR(force.at.front(), -0.08, 1e-6);
    EXPECT_NEAR(force.at.back(), 0.08, 1e-6);
    for (std::size_t i = 0; i < force.at.size(); ++i) {
      const double expected = force.at[i] > 0.02 && force.at[i] < 0.036 ? -600 * (force.at[i] - 0.02) : 0;
      if (force.at[i] >= 0.036) continue;  // where the device limits it
      EXPECT_NEAR(force.values[i], expected, 0.01) << force.at[i];
    }
  }
  // Along y the wall's push of 6 N is the same everywhere, and the section has the patch's height.
  const Exhibit along_y = exhibit_of(wall, nullptr, {.along = pi / 2, .at = glm::dvec2(0.03, 0.05), .name = "y"});
  const SectionRange range = section_range(along_y);
  EXPECT_NEAR(range.from, -0.08, 1e-6);
  EXPECT_NEAR(range.to, 0.08, 1e-6);
  const Exhibit oblique = exhibit_of(wall, nullptr, {.along = pi / 4, .at = glm::dvec2(0.07, 0), .name = "45°"});
  for (const double end : {section_range(oblique).from, section_range(oblique).to}) {
    EXPECT_LE(std::abs(on_section(oblique, end).x), 0.08 + 1e-9);
    EXPECT_LE(std::abs(on_section(oblique, end).y), 0.08 + 1e-9);
  }
}

/// A wall that only damps, and one that does both, are shown moving where they are and not in front of them.
TEST(Exhibit, MotionIsShownWhereItMatters) {
  for (const char* force : {"crisp(5 N s/m)", "firm(600 N/m, face: 20 mm) + crisp(5 N s/m, face: 20 mm)"}) {
    const Bank bank(standard::material(std::string("material m { physical { force = ") + force + " } }", "m"));
    const Exhibit exhibit = exhibit_of(bank);
    ASSERT_TRUE(exhibit.resists_motion) << force;
    const Profile against = force_against_speed(bank, exhibit, 11);
    EXPECT_GT(std::abs(*std::ranges::max_element(against.values, {}, [](double value) { return std::abs(value); })), 0.5)
        << force;
  }
  const Bank oil = spring_and_oil(0, 3);
  EXPECT_EQ(exhibit_of(oil).moving_at, glm::dvec2(0)) << "alike everywhere";
}

/// The picture has the level of a percept that nobody asked for, as `describe` reads it.
TEST(Preview, HardnessIsReadAlsoBehindALimit) {
  const Bank bank(standard::material("material m { physical { force = firm(600 N/m, face: 20 mm) limit 8 N } }", "m"));
  const PreviewText text = preview_text(bank, common_modules()->declarations);
  EXPECT_EQ(text.figures.at(0).word, "hardness");
  EXPECT_EQ(text.evidence.find("physics only"), std::string::npos) << text.evidence;
}

/// A level that is unknown has no size either; what is known of the force stays.
TEST(Preview, NothingIsSaidOfTheSizeOfAnUnknownLevel) {
  const auto figures = [](const std::string& period) {
    return preview_text(Bank(standard::material("material m { perceptual { roughness 0.2 } physical { force = "
                                                "lateral(grating(x, period: " + period + ")) } }", "m")),
                        common_modules()->declarations)
        .figures;
  };
  const auto sizes = [](const std::vector<PreviewText::Figure>& all) {
    return std::ranges::count(all, "lateral amplitude", &PreviewText::Figure::word);
  };
  const auto fine = figures("0.08 mm");
  EXPECT_EQ(fine.at(0).value, "unknown, asked 0.20");
  EXPECT_EQ(sizes(fine), 0);
  EXPECT_EQ(sizes(figures("2 mm")), 1);
}

/// The picture is no surer than `describe`: what is assumed, and what is only a lower bound, is marked in both.
TEST(Preview, IntervalsHaveTheMarksOfDescribe) {
  const auto& declarations = common_modules()->declarations;
  std::size_t marked = 0;
  declarations.percepts.each([&](const std::string& name, const Percept& percept) {
    if (!percept.has_reference) return;
    const Bank bank(standard::material("material m { perceptual { " + name + " 0.5 } }", "m"));
    const std::string evidence = preview_text(bank, declarations).evidence;
    const std::string text = description_text(describe(bank, declarations));
    for (std::size_t at = evidence.find("95 % of"); at != std::string::npos; at = evidence.find("95 % of", at + 1)) {
      std::string words = evidence.substr(at);
      words.resize(std::min({words.find(" · "), words.find(", limited"), words.find(", outside"), words.size()}));
      EXPECT_NE(text.find(words), std::string::npos) << name << ": " << words << '\n' << text;
      marked += words.find("at least") != std::string::npos && words.find("assumed") != std::string::npos;
    }
  });
  EXPECT_GT(marked, 3u);
}

/// A drag that turns a hand aside has no force along its way: it is drawn all the same.
TEST(Exhibit, AForceAcrossTheMotionIsAProfileOfItsOwn) {
  const Bank bank(standard::material("material m { physical { force = 2 N s/m * perpendicular(velocity) } }", "m"));
  const Exhibit exhibit = exhibit_of(bank);
  const Profile along = force_against_speed(bank, exhibit, 11), across = force_against_speed(bank, exhibit, 11, true);
  for (std::size_t i = 0; i < 11; ++i) {
    EXPECT_NEAR(along.values[i], 0, 1e-6);
    EXPECT_NEAR(std::abs(across.values[i]), 2 * std::abs(across.at[i]), 1e-3);
  }
}

/// Ribs of 1 N and, 25 mm to the right, a wall: the picture shows both.
TEST(Exhibit, AWallOutsideTheMiddlePeriodsIsShown) {
  static const auto common = common_modules();
  const auto made = [](const std::string& force) {
    return Bank(standard::material("material m { physical {\n" + force + "\n} }", "m"));
  };
  const std::string ribs = "force ribs = lateral(grating(y, period: 2.5 mm), amplitude: 1 N)\n";
  const Bank alone = made(ribs), with_wall = made(ribs + "force wall = firm(600 N/m, face: 25 mm)");
  EXPECT_NEAR(exhibit_of(alone).side, 0.02, 1e-4);
  EXPECT_NEAR(exhibit_of(with_wall).side, 0.16, 1e-4);
  const PreviewText text = preview_text(with_wall, common->declarations);
  const auto value = [&](const std::string& word) {
    const auto found = std::ranges::find(text.figures, word, &PreviewText::Figure::word);
    return found == text.figures.end() ? "none" : found->value;
  };
  EXPECT_EQ(value("wall right of x = 25 mm"), "to 10 N");
  EXPECT_NE(value("maximum force"), "none");
  EXPECT_EQ(value("lateral amplitude"), "1 N");
  EXPECT_EQ(value("firm stiffness"), "600 N/m");
}

/// Six figures fit. The maximum force is one of them, however many percepts and parameters there are.
TEST(Preview, TheMaximumIsAlwaysAmongTheFigures) {
  std::string parameters, sum = "0";
  for (const char name : {'a', 'b', 'c', 'd', 'e', 'f', 'g', 'h'}) {
    parameters += std::string("param ") + name + "1 = 1 in 0 .. 2\n";
    sum += std::string(" + ") + name + "1";
  }
  const Bank bank(standard::material(
      "material m { physical {\n" + parameters + "force = vector(-10 N/m * x * (" + sum + "), 0 N)\n} }", "m"));
  const PreviewText text = preview_text(bank, common_modules()->declarations);
  ASSERT_EQ(text.figures.size(), 6u);
  EXPECT_EQ(std::ranges::count(text.figures, "maximum force", &PreviewText::Figure::word), 1);
  EXPECT_EQ(text.figures.back().value, "6 more") << "also the spring that is read, and its stiffness";
}

TEST(Axis, TicksAreRoundNumbers) {
  const auto labels = [](double low, double high, int count) {
    std::string all;
    for (const Tick& tick : round_ticks(low, high, count)) all += (all.empty() ? "" : " ") + tick.label;
    return all;
  };
  EXPECT_EQ(labels(-2.3, 2.3, 5), "−2 −1 0 1 2");
  EXPECT_EQ(labels(-10, 10, 10), "−10 −8 −6 −4 −2 0 2 4 6 8 10");
  EXPECT_EQ(labels(0, 0.1, 5), "0.00 0.02 0.04 0.06 0.08 0.10");
  EXPECT_EQ(labels(1, 1, 5), "");
}

TEST(Axis, QuantitiesReadWell) {
  EXPECT_EQ(shown_quantity(1.934, force_notation(1.934)), "1.93 N");
  EXPECT_EQ(shown_quantity(0.0123, force_notation(0.0123)), "12.3 mN");
  EXPECT_EQ(shown_quantity(0.0025, length_notation(0.0025)), "2.5 mm");
  EXPECT_EQ(shown_quantity(25e-6, length_notation(25e-6)), "25 µm");
  EXPECT_EQ(shown_quantity(-0.25, {"", 1}), "−0.25");
  EXPECT_EQ(shown_number(1234.4), "1234");
  EXPECT_EQ(round_number(6.9), 5);
  EXPECT_EQ(round_number(20), 20);
  EXPECT_DOUBLE_EQ(round_number(0.03), 0.02);
}

TEST(EncodeDrawing, PngComesBackPixelForPixel) {
  Drawing drawing{3, 2, {1, 2, 3, 40, 50, 60, 7, 8, 9, 0, 0, 0, 255, 255, 255, 9, 8, 7}};
  const auto bytes = encode_drawing(drawing, "wall.png");
  ASSERT_TRUE(bytes);
  const auto path = std::filesystem::path(testing::TempDir()) / "wale_preview_test.png";
  std::ofstream(path, std::ios::binary)
      .write(reinterpret_cast<const char*>(bytes->data()), static_cast<std::streamsize>(bytes->size()));
  auto input = OIIO::ImageInput::open(path.string());
  ASSERT_TRUE(input);
  std::vector<std::uint8_t> back(drawing.rgb.size());
  EXPECT_TRUE(input->read_image(0, 0, 0, 3, OIIO::TypeUInt8, back.data()));
  EXPECT_EQ(back, drawing.rgb);
  EXPECT_FALSE(input->spec().find_attribute("DateTime"));
  EXPECT_FALSE(input->spec().find_attribute("Software"));
  input->close();
  std::filesystem::remove(path);
}

// ---- a page ----

TEST(Page, AnSvgHasThePagesSizeAndItsLines) {
  const auto page = *new_canvas(300, 200, {1, 1, 1});
  page->line({10, 20}, {110, 20}, {4, {1, 0, 0}});
  const auto bytes = *encode_page(*page, "page.svg");
  const std::string svg(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  EXPECT_NE(svg.find("width=\"300px\" height=\"200px\""), std::string::npos) << svg.substr(0, 300);
  EXPECT_NE(svg.find("M 10 20 L 110 20"), std::string::npos) << svg;
  EXPECT_EQ(svg.find("<image"), std::string::npos);
}

TEST(Page, TheSameDrawingGivesTheSameSvg) {
  const auto drawn = [] {
    const auto page = *new_canvas(100, 100, {1, 1, 1});
    page->place_squares({10, 10, 50, 50}, std::vector<Colour>(16, Colour{1, 0, 0}), 4);
    page->place_squares({50, 50, 90, 90}, std::vector<Colour>(16, Colour{0, 0, 1}), 4);
    page->write({10, 90}, "wale", {});
    const auto bytes = *encode_page(*page, "page.SVG");
    return std::string(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  };
  const std::string first = drawn();
  EXPECT_EQ(first, drawn());
  // Whatever is referred to is there.
  std::size_t references = 0;
  for (std::size_t at = first.find('#'); at != std::string::npos; at = first.find('#', at + 1)) {
    const std::string name = first.substr(at + 1, first.find_first_of("\")", at) - at - 1);
    EXPECT_NE(first.find("id=\"" + name + "\""), std::string::npos) << name;
    ++references;
  }
  EXPECT_GE(references, 2u);
}

TEST(Page, LinesCoverTheirWidthAndDashesLeaveGaps) {
  const auto page = *new_canvas(100, 40, {1, 1, 1});
  page->line({10, 10}, {90, 10}, {4, {0, 0, 0}});
  page->line({10, 30}, {90, 30}, {4, {0, 0, 0}, 1, 10});
  page->line({50, 20}, {50, 20}, {6, {0, 0, 1}});
  const Drawing drawing = page->pixels();
  for (const int y : {8, 9, 10, 11}) EXPECT_EQ(at(drawing, 50, y).lightness(), 0) << y;
  for (const int y : {7, 12}) EXPECT_EQ(at(drawing, 50, y).lightness(), 3 * 255) << y;
  EXPECT_EQ(at(drawing, 15, 30).lightness(), 0);
  EXPECT_EQ(at(drawing, 25, 30).lightness(), 3 * 255);
  EXPECT_EQ(at(drawing, 35, 30).lightness(), 0);
  EXPECT_EQ(at(drawing, 50, 20).lightness(), 255) << "a line without a length is a dot";
}

TEST(Page, APlacedPictureHasItsColoursAndNothingBeyondItsBox) {
  const auto page = *new_canvas(40, 40, {1, 1, 1});
  const std::vector<Colour> squares = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {0, 0, 0}};
  page->place_squares({10, 10, 30, 30}, squares, 2);
  const Drawing drawing = page->pixels();
  const auto is = [&](int x, int y, int red, int green, int blue) {
    const Pixel p = at(drawing, x, y);
    return p.red == red && p.green == green && p.blue == blue;
  };
  for (const int near : {10, 19})
    EXPECT_TRUE(is(near, near, 255, 0, 0) && is(near + 10, near, 0, 255, 0) && is(near, near + 10, 0, 0, 255)) << near;
  for (const int beyond : {9, 30}) EXPECT_TRUE(is(beyond, 20, 255, 255, 255) && is(20, beyond, 255, 255, 255));
}

TEST(Page, WordsEndWhereTheyMayAndAreDrawnOnlyWithAFont) {
  const auto page = *new_canvas(400, 60, {1, 1, 1});
  const Type type = {Face::sans, 20, {0, 0, 0}};
  page->write_within({10, 40}, 100, std::string(60, 'W'), type);
  const Drawing drawing = page->pixels();
  if (!page->has_text()) GTEST_SKIP() << "no font is installed";
  EXPECT_LT(darkest(drawing, 10, 20, 110, 45), 200);
  EXPECT_GT(darkest(drawing, 112, 0, 400, 60), 700);
  // Kerning and shaping change a little; twice the letters are about twice as wide.
  EXPECT_NEAR(page->width_of("wale wale", type), 2 * page->width_of("wale", type) + page->width_of(" ", type), 2);
}

TEST(EncodeDrawing, ProblemsAreWords) {
  const Drawing drawing{1, 1, {1, 2, 3}};
  const auto reason = [&](const std::string& path) {
    const auto encoded = encode_drawing(drawing, path);
    return encoded ? "was encoded" : encoded.error().sentence;
  };
  EXPECT_EQ(reason("wall"), "the name of a picture needs an extension");
  EXPECT_EQ(reason("wall.wale"), "pictures cannot be written as .wale");
  EXPECT_EQ(reason("wall.null"), "pictures cannot be written as .null");
  EXPECT_EQ(encode_drawing(drawing, "wall").error().mend, "use the extension .png");
  EXPECT_FALSE(OIIO::has_error());
}

}  // namespace
}  // namespace wale::draw_preview_test
