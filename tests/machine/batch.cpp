// A batch of instances with states, against single ticks with one memory for each instance.

#include "wale/batch.hpp"

#include <gtest/gtest.h>

#include <bit>
#include <stdexcept>
#include <thread>

#include "tests/machine/random_program.hpp"
#include "tests/machine/running.hpp"

namespace wale::batch_test {
namespace {

using example::loaded;

std::uint32_t bits(float value) { return std::bit_cast<std::uint32_t>(value); }

void expect_same(Force one, Force other, const char* what, unsigned seed, std::size_t instance) {
  ASSERT_EQ(bits(one.x), bits(other.x)) << what << ", seed " << seed << ", instance " << instance;
  ASSERT_EQ(bits(one.y), bits(other.y)) << what << ", seed " << seed << ", instance " << instance;
}

/// A program that reads grids and writes none.
Program without_writes(unsigned seed) {
  PatchProgram description = example::RandomProgram(seed).make();
  description.writes.clear();
  return loaded(std::move(description));
}

/// Hands at random places, some of them with not-a-number or infinity.
std::vector<Hand> hands(std::mt19937& random, std::size_t count) {
  std::uniform_real_distribution<float> place(-0.1f, 0.1f), speed(-3, 3);
  std::vector<Hand> all(count);
  for (Hand& hand : all) {
    hand.position = {place(random), random() % 16 == 0 ? __builtin_nanf("") : place(random)};
    hand.velocity = {speed(random), random() % 16 == 0 ? __builtin_inff() : speed(random)};
    hand.workspace = hand.position * 1.5f;
    hand.raw_velocity = hand.velocity;
    hand.time = static_cast<double>(random() % 1000) * 0.01;
    hand.button = random() % 2 == 0;
  }
  return all;
}

TEST(Batch, RemembersBitForBitAsMemoriesDo) {
  for (unsigned seed = 0; seed < 120; ++seed) {
    const Program program = without_writes(seed);
    Bank bank(program);
    const std::size_t count = 1 + seed * 37 % 300;
    std::mt19937 random(seed);
    Batch batch(bank, count);
    ASSERT_EQ(batch.size(), count);
    std::vector<Memory> memories(count, Memory(program));
    std::vector<Force> forces(count);
    for (int tick_number = 0; tick_number < 12; ++tick_number) {
      const std::vector<Hand> now = hands(random, count);
      if (tick_number == 2 || tick_number == 7)
        batch.enter(now);  // the first two ticks are of hands that never entered
      batch.tick(now, forces);
      for (std::size_t i = 0; i < count; ++i) {
        if (tick_number == 2 || tick_number == 7) memories[i].enter(bank, now[i]);
        expect_same(tick(bank, memories[i], now[i]), forces[i], "force", seed, i);
        for (std::size_t state = 0; state < memories[i].states().size(); ++state) {
          ASSERT_EQ(bits(batch.state(state, i)), bits(memories[i].states()[state])) << seed << " " << i << " " << state;
        }
      }
    }
  }
}

TEST(Batch, ReadsTheGridsOfAMemoryAndWritesNone) {
  int differ = 0;
  for (unsigned seed = 0; seed < 60; ++seed) {
    const Program program = loaded(example::RandomProgram(seed).make());
    Bank bank(program);
    std::mt19937 random(seed);
    const std::vector<Hand> all = hands(random, 140);
    Memory written(program);
    written.enter(bank, all[0]);
    for (const Hand& hand : all) tick(bank, written, hand);
    Batch batch(bank, all.size(), &written), plain(bank, all.size());
    std::vector<Force> forces(all.size()), plain_forces(all.size());
    for (int again = 0; again < 3; ++again) {  // if anything were written, the second run would differ
      batch.enter(all);
      batch.tick(all, forces);
      for (std::size_t i = 0; i < all.size(); ++i) {
        Memory memory = written;
        memory.enter(bank, all[i]);
        expect_same(tick(bank, memory, all[i]), forces[i], "force", seed, i);
      }
    }
    plain.enter(all);
    plain.tick(all, plain_forces);
    differ += plain_forces != forces;
    // A memory of another program counts as no memory.
    const Program other = loaded(example::RandomProgram(seed + 1000).make());
    Batch unrelated(bank, all.size(), std::make_unique<Memory>(other).get());
    unrelated.enter(all);
    unrelated.tick(all, forces);
    for (std::size_t i = 0; i < all.size(); ++i) expect_same(plain_forces[i], forces[i], "unrelated", seed, i);
  }
  EXPECT_GT(differ, 5) << "too few of the programs depend on their grids";
}

/// Moves the hand by the force. At tick 0 it puts the hand at a place that depends on its number.
void push(std::size_t number, long tick, Force force, Hand& hand) {
  if (tick == 0)
    hand.position = {static_cast<float>(number % 97) * 1e-3f - 0.05f, static_cast<float>(number % 31) * 2e-3f};
  hand.velocity += force * 0.01f;
  hand.position += hand.velocity * 1e-3f;
  hand.time = static_cast<double>(tick) * 1e-3;
}

TEST(RunBatch, IsTheClosedLoopOfEachHandAlone) {
  constexpr long ticks = 20;
  for (const std::size_t count : {0u, 1u, 127u, 128u, 129u, 700u}) {
    const Program program = without_writes(static_cast<unsigned>(count) + 3);
    Bank bank(program);
    std::vector<Force> last(count);
    run_batch(bank, count, ticks,
              [&](std::size_t first, long tick, std::span<const Force> forces, std::span<Hand> all) {
                ASSERT_EQ(forces.size(), all.size());
                ASSERT_LE(first + all.size(), count);
                for (std::size_t i = 0; i < all.size(); ++i) {
                  if (tick == ticks) last[first + i] = forces[i];
                  push(first + i, tick, forces[i], all[i]);
                }
              });
    for (std::size_t i = 0; i < count; ++i) {
      Memory memory(program);
      Hand hand;
      Force force(0);
      for (long t = 0; t < ticks; ++t) {
        push(i, t, force, hand);
        if (t == 0) memory.enter(bank, hand);
        force = tick(bank, memory, hand);
      }
      expect_same(force, last[i], "last force", static_cast<unsigned>(count), i);
    }
  }
}

TEST(RunBatch, ThrowsWhatTheMoverThrows) {
  const Bank bank(without_writes(1));
  const auto stumble = [](std::size_t first, long tick, std::span<const Force>, std::span<Hand>) {
    if (first >= 256 && tick == 2) throw std::runtime_error("stumbled");
  };
  EXPECT_THROW(run_batch(bank, 500, 5, stumble), std::runtime_error);
}

// Enough hands for several threads.
TEST(TickAll, ManyHandsGiveTheSameBitsAsFew) {
  const Program program = loaded(example::RandomProgram(5).make());
  Bank bank(program);
  std::mt19937 random(5);
  const std::vector<Hand> all = hands(random, 40'000);
  std::vector<Force> forces(all.size());
  tick_all(bank, all, forces);
  for (std::size_t i = 0; i < all.size(); i += 13) expect_same(tick(bank, all[i]), forces[i], "force", 5, i);
}

// The first batch of a program decodes its blocks, and several threads may run a first batch at once.
TEST(TickAll, ThreadsThatAreFirstTogetherGetTheSameBits) {
  for (unsigned seed = 20; seed < 40; ++seed) {
    const Program program = loaded(example::RandomProgram(seed).make());
    Bank bank(program);
    std::mt19937 random(seed);
    const std::vector<Hand> all = hands(random, 200);
    std::vector<std::vector<Force>> found(4, std::vector<Force>(all.size()));
    std::vector<std::thread> threads;
    for (std::vector<Force>& forces : found) threads.emplace_back([&] { tick_all(bank, all, forces); });
    for (std::thread& thread : threads) thread.join();
    for (std::size_t i = 0; i < all.size(); ++i) {
      const Force force = tick(bank, all[i]);
      for (const std::vector<Force>& forces : found) expect_same(force, forces[i], "force", seed, i);
    }
  }
}

}  // namespace
}  // namespace wale::batch_test
