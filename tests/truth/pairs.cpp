// `compare`, on programs that differ in one known size: that size's difference, and nothing else.

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <map>

#include "tests/compiler/compiling.hpp"
#include "tests/truth/composition.hpp"
#include "tests/truth/reading_of.hpp"

namespace wale::truth {
namespace {

constexpr double most_of_others = 0.3;  // differences in a cue that is the same
constexpr double allowed = 0.1;         // of the difference that there is

/// One size of a program: the statement that has it, with {} for its number, and where it lies.
struct Size {
  const char* name;
  Cue cue;
  const char* statement;
  double low, high;  ///< in the unit of the statement
  double scale;      ///< to SI
};

const std::vector<Size>& sizes() {
  static const std::vector<Size> all{
      {"amplitude of a sine", Cue::amplitude, "force a = vector({} N * sin(2 * pi * x / 3 mm), 0 N)", 0.4, 1.5, 1},
      {"amplitude of a square", Cue::amplitude,
       "force a = vector(if fract(x / 4 mm) < 0.5 then {0} N else -{0} N, 0 N)", 0.4, 1.5, 1},
      {"period of a sine", Cue::period, "force a = vector(1 N * sin(2 * pi * x / {} mm), 0 N)", 1, 6, 1e-3},
      {"period of ridges", Cue::period,
       "force a = vector(if fract(x / {0} mm) < 0.2 then 1 N * sin(10 * pi * fract(x / {0} mm)) else 0 N, 0 N)", 1, 6,
       1e-3},
      {"period of a grating", Cue::period, "force a = lateral(grating(x, period: {} mm), amplitude: 1 N)", 12, 30,
       1e-3},
      {"stiffness", Cue::stiffness, "force a = -{} N/m * hand", 20, 60, 1},
      {"wall", Cue::wall_stiffness, "force a = vector(-{} N/m * max(0 mm, x - 20 mm), 0 N)", 300, 1200, 1},
      {"viscosity", Cue::viscosity, "force a = -{} N s/m * velocity", 1.5, 5, 1},
      {"friction", Cue::friction, "force a = hold(-150 N s/m * velocity, {} N)", 0.4, 1.2, 1},
      {"mass", Cue::mass, "force a = -{} kg * acceleration", 0.05, 0.4, 1},
      {"vibration", Cue::vibration, "active 20 W; force a = vector({} N * sin(2 * pi * 120 Hz * time), 0 N)", 0.3, 1.5,
       1},
  };
  return all;
}

/// What both have beside it.
constexpr const char* backgrounds[] = {
    "",
    "force b = vector(0 N, 0.4 N * sin(2 * pi * y / 2.1 mm))",
    "force b = -25 N/m * hand",
    "force b = -2 N s/m * velocity",
    "force b = hold(-150 N s/m * velocity, 0.3 N)",
};

/// The cues that the background has too, so that their sum is not known here.
bool background_has(std::size_t background, Cue cue) {
  switch (background) {
    case 1: return cue == Cue::amplitude || cue == Cue::period;
    case 2: return cue == Cue::stiffness || cue == Cue::wall_stiffness;
    case 3: return cue == Cue::viscosity;
    case 4: return cue == Cue::friction;
    default: return false;
  }
}

std::string pair_faults(const Size& size, const char* background, double a, double b) {
  const auto program = [&](double value) {
    return compiling::compiled(
        fmt::format("    {}\n    {}", fmt::format(fmt::runtime(size.statement), value), background));
  };
  const auto differences = differences_of(program(a), program(b));
  const auto due = difference_of(size.cue, a * size.scale, b * size.scale);
  std::string faults;
  for (std::size_t i = 0; i < cue_count; ++i) {
    const Cue cue = cue_rules()[i].cue;
    const double found = differences[i].value_or(0);
    if (cue == size.cue) {
      // Without a threshold there is nothing to say.
      if (due && std::abs(found - *due) > allowed * *due)
        faults += fmt::format("  {}: expected {:.2f} differences, found {:.2f}\n", judged_name(i), *due, found);
    } else if (!follows(cue, size.cue) && found > most_of_others) {
      faults += fmt::format("  {}: the same in both, {:.2f} differences found\n", judged_name(i), found);
    }
  }
  return faults;
}

struct PairScore {
  std::size_t right = 0, pairs = 0;
  std::string faults;
};

PairScore pair_score(const Size& size, std::size_t each) {
  PairScore score;
  for (std::size_t background = 0; background < std::size(backgrounds); ++background) {
    if (background_has(background, size.cue)) continue;
    Chance chance(size.name, background);
    for (std::size_t i = 0; i < each; ++i) {
      const double a = rounded(chance.octaves(size.low, size.high / 1.6), 3);
      const double b = rounded(a * chance.between(1.2, 1.6), 3);
      const std::string faults = pair_faults(size, backgrounds[background], a, b);
      ++score.pairs;
      if (faults.empty())
        ++score.right;
      else
        score.faults += fmt::format("{}: {} against {}, with {}\n{}", size.name, a, b, backgrounds[background], faults);
    }
  }
  return score;
}

/// How many pairs are compared rightly; no change may lower these numbers.
const std::map<std::string, std::size_t>& pair_floors() {
  static const std::map<std::string, std::size_t> table{
      {"amplitude of a sine", 4},
      {"amplitude of a square", 4},
      {"period of a sine", 4},
      {"period of ridges", 4},
      {"period of a grating", 4},
      {"stiffness", 4},
      {"wall", 4},
      {"viscosity", 4},
      {"friction", 4},
      {"mass", 5},
      {"vibration", 5},
  };
  return table;
}

TEST(Truth, PairsDifferByTheirOneSize) {
  for (const Size& size : sizes()) {
    const PairScore score = pair_score(size, 1);
    const auto floor = pair_floors().find(size.name);
    EXPECT_NE(floor, pair_floors().end()) << size.name;
    const std::size_t least = floor == pair_floors().end() ? 0 : floor->second;
    EXPECT_GE(score.right, least) << score.faults;
    if (score.right > least)
      fmt::print("{}: {} of {} pairs are right; raise the floor of {}\n", size.name, score.right, score.pairs, least);
  }
}

// Not run by ctest: WALE_TRUTH_PAIRS=4 build/tests/test_truth --gtest_filter=Truth.ReportOfPairs
TEST(Truth, ReportOfPairs) {
  const char* each = std::getenv("WALE_TRUTH_PAIRS");
  if (!each) GTEST_SKIP() << "WALE_TRUTH_PAIRS=4 compares so many pairs with each background";
  std::string table, faults;
  std::size_t right = 0, pairs = 0;
  for (const Size& size : sizes()) {
    const PairScore score = pair_score(size, std::strtoul(each, nullptr, 10));
    table += fmt::format("{:<24}{:>5} of {}\n", size.name, score.right, score.pairs);
    faults += score.faults, right += score.right, pairs += score.pairs;
  }
  fmt::print("{}\n{}pairs compared rightly: {} of {}\n", faults, table, right, pairs);
}

}  // namespace
}  // namespace wale::truth
