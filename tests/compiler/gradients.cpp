// The forces of `grad` and `lateral` against the same heights in double precision.

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <random>

#include "tests/compiler/compiling.hpp"

namespace wale::compiling::gradients_test {
namespace {

using Height = std::function<double(double, double)>;

double normal(double t) { return 0.5 * std::erfc(-t / std::sqrt(2.0)); }

/// A square wave of that period, 1 on its hills and 0 between them, blurred by a Gaussian whose standard deviation is
/// `smooth` periods. One hill is centred at 0. `along` and `period` are in m.
double grating(double along, double period, double duty = 0.5, double smooth = 24.0 / 256) {
  const double t = along / period;
  double sum = 0;
  for (double hill = std::floor(t) - 6; hill <= std::floor(t) + 6; ++hill)
    sum += normal((t - hill + duty / 2) / smooth) - normal((t - hill - duty / 2) / smooth);
  return sum;
}

/// The slope by central differences, whose error is far below that of 32-bit arithmetic.
std::array<double, 2> slope(const Height& height, double x, double y, double step = 1e-7) {
  return {(height(x + step, y) - height(x - step, y)) / (2 * step),
          (height(x, y + step) - height(x, y - step)) / (2 * step)};
}

/// Random places on the patch, in m, outside of its rim.
std::vector<glm::vec2> places(int count) {
  std::mt19937 random(42);
  const auto coordinate = [&] { return static_cast<float>(0.07 * (random() / 2147483648.0 - 1)); };
  std::vector<glm::vec2> all;
  for (int i = 0; i < count; ++i) {
    const float x = coordinate();
    all.push_back({x, coordinate()});
  }
  return all;
}

/// Expects that `grad` of the expression, in 1/m, is the slope of `height` at 500 places.
void expect_gradient(const std::string& expression, const Height& height, double tolerance_per_metre) {
  const Program program = compiled("    force = grad(" + expression + ") * 1 N * 1 mm");
  Bank bank(program);
  for (const auto& place : places(500)) {
    const Force force = tick(bank, {place, {0, 0}});
    const auto expected = slope(height, place.x, place.y);
    for (int axis = 0; axis < 2; ++axis)
      ASSERT_NEAR(force[axis] * 1e3, expected[axis], tolerance_per_metre)
          << expression << " at " << place.x << " " << place.y;
  }
}

// At 70 mm a float of x is precise to 4 nm, and at these periods slopes change by up to about 1e7 /m^2.

TEST(Gradient, OfAGrating) {
  expect_gradient(
      "grating(x, period: 2.5 mm)", [](double x, double) { return grating(x, 0.0025); }, 2);
  expect_gradient(
      "grating(y, period: 10 mm, duty: 0.3, smooth: 0.05)",
      [](double, double y) { return grating(y, 0.01, 0.3, 0.05); }, 0.5);
  expect_gradient(
      "grating(0.6 * x + 0.8 * y, period: 3 mm)", [](double x, double y) { return grating(0.6 * x + 0.8 * y, 0.003); },
      2);
}

TEST(Gradient, OfSumsAndProducts) {
  expect_gradient(
      "grating(x, period: 3 mm) + 0.5 * grating(y, period: 5 mm)",
      [](double x, double y) { return grating(x, 0.003) + 0.5 * grating(y, 0.005); }, 2);
  expect_gradient(
      "grating(x, period: 3 mm) * grating(y, period: 5 mm)",
      [](double x, double y) { return grating(x, 0.003) * grating(y, 0.005); }, 2);
}

TEST(Gradient, OfEveryFunctionThatHasOne) {
  const auto u = [](double x, double y) { return x / 0.02 + y / 0.05; };
  const auto v = [](double x, double y) { return 1.5 + 0.2 * std::sin(x / 0.01) + y; };  // never zero
  const std::string U = "(x / 20 mm + y / 50 mm)", V = "(1.5 + 0.2 * sin(x / 10 mm) + y / 1 m)";
  const std::vector<std::tuple<std::string, Height>> cases{
      {"sin" + U, [&](double x, double y) { return std::sin(u(x, y)); }},
      {"cos" + U, [&](double x, double y) { return std::cos(u(x, y)); }},
      {"exp(0.3 * " + U + ")", [&](double x, double y) { return std::exp(0.3 * u(x, y)); }},
      {"log" + V, [&](double x, double y) { return std::log(v(x, y)); }},
      {"log2" + V, [&](double x, double y) { return std::log2(v(x, y)); }},
      {"log10" + V, [&](double x, double y) { return std::log10(v(x, y)); }},
      {"sqrt" + V, [&](double x, double y) { return std::sqrt(v(x, y)); }},
      {V + "^1.3", [&](double x, double y) { return std::pow(v(x, y), 1.3); }},
      {V + "^-2", [&](double x, double y) { return std::pow(v(x, y), -2); }},
      {U + "^3", [&](double x, double y) { return std::pow(u(x, y), 3); }},
      {"normal" + U, [&](double x, double y) { return normal(u(x, y)); }},
      {U + " / " + V, [&](double x, double y) { return u(x, y) / v(x, y); }},
      {"-" + U + " - 2 * " + V, [&](double x, double y) { return -u(x, y) - 2 * v(x, y); }},
      {"length(hand) / 30 mm", [](double x, double y) { return std::hypot(x, y) / 0.03; }},
  };
  for (const auto& [text, height] : cases) expect_gradient(text, height, 0.02);
}

TEST(Gradient, TakesTheSlopeOfTheChosenSide) {
  // The slopes are 1 / (20 mm) on one side and 1 / (50 mm) on the other; no random place lies on the kink.
  const auto expect_slopes = [](const std::string& text,
                                const std::function<std::array<double, 2>(double, double)>& expected) {
    const Program program = compiled("    force = grad(" + text + ") * 1 N * 1 mm");
    Bank bank(program);
    for (const auto& place : places(300)) {
      const Force force = tick(bank, {place, {0, 0}});
      for (int axis = 0; axis < 2; ++axis)
        ASSERT_NEAR(force[axis] * 1e3, expected(place.x, place.y)[axis], 1e-3) << text;
    }
  };
  using Pair = std::array<double, 2>;
  expect_slopes("abs(x / 20 mm)", [](double x, double) { return Pair{x < 0 ? -50.0 : 50.0, 0}; });
  expect_slopes("min(x / 20 mm, y / 50 mm)", [](double x, double y) {
    return x / 0.02 < y / 0.05 ? Pair{50, 0} : Pair{0, 20};
  });
  expect_slopes("max(x / 20 mm, y / 50 mm)", [](double x, double y) {
    return x / 0.02 > y / 0.05 ? Pair{50, 0} : Pair{0, 20};
  });
  expect_slopes("if x < 3 mm then y / 50 mm else 2 * x / 20 mm", [](double x, double) {
    return x < 0.003 ? Pair{0, 20} : Pair{100, 0};
  });
  expect_slopes("x / 20 mm + floor(y / 1 mm)", [](double, double) { return Pair{50, 0}; });
}

/// The 99th percentile of the slope at 200 000 random places of the default patch, 160 mm wide with a rim of 5 mm.
double peak_of(const Height& height) {
  std::mt19937 random(5);
  std::vector<double> sizes;
  const auto coordinate = [&] { return 0.075 * (random() / 2147483648.0 - 1); };
  for (int i = 0; i < 200000; ++i) {
    const double x = coordinate(), y = coordinate();
    const auto s = slope(height, x, y, 1e-6);
    sizes.push_back(std::hypot(s[0], s[1]));
  }
  const auto at = sizes.begin() + static_cast<std::ptrdiff_t>(0.99 * static_cast<double>(sizes.size()));
  std::nth_element(sizes.begin(), at, sizes.end());
  return *at;
}

TEST(Lateral, PushesDownhillScaledByItsPeakAndHeldAtItsAmplitude) {
  const std::vector<std::pair<std::string, Height>> cases{
      {"grating(x, period: 4 mm)", [](double x, double) { return grating(x, 0.004); }},
      {"grating(x, period: 4 mm) + 0.7 * grating(y, period: 7 mm)",
       [](double x, double y) { return grating(x, 0.004) + 0.7 * grating(y, 0.007); }},
      {"sin(x / 1 mm) * sin(y / 2 mm)", [](double x, double y) { return std::sin(x / 1e-3) * std::sin(y / 2e-3); }}};
  for (const auto& [text, height] : cases) {
    constexpr double amplitude = 1.7;
    const double peak = peak_of(height);
    const Program program = compiled("    force = lateral(" + text + ", amplitude: 1.7 N)");
    Bank bank(program);
    for (const auto& place : places(400)) {
      const Force force = tick(bank, {place, {0, 0}});
      const auto s = slope(height, place.x, place.y);
      const double size = amplitude * std::hypot(s[0], s[1]) / peak;
      const double held = std::min(1.0, amplitude / size);
      // Both peaks are percentiles of samples, hence 1 %.
      ASSERT_NEAR(force.x, -amplitude * s[0] / peak * held, 0.01 * amplitude)
          << text << " at " << place.x << " " << place.y;
      ASSERT_NEAR(force.y, -amplitude * s[1] / peak * held, 0.01 * amplitude)
          << text << " at " << place.x << " " << place.y;
      ASSERT_LE(std::hypot(force.x, force.y), amplitude * (1 + 1e-6));
    }
  }
}

/// A picture of 12 x 10 grey values, as text.
std::string picture() {
  std::mt19937 random(3);
  std::string text = "P2\n12 10\n255\n";
  for (int i = 0; i < 120; ++i) text += fmt::format("{} ", random() % 256);
  return text + "\n";
}

TEST(Gradient, OfAnImageIsTheSlopeOfItsRelief) {
  Files files;
  files.contents["stone.pgm"] = picture();
  // 12 px of 5 mm: 60 mm across. The relief is the height in m; the force shows the slope of the same.
  const Program program = compiled(
      "    height stone = image(\"stone.pgm\", scale: 5 mm/px, height: 2 mm)\n"
      "    force = grad(stone) * 1 N",
      "", "", files);
  Bank bank(program);
  const float step = 1e-4f;  // a fiftieth of a pixel
  for (const auto& place : places(500)) {
    if (std::abs(place.x) > 0.026 || std::abs(place.y) > 0.021) continue;  // mirrored beyond, with a kink
    const std::array<glm::vec2, 4> around{
        {{place.x + step, place.y}, {place.x - step, place.y}, {place.x, place.y + step}, {place.x, place.y - step}}};
    std::array<float, 4> heights{};
    relief_all(bank, around, heights);
    const Force force = tick(bank, {place, {0, 0}});
    // Heights change by up to 2 mm per pixel of 5 mm, slopes are about 0.4, and heights are precise to 1e-7 of 2 mm.
    EXPECT_NEAR(force.x, (heights[0] - heights[1]) / (around[0].x - around[1].x), 1e-3);
    EXPECT_NEAR(force.y, (heights[2] - heights[3]) / (around[2].y - around[3].y), 1e-3);
  }
}

TEST(Gradient, OfAnImageRunsTheRightWayUp) {
  // The picture is brighter to the right and to the top, so the height rises along +x and +y.
  std::string ramp = "P2\n8 8\n255\n";
  for (int row = 0; row < 8; ++row)
    for (int column = 0; column < 8; ++column) ramp += fmt::format("{} ", 10 * column + 20 * (7 - row));
  Files files;
  files.contents["ramp.pgm"] = ramp;
  const Program program =
      compiled("    force = grad(image(\"ramp.pgm\", scale: 5 mm/px, height: 2.55 mm)) * 1 N", "", "", files);
  Bank bank(program);
  const Force force = tick(bank, {{0.001f, 0.002f}, {0, 0}});
  // 10 of 255 of 2.55 mm in 5 mm; the spline overshoots a little at the mirrored edges.
  EXPECT_NEAR(force.x, 0.02, 0.002);
  EXPECT_NEAR(force.y, 0.04, 0.004);
}

}  // namespace
}  // namespace wale::compiling::gradients_test
