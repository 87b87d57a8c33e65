// The stimuli of the thesis's three experiments: their numbers, names and forces.
#include <cmath>
#include <set>

#include "tests/sandpaper/reading.hpp"

namespace wale::sandpaper::collections_test {
namespace {

constexpr double pu = 10.0 / 512;

/// The largest force along the patch's middle line, in N.
double largest_force(const Program& program) {
  Bank bank(program);
  double largest = 0;
  for (int i = -7000; i <= 7000; ++i) {
    Hand hand;
    hand.position = {static_cast<float>(i * 5e-6), 0};
    largest = std::max(largest, std::abs(static_cast<double>(tick(bank, hand).x)));
  }
  return largest;
}

/// The period, in m: the mean distance between places, from the centre to the right, where the force along x changes
/// from negative to positive.
double period_of(const Program& program) {
  Bank bank(program);
  double first = 0, last = 0, before = 0;
  int turns = 0;
  for (int i = 1; i < 7000; ++i) {
    Hand hand;
    hand.position = {static_cast<float>((i + 0.5) * 5e-6), 0};
    const double force = tick(bank, hand).x;
    if (before < 0 && force >= 0) {
      (turns == 0 ? first : last) = hand.position.x;
      ++turns;
    }
    before = force;
  }
  return (last - first) / (turns - 1);
}

TEST(Collections, HaveTheirNumbersOfDifferentStimuliAndAllCompile) {
  for (const auto& [file, count] : {std::pair{"chapter4.wale", 102}, {"chapter5.wale", 30}, {"chapter6.wale", 12}}) {
    Module module(file);
    const auto names = module.names();
    EXPECT_EQ(names.size(), static_cast<std::size_t>(count)) << file;
    EXPECT_EQ(std::set<std::string>(names.begin(), names.end()).size(), names.size()) << file;
    std::set<std::vector<std::byte>> programs;
    for (const auto& name : names) programs.insert(write_patch_program(module.program(name).description()));
    EXPECT_EQ(programs.size(), names.size()) << file;
  }
}

TEST(Collections, AppendixAHasEveryTextureOfChapterFour) {
  const auto chapter = Module("chapter4.wale").names(), appendix = Module("appendix_a.wale").names();
  int textures = 0, levels = 0;
  for (const auto& name : chapter) {
    const bool texture = name.starts_with("bars") || name.starts_with("grid") || name.starts_with("perlin");
    const bool at_level = name.ends_with("Fless") || name.ends_with("Fmore") || name.ends_with("Fmost");
    levels += at_level;
    if (!texture || at_level) continue;
    ++textures;
    EXPECT_EQ(std::ranges::count(appendix, name), 1) << name;
  }
  EXPECT_EQ(levels, 16 * 3);  // sixteen textures at four levels, one of which has no suffix
  EXPECT_EQ(textures, 102 - 10 - 48);
}

TEST(Collections, ChapterFiveHasTheForcesOfTableSix) {
  // Program units in the order of the scan's columns, Minsky 1995, table 6.
  const std::multiset<int> table{9,  17, 41,  16, 42, 36,  42, 44,  21,  50, 51, 64, 14,  24,  35,
                                 85, 97, 159, 21, 52, 172, 90, 105, 109, 20, 26, 71, 120, 137, 194};
  Module module("chapter5.wale");
  std::multiset<int> found;
  for (const auto& name : module.names()) {
    const int tenths = std::stoi(name.substr(1)), force = std::stoi(name.substr(name.find('f') + 1));
    found.insert(force);
    const Program program = module.program(name);
    EXPECT_NEAR(largest_force(program), force * pu, 0.005 * force * pu) << name;
    EXPECT_NEAR(period_of(program), tenths * 1e-4, 0.003 * tenths * 1e-4) << name;
  }
  EXPECT_EQ(found, table);
}

TEST(Collections, ChapterSixHasTheCommandsOfTableEight) {
  // Name, command in joystick units (2048 to 10 N), spatial period in mm.
  const std::tuple<const char*, int, double> table[]{{"a1p7", 40, 0.7},    {"a3p7", 120, 0.7},   {"a3p12", 120, 1.2},
                                                     {"a3p25", 120, 2.5},  {"a3p50", 120, 5.0},  {"a3p100", 120, 10},
                                                     {"a10p7", 400, 0.7},  {"a10p12", 400, 1.2}, {"a10p25", 400, 2.5},
                                                     {"a10p50", 400, 5.0}, {"a10p100", 400, 10}, {"a19p100", 760, 10}};
  Module module("chapter6.wale");
  for (const auto& [name, command, period] : table) {
    const Program program = module.program(name);
    EXPECT_NEAR(largest_force(program), command * 10.0 / 2048, 0.005 * command * 10 / 2048) << name;
    EXPECT_NEAR(period_of(program), period * 1e-3, 0.003e-3 * period) << name;
    EXPECT_FLOAT_EQ(program.default_size().width, 0.08f) << name;
  }
}

TEST(Collections, RandomParametersStayWithinTheDevicesForce) {
  for (const char* file : {"prototypes.wale", "triangle_wave.wale", "textbook.wale", "dynamics.wale", "jitter.wale",
                           "fractal.wale", "textures_version1.wale", "textures_version2.wale"}) {
    Module module(file);
    std::mt19937 random(8);
    for (const auto& name : module.names()) {
      const Program program = module.program(name);
      for (int i = 0; i < 40; ++i) {
        Bank bank = bank_with(program, random_parameters(program, random));
        Memory memory(program);
        Hand hand;
        memory.enter(bank, hand);
        for (int t = 0; t < 300; ++t) {
          hand.position = {0.03 * std::sin(0.01 * t), 0.03 * std::cos(0.013 * t)};
          hand.time = t / 900.0;
          const Force force = tick(bank, memory, hand);
          ASSERT_LE(std::abs(force.x), 10) << name;
          ASSERT_LE(std::abs(force.y), 10) << name;
        }
        EXPECT_EQ(memory.restored(), 0) << name << ": a state was not a number";
      }
    }
  }
}

}  // namespace
}  // namespace wale::sandpaper::collections_test
