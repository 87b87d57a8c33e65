// What every file knows is written out once; what a file says itself is read at each call. Both must come to the same.

#include <gtest/gtest.h>

#include <stdexcept>
#include <string>

#include "schema/patch_program.hpp"
#include "tests/compiler/compiling.hpp"

namespace wale::compiling::written_out_test {
namespace {

/// As schema/functions.wale has them, under names of the file's own.
constexpr const char* own_functions =
    "function own_clamp(value, low, high) = min(max(value, low), high)\n"
    "function own_smoothstep(t) = own_clamp(t, 0, 1)^2 * (3 - 2 * own_clamp(t, 0, 1))\n"
    "function own_mix(a, b, way) = a + way * (b - a)\n"
    "function own_modulo(value, divisor) = value - divisor * floor(value / divisor)\n"
    "function own_perpendicular(vector) = vector(-vector.y, vector.x)\n"
    "function own_smoothed_steps(t, smooth) =\n"
    "  normal((t - floor(t + 0.5) - 1) / smooth) + normal((t - floor(t + 0.5)) / smooth) +\n"
    "  normal((t - floor(t + 0.5) + 1) / smooth) + floor(t + 0.5)\n"
    "function own_grating(along: length, period: length, duty = 0.5, smooth = 24/256) =\n"
    "  own_smoothed_steps(along / period + duty / 2, within(smooth, 0.005, 0.3)) -\n"
    "  own_smoothed_steps(along / period - duty / 2, within(smooth, 0.005, 0.3))\n";

std::string bytes_of(std::string force, const std::string& prefix) {
  for (auto at = force.find('$'); at != std::string::npos; at = force.find('$')) force.replace(at, 1, prefix);
  PatchProgram program =
      compiled("    param k = 2 mm in 1 mm .. 5 mm\n    force = " + force, own_functions).description();
  program.places = {};  // where it is written
  program.layers = {};  // and how
  const auto bytes = write_patch_program(program);
  return std::string(reinterpret_cast<const char*>(bytes.data()), bytes.size());
}

TEST(WrittenOut, ComesToWhatTheBodyComesToWhateverTheArgumentsAre) {
  // The same functions, with arguments that are known, that a slider turns, that follow the hand, that are one another;
  // of several dimensions; and twice each, since the first call may be the one that is read.
  for (int round = 0; round < 2; ++round)
    for (const char* force : {
             "vector($smoothstep(0.3) * 1 N, $smoothstep(x / k) * 1 N)",
             "vector($smoothstep(k / 5 mm) * 1 N, $smoothstep(2) * 1 N * $mix(0.2, 0.2, y / k))",
             "vector($clamp(x, 0 mm, k) * 3 N/m, $clamp(y / k, 0, 1) * 1 N)",
             "vector($clamp(k, k, k) * 3 N/m, $modulo(x, k) * 10 N/m)",
             "$mix(vector(1 N, 2 N), $perpendicular(hand) * 1 N/m, $modulo(x / k, 1))",
             "$perpendicular($perpendicular(vector($clamp(x, y, k), k))) * 1 N/m",
             "vector($grating(x, period: k) * 1 N, $grating(y, 2 mm, smooth: x / 1 m) * 1 N)",
             "vector($grating(x, period: k, duty: k / 9 mm) * 1 N, $grating(k, period: k, smooth: 0.2) * 1 N)",
         })
      EXPECT_EQ(bytes_of(force, ""), bytes_of(force, "own_")) << force;
}

/// What is wrong with a force; empty if nothing is.
std::string complaint(const std::string& force) {
  try {
    compiled("    param k = 2 mm in 1 mm .. 5 mm\n    force = " + force);
    return "";
  } catch (const std::runtime_error& error) {
    return error.what();
  }
}

TEST(WrittenOut, IsNotWhatCountsWhereAnArgumentIsWrong) {
  // What has been written out for right arguments serves no wrong ones of the same kind, whichever come first.
  for (int round = 0; round < 2; ++round) {
    EXPECT_EQ(complaint("lateral(grating(x, period: k), 1 N)"), "");
    EXPECT_EQ(complaint("lateral(grating(x, period: k, smooth: 0.3), 1 N)"), "");
    EXPECT_EQ(complaint("lateral(grating(x, period: k, smooth: 0.1 * x / k), 1 N)"), "");
    for (const char* smooth : {"0.301", "0.004", "0 / 0"})
      EXPECT_NE(complaint(std::string("lateral(grating(x, period: k, smooth: ") + smooth + "), 1 N)")
                    .find(" is out of range"),
                std::string::npos)
          << smooth;
    EXPECT_NE(complaint("lateral(grating(x + 1 mm * sin(time / 1 s), period: k), 1 N)")
                  .find("`peak` takes a height that depends on the place only, but this changes with time"),
              std::string::npos);
  }
}

}  // namespace
}  // namespace wale::compiling::written_out_test
