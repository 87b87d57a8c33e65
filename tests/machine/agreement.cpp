// One lane and blocks of lanes give the same bits for every program and every hand.

#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <limits>

#include "tests/machine/random_program.hpp"
#include "tests/machine/running.hpp"
#include "wale/memory.hpp"
#include "wale/picture.hpp"

namespace wale::agreement_test {
namespace {

using example::loaded;

std::uint32_t bits(float value) { return std::bit_cast<std::uint32_t>(value); }

std::vector<Hand> hands(std::mt19937& random, std::size_t count) {
  constexpr float inf = std::numeric_limits<float>::infinity();
  constexpr float extremes[] = {0.0f,  -0.0f, 1e-40f, -1e-45f, 1.2e-38f, 1e-20f,
                                0.05f, 3e38f, -3e38f, inf,     -inf,     std::numeric_limits<float>::quiet_NaN()};
  std::uniform_real_distribution<float> place(-0.1f, 0.1f), speed(-1, 1);
  std::vector<Hand> all(count);
  for (Hand& hand : all) {
    hand.time = 1e-3 * static_cast<double>(random() % 100000);
    hand.button = random() % 2 == 0;
    for (glm::vec2* pair : {&hand.position, &hand.workspace}) *pair = {place(random), place(random)};
    hand.edge = random() % 2 == 0 ? 0 : place(random);
    for (glm::vec2* pair :
         {&hand.velocity, &hand.acceleration, &hand.raw_velocity, &hand.raw_acceleration, &hand.edge_slope}) {
      *pair = {speed(random), speed(random)};
    }
    for (glm::vec2* pair : {&hand.position, &hand.velocity, &hand.acceleration, &hand.raw_velocity,
                            &hand.raw_acceleration, &hand.workspace}) {
      for (const int axis : {0, 1}) {
        if (random() % 8 == 0) (*pair)[axis] = extremes[random() % std::size(extremes)];
      }
    }
    if (random() % 8 == 0) hand.time = extremes[random() % std::size(extremes)];
  }
  return all;
}

TEST(Agreement, TickAndBlocksGiveTheSameBits) {
  std::size_t pushes = 0;
  for (unsigned seed = 0; seed < 400; ++seed) {
    example::RandomProgram generator(seed);
    const PatchProgram description = generator.make();
    ASSERT_EQ(example::refusal_of(description), "") << seed;
    Bank bank(loaded(description));
    const std::vector<Hand> all = hands(generator.random(), 1 + seed % 300);
    std::vector<Force> forces(all.size());
    tick_all(bank, all, forces);
    for (std::size_t i = 0; i < all.size(); ++i) {
      const Force one = tick(bank, all[i]);
      ASSERT_EQ(bits(one.x), bits(forces[i].x)) << "seed " << seed << ", hand " << i;
      ASSERT_EQ(bits(one.y), bits(forces[i].y)) << "seed " << seed << ", hand " << i;
      ASSERT_LE(std::abs(one.x), 5.0f);
      ASSERT_LE(std::abs(one.y), 1.0f);
      pushes += one.x != 0 && std::abs(one.x) != 5.0f;
    }
  }
  EXPECT_GT(pushes, 1000u) << "too few of the programs push without saturating";
}

// A tick without a memory equals a tick whose memory has just been made and entered.
TEST(Agreement, ATickWithoutMemoryIsOneAfterEntering) {
  for (unsigned seed = 0; seed < 100; ++seed) {
    const Program program = loaded(example::RandomProgram(seed).make());
    Bank bank(program), other(program);
    std::mt19937 random(seed);
    for (const Hand& hand : hands(random, 20)) {
      Memory memory(program);
      memory.enter(bank, hand);
      const Force remembered = tick(bank, memory, hand), forgotten = tick(other, hand);
      ASSERT_EQ(bits(remembered.x), bits(forgotten.x)) << seed;
      ASSERT_EQ(bits(remembered.y), bits(forgotten.y)) << seed;
    }
  }
}

// The picture's code in blocks against the same code in one lane, which runs it as the frame's code.
TEST(Agreement, SurfaceAndFrameGiveTheSameBits) {
  for (unsigned seed = 0; seed < 200; ++seed) {
    PatchProgram description = example::RandomProgram(seed).make();
    description.picture.frame = description.picture.code;
    description.picture.marks = {{MarkKind::line,
                                  {description.picture.relief, (*description.picture.colour)[0],
                                   (*description.picture.colour)[1], (*description.picture.colour)[2]}}};
    const Program program = loaded(description);
    Bank bank(program);
    Memory memory(program);
    std::mt19937 random(seed);
    const std::vector<Hand> all = hands(random, 140);
    memory.enter(bank, all[0]);
    for (int i = 0; i < 5; ++i) tick(bank, memory, all[i]);
    std::vector<glm::vec2> places;
    for (const Hand& hand : all) places.push_back(hand.position);
    std::vector<float> heights(all.size());
    std::vector<glm::vec3> colours(all.size());
    surface_all(bank, &memory, places, heights, colours);
    for (std::size_t i = 0; i < all.size(); ++i) {
      const auto marks = show(bank, memory, all[i]);
      ASSERT_EQ(bits(marks[0].values[0]), bits(heights[i])) << seed << " " << i;
      for (int c = 0; c < 3; ++c) {
        const float value = marks[0].values[1 + c];
        ASSERT_NEAR(colours[i][c], value > 0 ? std::min(value, 1.0f) : 0.0f, 1e-37) << seed << " " << i;
      }
    }
  }
}

TEST(Agreement, BanksAreTheSameEachTime) {
  for (unsigned seed = 0; seed < 50; ++seed) {
    const Program program = loaded(example::RandomProgram(seed).make());
    const Bank one(program), two(program);
    for (std::size_t i = 0; i < one.registers().size(); ++i) {
      ASSERT_EQ(bits(one.registers()[i]), bits(two.registers()[i])) << seed << " " << i;
    }
  }
}

TEST(Agreement, TicksDoNotDependOnTheTicksBefore) {
  const Program program = loaded(example::RandomProgram(11).make());
  std::mt19937 random(1);
  const std::vector<Hand> all = hands(random, 500);
  Bank one(program);
  std::vector<Force> forwards, backwards(all.size());
  for (const Hand& hand : all) forwards.push_back(tick(one, hand));
  for (std::size_t i = all.size(); i-- > 0;) backwards[i] = tick(one, all[i]);
  for (std::size_t i = 0; i < all.size(); ++i) ASSERT_EQ(bits(forwards[i].x), bits(backwards[i].x));
}

}  // namespace
}  // namespace wale::agreement_test
