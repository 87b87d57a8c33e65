// Curves, tables and reliefs against interpolation in double precision, and against pictures at other places.

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "tests/compiler/compiling.hpp"

namespace wale::compiling::fields_test {
namespace {

struct Point {
  double place, value;
};
using Points = std::vector<Point>;

/// Linear interpolation between the points, constant beyond the first and the last.
double interpolated(const Points& points, double place) {
  if (place <= points.front().place) return points.front().value;
  for (std::size_t i = 1; i < points.size(); ++i) {
    const auto& [x0, y0] = points[i - 1];
    const auto& [x1, y1] = points[i];
    if (place <= x1) return y0 + (y1 - y0) * (place - x0) / (x1 - x0);
  }
  return points.back().value;
}

double steepest(const Points& points) {
  double most = 0;
  for (std::size_t i = 1; i < points.size(); ++i)
    most = std::max(most, std::abs(points[i].value - points[i - 1].value) / (points[i].place - points[i - 1].place));
  return most;
}

double uniform(std::mt19937& random) { return random() / 2147483648.0 - 1; }

/// Two to eight points between -60 mm and 60 mm, at least 1 mm apart; in whole hundredths of mm and of N.
Points random_points(std::mt19937& random) {
  Points points;
  double place = -60 + random() % 4000 * 0.01;
  for (std::uint32_t i = 0, count = 2 + random() % 7; i < count; ++i) {
    points.push_back({place * 1e-3, std::round(200 * uniform(random)) * 0.01});
    place += 1 + random() % 1000 * 0.01;
  }
  return points;
}

/// "-20 mm, 0.5 N, …".
std::string written(const Points& points) {
  std::string text;
  for (const auto& [place, value] : points)
    text += fmt::format("{}{:.2f} mm, {:.2f} N", text.empty() ? "" : ", ", place * 1e3, value);
  return text;
}

Force push(Bank& bank, double x, double y = 0) {
  Hand hand;
  hand.position = {static_cast<float>(x), static_cast<float>(y)};
  return tick(bank, hand);
}

/// The points, random places on the patch, and places beyond the ends.
std::vector<double> places(const Points& points, std::mt19937& random) {
  std::vector<double> all{-0.08, 0.08};
  for (const auto& point : points) all.push_back(static_cast<float>(point.place));
  for (int i = 0; i < 60; ++i) all.push_back(static_cast<float>(0.08 * uniform(random)));
  return all;
}

/// Places and points are floats, precise to 4 nm at 60 mm; forces of a few newtons are rounded in each segment.
double tolerance(const Points& points) { return 2e-6 + 2e-8 * steepest(points); }

TEST(Curves, RunStraightFromPointToPoint) {
  std::mt19937 random(11);
  for (int each = 0; each < 100; ++each) {
    const Points points = random_points(random);
    const Program program = compiled("    let c = curve(" + written(points) + ")\n    force = vector(c(x), c(-x))");
    Bank bank(program);
    for (const double x : places(points, random)) {
      ASSERT_NEAR(push(bank, x).x, interpolated(points, x), tolerance(points)) << written(points) << " at " << x;
      ASSERT_NEAR(push(bank, x).y, interpolated(points, -x), tolerance(points)) << written(points) << " at " << -x;
    }
  }
}

TEST(Curves, HaveTheSlopeOfTheirSegment) {
  std::mt19937 random(12);
  for (int each = 0; each < 60; ++each) {
    const Points points = random_points(random);
    const Program program =
        compiled("    let c = curve(" + written(points) + ")\n    force = grad(c(x + y / 2)) * 1 mm");
    Bank bank(program);
    for (const double x : places(points, random)) {
      const double y = static_cast<float>(0.01 * uniform(random)), at = x + y / 2, step = 1e-7;
      if (std::ranges::any_of(points, [&](const Point& point) { return std::abs(point.place - at) < 2 * step; }))
        continue;
      const double slope = (interpolated(points, at + step) - interpolated(points, at - step)) / (2 * step);
      ASSERT_NEAR(push(bank, x, y).x, 1e-3 * slope, 1e-5 + 1e-6 * std::abs(slope)) << written(points) << " at " << at;
      ASSERT_NEAR(push(bank, x, y).y, 5e-4 * slope, 1e-5 + 1e-6 * std::abs(slope)) << written(points) << " at " << at;
    }
  }
}

TEST(Curves, FollowTheParametersInTheirPoints) {
  const Program program = compiled(R"(
    param edge = 10 mm in 5 mm .. 20 mm
    param rise = 1 N in -2 N .. 2 N
    let c = curve(-edge, 0 N, edge / 2, rise, edge + 10 mm, -rise / 4)
    force = vector(c(x), 0 N) + grad(c(y)) * 1 mm)");
  std::mt19937 random(13);
  for (int each = 0; each < 50; ++each) {
    const auto edge = static_cast<float>(0.0125 + 0.0075 * uniform(random));
    const auto rise = static_cast<float>(2 * uniform(random));
    Bank bank(program, std::vector<float>{edge, rise}, program.default_size());
    const Points points{{-edge, 0}, {edge / 2, rise}, {edge + 0.01, -rise / 4}};
    for (const double x : places(points, random))
      ASSERT_NEAR(push(bank, x, 0.07).x, interpolated(points, x), tolerance(points)) << edge << " " << rise << " " << x;
    ASSERT_NEAR(push(bank, 0, 0).y, 1e-3 * rise / (1.5 * edge), 1e-5);
    ASSERT_NEAR(push(bank, 0, 0.07).y, 0, 1e-9);
  }
}

TEST(Curves, AreConstantsOfTheFileAndArgumentsToo) {
  const Program program = compiled("    force = vector(twice(push, x) + twice(curve(0 mm, 1 N, 1 mm, 2 N), y), 0 N)",
                                   "let push = curve(-10 mm, 0 N, 10 mm, 1 N)\nfunction twice(c, at) = 2 * c(at)");
  Bank bank(program);
  EXPECT_FLOAT_EQ(push(bank, 0.005, -0.01).x, 2 * 0.75f + 2);
  EXPECT_FLOAT_EQ(push(bank, -0.005, 0.0005).x, 2 * 0.25f + 3);
}

/// A table's force at x, in newtons.
Program tabled(const std::string& csv, const std::string& call = "table(\"measured.csv\")") {
  Files files;
  files.contents["measured.csv"] = csv;
  return compiled("    let t = " + call + "\n    force = vector(t(x), 0 N)", "", "", files);
}

TEST(Tables, GoThroughTheirSamples) {
  std::mt19937 random(14);
  for (int each = 0; each < 20; ++each) {
    const int count = 4 + static_cast<int>(random() % 40);
    Points points;
    std::string csv = "x (mm), force (N)\n";
    for (int i = 0; i < count; ++i) {
      points.push_back({(-50 + 2 * i) * 1e-3, std::round(200 * uniform(random)) * 0.01});
      csv += fmt::format("{}, {:.2f}\n", -50 + 2 * i, points.back().value);
    }
    const Program program = tabled(csv);
    Bank bank(program);
    // 16 bits of up to 4 N are steps of 6e-5 N; the spline overshoots by three times as much.
    for (const auto& [place, value] : points) ASSERT_NEAR(push(bank, place).x, value, 3e-4) << csv << place;
    ASSERT_NEAR(push(bank, -0.07).x, points.front().value, 3e-4);
    ASSERT_NEAR(push(bank, 0.079).x, points.back().value, 3e-4);
  }
}

TEST(Tables, OfAStraightLineFollowIt) {
  const Program program = tabled("x (mm), force (N)\n-40, -2\n-20, -1\n0, 0\n20, 1\n40, 2\n60, 3\n");
  Bank bank(program);
  // The spline is mirrored at its ends, so it bends within about four samples of them.
  EXPECT_NEAR(push(bank, 0.010).x, 0.5, 0.05);
  EXPECT_NEAR(push(bank, 0.020).x, 1, 3e-4);
}

TEST(Tables, WithUnequalSpacingAreSampledFromPointToPoint) {
  const Points points{{-0.03, 0.2}, {-0.029, 1.5}, {-0.01, 1.0}, {0.0, -1.0}, {0.02, -0.5}, {0.033, 1.25}};
  std::string csv = "x (mm), force (N)\n";
  for (const auto& [place, value] : points) csv += fmt::format("{:.1f}, {}\n", place * 1e3, value);
  const Program program = tabled(csv);
  Bank bank(program);
  // The spacing is that of the closest two points: 63 mm in steps of 1 mm are 64 samples, each on the line. At kinks of
  // the line, the spline overshoots between samples.
  for (int i = 0; i < 64; ++i) {
    const double place = -0.03 + i * 1e-3;
    ASSERT_NEAR(push(bank, place).x, interpolated(points, place), 5e-4) << place;
  }
  // Samples change by 1.3 N in the steep segment and by at most 0.2 N elsewhere.
  for (int i = 0; i < 63; ++i) {
    const double place = -0.03 + (i + 0.5) * 1e-3;
    ASSERT_NEAR(push(bank, place).x, interpolated(points, place), i < 8 ? 0.25 : 0.03) << place;
  }
}

TEST(Tables, AreReadWithUnitsNamesAndComments) {
  const std::string csv =
      "\xEF\xBB\xBF# taken on a bench\r\n\r\n\"time (s)\", travel (cm), \"pull (gf)\", count\r\n"
      "0, -2, 100, 3\r\n# half way\r\n1, -1, 50, 2\r\n2, 0, -20, 1\r\n3, 1, 10, 7\r\n";
  const Points travel{{-0.02, 0.980665}, {-0.01, 0.4903325}, {0, -0.196133}, {0.01, 0.0980665}};
  for (const char* call : {"table(\"measured.csv\", \"travel\", \"pull\")",
                           "table(\"measured.csv\", value: \"pull\", place: \"travel\")"}) {
    const Program program = tabled(csv, call);
    Bank pulled(program);
    for (const auto& [place, value] : travel) EXPECT_NEAR(push(pulled, place).x, value, 1e-4) << call << place;
  }
  // Of plain numbers.
  const Program counted = [&] {
    Files files;
    files.contents["measured.csv"] = csv;
    return compiled("    let t = table(\"measured.csv\", \"travel\", \"count\")\n    force = vector(t(x) * 1 N, 0 N)",
                    "", "", files);
  }();
  Bank bank(counted);
  EXPECT_NEAR(push(bank, -0.01).x, 2, 5e-4);
  EXPECT_NEAR(push(bank, 0.01).x, 7, 5e-4);
  EXPECT_THROW(tabled(csv, "table(\"measured.csv\", \"travel\", \"count\")"), std::runtime_error);
  EXPECT_THROW(tabled(csv, "table(\"measured.csv\", \"pull\", \"travel\")"), std::runtime_error);
}

/// A picture of 12 x 10 grey values, as text.
Files picture() {
  std::mt19937 random(3);
  std::string text = "P2\n12 10\n255\n";
  for (int i = 0; i < 120; ++i) text += fmt::format("{} ", random() % 256);
  Files files;
  files.contents["stone.pgm"] = text + "\n";
  return files;
}

TEST(Reliefs, AreImagesAtAnotherPlace) {
  const std::string arguments = "(\"stone.pgm\", scale: 5 mm/px, height: 2 mm)";
  const Program here =
      compiled("    height h = image" + arguments + "\n    force = vector(h / 1 mm * 1 N, 0 N)", "", "", picture());
  const Program shifted = compiled(
      "    let s = relief" + arguments + "\n    force = vector(s(hand - vector(7 mm, -3 mm)) / 1 mm * 1 N, 0 N)", "",
      "", picture());
  const Program turned =
      compiled("    let s = relief" + arguments + "\n    force = vector(s(perpendicular(hand)) / 1 mm * 1 N, 0 N)", "",
               "", picture());
  Bank image(here), moved(shifted), rotated(turned);
  std::mt19937 random(15);
  for (int i = 0; i < 500; ++i) {
    const double x = 0.05 * uniform(random), y = 0.05 * uniform(random);
    // The force changes by up to 1.3 N per pixel; places are precise to a few nm.
    ASSERT_NEAR(push(moved, x, y).x, push(image, x - 0.007, y + 0.003).x, 1e-4) << x << " " << y;
    ASSERT_NEAR(push(rotated, x, y).x, push(image, -y, x).x, 1e-4) << x << " " << y;
  }
}

TEST(Reliefs, PushByTheSlopeOfThePicture) {
  const std::string arguments = "(\"stone.pgm\", scale: 5 mm/px, height: 2 mm)";
  const Program image = compiled("    force = grad(image" + arguments + ") * 1 N", "", "", picture());
  const Program relief = compiled(
      "    let s = relief" + arguments + "\n    force = grad(s(perpendicular(hand) + vector(4 mm, 0 mm))) * 1 N", "",
      "", picture());
  Bank flat(image), turned(relief);
  std::mt19937 random(16);
  for (int i = 0; i < 300; ++i) {
    const double x = 0.05 * uniform(random), y = 0.05 * uniform(random);
    // By hand: the relief is read at (4 mm - y, x), so its slope (p, q) there becomes the force (q, -p).
    const Force slope = push(flat, 0.004 - y, x), felt = push(turned, x, y);
    ASSERT_NEAR(felt.x, slope.y, 1e-4) << x << " " << y;
    ASSERT_NEAR(felt.y, -slope.x, 1e-4) << x << " " << y;
  }
}

}  // namespace
}  // namespace wale::compiling::fields_test
