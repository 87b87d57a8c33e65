// What every file knows is written out once; what a file says itself is read at each call. Both must come to the same.

#include <gtest/gtest.h>

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
    "function own_perpendicular(vector) = vector(-vector.y, vector.x)\n";

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
         })
      EXPECT_EQ(bytes_of(force, ""), bytes_of(force, "own_")) << force;
}

}  // namespace
}  // namespace wale::compiling::written_out_test
