// Files with random changes and a matching checksum. Each file that the loader accepts runs and stays within its
// limits.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "runtime/machine/floating_point_mode.hpp"
#include "tests/machine/random_program.hpp"
#include "tests/machine/running.hpp"
#include "tests/schema/wpp_bytes.hpp"
#include "wale/memory.hpp"
#include "wale/picture.hpp"

namespace wale::mangled_programs_test {
namespace {

PatchProgram small_example() {
  PatchProgram p = example::program();
  p.peaks[0].points = 64;
  return p;
}

/// Makes one random change, as damage or malice might.
void mangle(wpp::Bytes& bytes, std::mt19937& random) {
  const std::size_t at = 32 + random() % (bytes.size() - 32);
  switch (random() % 5) {
    case 0: bytes[at] = static_cast<std::byte>(random()); break;
    case 1: bytes[at] ^= std::byte{1} << random() % 8; break;
    case 2: bytes[at] = static_cast<std::byte>(std::to_integer<int>(bytes[at]) + 1); break;
    case 3:
      for (std::size_t i = at; i < std::min(at + 4, bytes.size()); ++i)
        bytes[i] = static_cast<std::byte>(random() % 2 * 255);
      break;
    default: std::copy_n(bytes.begin() + 400 + random() % 100, 8, bytes.begin() + at - at % 8); break;
  }
}

/// Peaks of many points are valid, but too slow to run here.
bool is_quick(const PatchProgram& program) {
  return std::all_of(program.peaks.begin(), program.peaks.end(), [](const Peak& p) { return p.points <= 10000; });
}

/// Runs every section.
void exercise(const Program& program) {
  Bank bank(program);
  const DeviceProfile& device = program.description().device;
  const double most = device.most(), most_y = device.shaker ? device.shaker->frequency_high : most;
  for (const Hand& hand : {Hand{}, Hand{{0.01f, -0.02f}, {0.1f, 0}}, Hand{{1e30f, -0.1f}, {0, -1e30f}}}) {
    const Force force = tick(bank, hand);
    ASSERT_LE(std::abs(force.x), most);
    ASSERT_LE(std::abs(force.y), most_y);
    Force same;
    tick_all(bank, {&hand, 1}, {&same, 1});
    ASSERT_EQ(force, same);
  }
  Memory memory(program);
  memory.enter(bank, {});
  for (int i = 0; i < 5; ++i) {
    const auto at = static_cast<float>(i);
    const Force force = tick(bank, memory, {.position = {0.01f * at, -0.3f}, .raw_velocity = {at, -at}, .time = at});
    ASSERT_LE(std::abs(force.x), most);
    ASSERT_LE(std::abs(force.y), most_y);
  }
  const FloatingPointMode mode;  // a subnormal end of a range compares as 0 in it
  for (std::size_t i = 0; i < memory.states().size(); ++i) {
    const State& state = program.description().states[i];
    ASSERT_TRUE(memory.states()[i] >= state.low && memory.states()[i] <= state.high);
  }
  for (std::size_t i = 0; i < program.description().grids.size(); ++i) {
    const Grid& grid = program.description().grids[i];
    for (const float cell : memory.grid(i)) ASSERT_TRUE(cell >= grid.low && cell <= grid.high);
  }
  float relief = 0;
  glm::vec3 colour;
  const glm::vec2 position(0.01f, 0.02f);
  relief_all(bank, {&position, 1}, {&relief, 1});
  surface_all(bank, &memory, {&position, 1}, {&relief, 1}, {&colour, 1});
  ASSERT_EQ(show(bank, memory, {}).size(), program.description().picture.marks.size());
  for (std::size_t i = 0; i < program.description().percepts.size(); ++i) predict(bank, i, 1.0f);
}

TEST(MangledPrograms, NeverCrashAndNeverPushTooHard) {
  std::mt19937 random(20);
  std::vector<wpp::Bytes> originals = {write_patch_program(small_example()), write_patch_program(example::least()),
                                       write_patch_program(example::pad()),
                                       write_patch_program(example::pad(PositionSource::none))};
  for (unsigned seed = 0; seed < 6; ++seed)
    originals.push_back(write_patch_program(example::RandomProgram(seed).make()));
  int loaded = 0, refused = 0;
  for (int round = 0; round < 40000; ++round) {
    wpp::Bytes bytes = originals[random() % originals.size()];
    for (unsigned changes = 1 + random() % 3; changes > 0; --changes) mangle(bytes, random);
    auto result = Program::load(wpp::sealed(bytes));
    if (!result) {
      ++refused;
      ASSERT_FALSE(result.error().sentence.empty());
      continue;
    }
    ++loaded;
    const auto& program = *result;
    if (is_quick(program.description())) exercise(program);
  }
  EXPECT_GT(loaded, 100);
  EXPECT_GT(refused, 1000);
}

}  // namespace
}  // namespace wale::mangled_programs_test
