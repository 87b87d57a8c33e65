// A function of the language is expanded once, and a function of the file at each call. Both must give the same
// program.

#include <gtest/gtest.h>

#include <stdexcept>
#include <string>

#include "tests/compiler/compiling.hpp"
#include "wale/patch_program.hpp"

namespace wale::compiling::written_out_test {
namespace {

/// Functions of schema/functions.wale under other names, as functions of the file.
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
  program.places = {};  // names differ, so columns of the text may too
  program.layers = {};  // the text differs
  const auto bytes = write_patch_program(program);
  return std::string(reinterpret_cast<const char*>(bytes.data()), bytes.size());
}

TEST(WrittenOut, GivesTheSameProgramAsTheBodyForAllArguments) {
  // Arguments are constants, parameters, inputs of the hand, or equal to each other, and of several dimensions. Each is
  // compiled twice, since the first call may be the one that expands the body.
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

/// The errors of a material with this force; empty when it compiles.
std::string complaint(const std::string& force) {
  try {
    compiled("    param k = 2 mm in 1 mm .. 5 mm\n    force = " + force);
    return "";
  } catch (const std::runtime_error& error) {
    return error.what();
  }
}

TEST(WrittenOut, StillChecksArguments) {
  // A body that was expanded for valid arguments is not used for invalid ones of the same rate, in either order.
  for (int round = 0; round < 2; ++round) {
    EXPECT_EQ(complaint("lateral(grating(x, period: k), 1 N)"), "");
    EXPECT_EQ(complaint("lateral(grating(x, period: k, smooth: 0.3), 1 N)"), "");
    EXPECT_EQ(complaint("lateral(grating(x, period: k, smooth: 0.1 * x / k), 1 N)"), "");
    for (const char* smooth : {"0.301", "0.004", "0 / 0"})
      EXPECT_NE(complaint(std::string("lateral(grating(x, period: k, smooth: ") + smooth + "), 1 N)")
                    .find(", outside its range, "),
                std::string::npos)
          << smooth;
    EXPECT_NE(complaint("lateral(grating(x + 1 mm * sin(time / 1 s), period: k), 1 N)")
                  .find("`peak` takes a height that depends on the place only, but this changes with time"),
              std::string::npos);
  }
}

}  // namespace
}  // namespace wale::compiling::written_out_test
