// What a function declares of its arguments, by their dimensions, under any name.

#include <gtest/gtest.h>

#include <string>

#include "tests/calibration/declared.hpp"

namespace wale::uses_test {
namespace {

std::string codes(const std::string& height) {
  calibrating::Declared declared(
      "export function rows(where: position, step: wavelength, pick: choice = 0) =\n"
      "  sin(2 pi * where / step) + 0.1 * noise(where / step, pick)\n"
      "export function plain(along: length, period: length, seed = 0) =\n"
      "  abs(fract(along / period) - 0.5) + 0.1 * mix(lattice(along / period, seed), 0, 0.5)\n"
      "material m { physical { force = lateral(" +
      height + ", amplitude: 1 N) } }\n");
  declared.program("m");
  return declared.codes();
}

TEST(Uses, FollowFromTheDimensionAndNotFromTheName) {
  EXPECT_EQ(codes("rows(x, 3 mm)"), "");
  EXPECT_EQ(codes("rows(x, 0.1 mm)"), "W0309");
  EXPECT_EQ(codes("rows(x, 3 m)"), "W0308");
  EXPECT_EQ(codes("rows(5 mm, 1 mm + abs(x))"), "W0313");
  EXPECT_EQ(codes("rows(x, 3 mm, x / 1 mm)"), "W0313");
  EXPECT_EQ(codes("plain(x, 0.1 mm)"), "");
  // A sine says of itself what its period is.
  EXPECT_EQ(codes("sin(2 pi * x / 0.1 mm)"), "W0309");
  EXPECT_EQ(codes("sin(2 pi * x / 0.12 mm)"), "");
}

TEST(Uses, AFrequencyHasTwoTicksAPeriodAtLeast) {
  const auto of = [](const std::string& rate) {
    calibrating::Declared declared("material m { physical { active 2 W; force = vibrate(0.5 N, rate: " + rate +
                                   ") } }\n");
    declared.program("m");
    return declared.codes();
  };
  EXPECT_EQ(of("120 Hz"), "");
  EXPECT_EQ(of("440 Hz"), "");
  EXPECT_EQ(of("445 Hz"), "");
  EXPECT_EQ(of("446 Hz"), "W0309");  // it swells and vanishes 8 times a second
  EXPECT_EQ(of("450 Hz"), "W0309");
  EXPECT_EQ(of("460 Hz"), "W0309");  // `sandpaper` has 900 ticks a second
  EXPECT_EQ(of("120 kHz"), "W0309");
}

}  // namespace
}  // namespace wale::uses_test
