// Crest, steepness, regularity, crispness, sharpness and bumpiness, against closed forms.

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "tests/compiler/compiling.hpp"
#include "tests/truth/composition.hpp"
#include "tests/truth/reading_of.hpp"

namespace wale::truth {
namespace {

using std::numbers::pi;

constexpr std::size_t programs = 24;     // of each class
constexpr double size_error = 0.03;      // relative
constexpr double share_error = 0.1;      // of 1: a share of two random samples
constexpr std::size_t samples = 100000;  // of one period

/// A waveform that reaches 1, and the change of its force by turns; without one it jumps.
struct Form {
  Waveform wave;
  double crest = 0;
  std::function<double(double)> slope;
};

/// The maxima over the root mean squares are those of textbooks, or follow by integration.
Form any_form(Chance& chance) {
  switch (static_cast<int>(chance.between(0, 7))) {
    case 0: return {square(), 1, {}};
    case 1: return {triangle(), std::sqrt(3.0), [](double) { return 4.0; }};
    case 2: return {sawtooth(), std::sqrt(3.0), {}};
    case 3: {
      const double duty = rounded(chance.between(0.1, 0.3), 3);
      return {ridge(duty), std::sqrt(2 / duty),
              [duty](double t) { return t < duty ? 2 * pi / duty * std::cos(2 * pi * t / duty) : 0.0; }};
    }
    case 4: {
      const double width = rounded(chance.between(0.05, 0.1), 3);
      return {smooth_bumps(width), 1 / std::sqrt(width * std::numbers::e * std::sqrt(pi) / 2), [width](double t) {
                const double s = (t - 0.5) / width;
                return (1 - s * s) * std::exp(0.5 - s * s / 2) / width;
              }};
    }
    default: return {sine(), std::numbers::sqrt2, [](double t) { return 2 * pi * std::cos(2 * pi * t); }};
  }
}

/// The 99th percentile of the size of a function over one turn.
double percentile_over_a_turn(const std::function<double(double)>& law) {
  std::vector<double> sizes;
  for (std::size_t i = 0; i < samples; ++i)
    sizes.push_back(std::abs(law((static_cast<double>(i) + 0.5) / static_cast<double>(samples))));
  const auto rank = sizes.begin() + static_cast<std::ptrdiff_t>(0.99 * static_cast<double>(samples));
  std::ranges::nth_element(sizes, rank);
  return *rank;
}

struct ShapeCase {
  std::string source;
  double expected = 0;  ///< 0: none
  double error = 0;     ///< allowed
};

struct ShapeClass {
  const char* name;
  ShapeCase (*made)(Chance&);
  double (*read)(const ShapeReading&);
  /// How many of `programs` are right; no change may lower it. The bar of 98 % is missed by the classes with less than
  /// all, which README.md names.
  std::size_t floor = programs;
};

Composition one(Chance& chance, const Form& form, double& period) {
  Composition made;
  period = rounded(chance.octaves(1e-3, 20e-3), 3);
  made.push_wave({form.wave, period, any_orientation(chance), rounded(chance.between(0, 1), 3),
                  rounded(chance.octaves(0.1, 4), 3)});
  return made;
}

ShapeCase crest(Chance& chance) {
  const Form form = any_form(chance);
  double period = 0;
  return {one(chance, form, period).finished().source, form.crest, size_error * form.crest};
}

/// How suddenly a force changes, over its size; of a force that jumps it is no number.
ShapeCase sharpness(Chance& chance) {
  Form form = any_form(chance);
  while (!form.slope) form = any_form(chance);
  double period = 0;
  const std::string source = one(chance, form, period).finished().source;
  const double expected = percentile_over_a_turn(form.slope) / period / percentile_over_a_turn(form.wave.force);
  return {source, expected, size_error * expected};
}

ShapeCase regularity(Chance& chance) {
  double period = 0;
  return {one(chance, any_form(chance), period).finished().source, 1, share_error};
}

/// A sine along x beside a force that is drawn anew in each square: its mean square is that of the numbers from -1 to
/// 1, a third.
ShapeCase half_regular(Chance& chance) {
  const double wave = rounded(chance.octaves(0.3, 3), 3), noise = rounded(chance.octaves(0.3, 3), 3);
  const std::string source = fmt::format(
      "wale 1\nmaterial m {{\n  physical {{\n    force wave = vector({} N * sin(2 * pi * x / {}), 0 N)\n"
      "    force grain = vector({} N * (2 * lattice(floor(x / 1 mm), floor(y / 1 mm), {}) - 1), 0 N)\n  }}\n}}\n",
      number(wave), millimetres(rounded(chance.octaves(2e-3, 20e-3), 3)), number(noise),
      static_cast<int>(chance.between(0, 1000)));
  const double repeats = wave * wave / 2, all = repeats + noise * noise / 3;
  return {source, repeats / all, share_error};
}

ShapeCase crispness(Chance& chance) {
  const double damping = rounded(chance.octaves(0.5, 20), 3);
  const std::string face = millimetres(rounded(chance.between(-0.01, 0.03), 3));
  return {fmt::format("wale 1\nmaterial m {{\n  physical {{\n    force = firm({0} N/m, face: {1}) + crisp({2} N s/m, "
                      "face: {1})\n  }}\n}}\n",
                      number(rounded(chance.octaves(150, 1500), 3)), face, number(damping)),
          damping, std::max(size_error * damping, 0.05)};
}

ShapeCase no_crispness(Chance& chance) {
  return {
      fmt::format("wale 1\nmaterial m {{\n  physical {{ force = firm({} N/m, face: {}) }}\n}}\n",
                  number(rounded(chance.octaves(150, 1500), 3)), millimetres(rounded(chance.between(-0.01, 0.03), 3))),
      0, 0.05};
}

/// The amplitude, of waves that are longer than a texture's.
ShapeCase bumpiness(Chance& chance) {
  Composition made;
  const Form form = any_form(chance);
  made.push_wave({form.wave, rounded(chance.octaves(11e-3, 45e-3), 3), any_orientation(chance),
                  rounded(chance.between(0, 1), 3), rounded(chance.octaves(0.1, 4), 3)});
  const Case finished = made.finished();
  const double expected = finished.truth[Cue::amplitude].value;
  return {finished.source, expected, size_error * expected};
}

const std::vector<ShapeClass>& shape_classes() {
  static const std::vector<ShapeClass> all{
      {"crest", crest, [](const ShapeReading& found) { return found.crest; }},
      {"sharpness", sharpness, [](const ShapeReading& found) { return found.sharpness.value_or(0); }, 22},
      {"regularity", regularity, [](const ShapeReading& found) { return found.regularity; }},
      {"half regular", half_regular, [](const ShapeReading& found) { return found.regularity; }, 22},
      {"crispness", crispness, [](const ShapeReading& found) { return found.crispness.value_or(0); }},
      {"no crispness", no_crispness, [](const ShapeReading& found) { return found.crispness.value_or(0); }},
      {"bumpiness", bumpiness, [](const ShapeReading& found) { return found.bumpiness.value_or(0); }},
  };
  return all;
}

TEST(Truth, ShapesAreReadAsTheirClosedFormsSay) {
  for (const ShapeClass& each : shape_classes()) {
    std::size_t right = 0;
    std::string wrong;
    for (std::size_t i = 0; i < programs; ++i) {
      Chance chance(each.name, i);
      const ShapeCase made = each.made(chance);
      const double found = each.read(shape_of(compiling::Compiled(made.source).only()));
      if (std::abs(found - made.expected) <= made.error)
        ++right;
      else
        wrong +=
            fmt::format("{}/{}: expected {:.4g}, read {:.4g}\n{}", each.name, i, made.expected, found, made.source);
    }
    fmt::print("{:<14}{:>3} of {}\n", each.name, right, programs);
    EXPECT_GE(right, each.floor) << wrong;
  }
}

}  // namespace
}  // namespace wale::truth
