// `compare`, on two programs of which one changes with use or with time, or is a sum, and the other has the same size in
// the mean.

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

#include "tests/compiler/compiling.hpp"
#include "tests/truth/composition.hpp"
#include "tests/truth/reading_of.hpp"

namespace wale::truth {
namespace {

using std::numbers::pi;
constexpr std::size_t pairs_of_each = 6;

/// The statements of both programs.
using Pair = std::pair<std::string, std::string>;

double size_in_8_s(const std::function<double(double)>& at) {
  std::vector<double> sizes;
  constexpr int moments = 200000;
  for (int i = 0; i < moments; ++i) sizes.push_back(std::abs(at(8.0 * (i + 0.5) / moments)));
  std::ranges::nth_element(sizes, sizes.begin() + moments / 100 * 99);
  return sizes[moments / 100 * 99];
}

/// A drag that wears off where the hand has been, against one that stays, of any size up to that of the new one.
Pair worn(Chance& chance) {
  const double size = rounded(chance.octaves(6, 12), 3), share = rounded(chance.between(0.7, 0.95), 2);
  const double way = rounded(chance.between(0.08, 0.3), 2);
  const std::string state =
      fmt::format("state worn = 0 in 0 .. 1; next worn = min(1, worn + length(velocity) * dt / {})", millimetres(way));
  const bool dry = chance.happens(0.5);
  const std::string law = dry ? fmt::format("hold(-300 N s/m * velocity, {} N)", number(0.2 * size))
                              : fmt::format("viscous({} N s/m)", number(size));
  const double even = rounded(size * chance.between(0.5, 1), 3);
  return {fmt::format("{}; force drag = {} * (1 - {} * worn)", state, law, number(share)),
          dry ? fmt::format("force drag = hold(-300 N s/m * velocity, {} N)", number(0.2 * even))
              : fmt::format("force drag = viscous({} N s/m)", number(even))};
}

/// A swing that dies away, against a steady one with the same 99th percentile.
Pair died(Chance& chance) {
  const double size = rounded(chance.octaves(0.5, 2), 3), lasts = rounded(chance.octaves(0.4, 2.5), 3);
  const bool slow = chance.happens(0.4);
  const double rate = rounded(slow ? chance.between(3, 8) : chance.octaves(20, 200), 3);
  const double steady = size_in_8_s(
      [&](double seconds) { return size * std::exp(-seconds / lasts) * std::sin(2 * pi * rate * seconds); });
  return {fmt::format("active 20 W; force a = vector({} N * exp(-time / {} s) * sin(2 * pi * phase({} Hz)), 0 N)",
                      number(size), number(lasts), number(rate)),
          fmt::format("active 20 W; force a = vector({} N * sin(2 * pi * phase({} Hz)), 0 N)", number(steady),
                      number(rate))};
}

/// Two swings, against one at the rate of the stronger with the size of both together.
Pair summed(Chance& chance) {
  const double size = rounded(chance.octaves(0.5, 1.2), 3), other = rounded(size * chance.between(0.4, 0.8), 3);
  const bool slow = chance.happens(0.5);
  const double rate = rounded(slow ? chance.between(1.5, 3) : chance.octaves(30, 90), 3);
  const double second = rounded(rate * chance.one_of({1.45, 1.62, 2.45}), 3);
  const double both = size_in_8_s([&](double seconds) {
    return size * std::sin(2 * pi * rate * seconds) + other * std::sin(2 * pi * second * seconds);
  });
  return {fmt::format("active 20 W; force a = vector({} N * sin(2 * pi * phase({} Hz)) + {} N * sin(2 * pi * phase({} "
                      "Hz)), 0 N)",
                      number(size), number(rate), number(other), number(second)),
          fmt::format("active 20 W; force a = vector({} N * sin(2 * pi * phase({} Hz)), 0 N)", number(both),
                      number(rate))};
}

void expect_apart(const char* name, Pair (*make)(Chance&)) {
  for (std::size_t i = 0; i < pairs_of_each; ++i) {
    Chance chance(name, i);
    const auto [one, other] = make(chance);
    const auto program = [](const std::string& statements) { return compiling::compiled("    " + statements); };
    EXPECT_TRUE(told_apart(program(one), program(other))) << one << "\nagainst\n" << other;
    EXPECT_FALSE(told_apart(program(one), program(one))) << one;
  }
}

TEST(Truth, CompareSeesADragThatWearsOff) { expect_apart("worn", worn); }
TEST(Truth, CompareSeesASwingThatDiesAway) { expect_apart("died", died); }
TEST(Truth, CompareSeesEachOfSeveralSwings) { expect_apart("summed", summed); }

}  // namespace
}  // namespace wale::truth
