// Banks that patches share, against banks that are made anew.
#include "runtime/stage/bank_cache.hpp"

#include <gtest/gtest.h>
#include <malloc.h>

#include <cmath>
#include <limits>

#include "tests/runtime/figures.hpp"
#include "tests/runtime/programs.hpp"

namespace wale::bank_cache_test {
namespace {

constexpr PatchSize size{.width = 0.02f, .height = 0.01f, .rim = 0.001f};

BankKey key(const Program& program, float value, PatchSize how_large = size) { return {program, {value}, how_large}; }

TEST(BankCache, OneBankForTheSameProgramParametersAndSize) {
  BankCache cache;
  const Program stiff = spring(50), other = spring(50);
  const auto bank = cache.get(key(stiff, 40));
  EXPECT_EQ(cache.get(key(stiff, 40)), bank);
  EXPECT_EQ(cache.find(key(stiff, 40)), bank);
  EXPECT_EQ(cache.find(key(stiff, std::nextafter(40.0f, 41.0f))), nullptr) << "bit for bit";
  EXPECT_EQ(cache.find(key(stiff, 40, {.width = 0.02f, .height = 0.01f, .rim = 0.002f})), nullptr);
  EXPECT_EQ(cache.find(key(other, 40)), nullptr) << "another program, though with the same code";
  const Bank expected(stiff, std::vector<float>{40}, size);
  EXPECT_TRUE(std::ranges::equal(bank->bank.registers(), expected.registers()));
}

TEST(BankCache, NotANumberIsAValueLikeAnyOther) {
  BankCache cache;
  const float none = std::numeric_limits<float>::quiet_NaN();
  const Program stiff = spring(50);
  EXPECT_EQ(cache.get(key(stiff, none)), cache.get(key(stiff, none)));
  EXPECT_NE(cache.get(key(stiff, 0.0f)), cache.get(key(stiff, -0.0f)));
}

TEST(BankCache, KeepsTheLastUsedOnesWithinItsBytesAndAllThatAreInUse) {
  const Program stiff = spring(50);
  const std::size_t one = PreparedBank(Bank(stiff)).bytes();
  BankCache cache(10 * one);
  const auto used = cache.get(key(stiff, 0));
  for (int i = 1; i <= 100; ++i) (void)cache.get(key(stiff, static_cast<float>(i)));
  EXPECT_LE(cache.kept_bytes(), 10 * one);
  EXPECT_LE(cache.size(), 11u);
  EXPECT_EQ(cache.find(key(stiff, 0)), used) << "in use";
  EXPECT_NE(cache.find(key(stiff, 100)), nullptr) << "used last";
  EXPECT_EQ(cache.find(key(stiff, 50)), nullptr) << "pushed out";
}

TEST(BankCache, ItsMemoryStopsGrowing) {
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
  GTEST_SKIP() << "a sanitizer's heap does not tell";
#endif
  BankCache cache(std::size_t{1} << 18);
  const Program stiff = spring(50);
  const auto fill = [&](int from, int to) {
    for (int i = from; i < to; ++i) (void)cache.get(key(stiff, static_cast<float>(i)));
    return static_cast<double>(mallinfo2().uordblks);
  };
  const double full = fill(0, 5000);
  EXPECT_NEAR(fill(5000, 10000), full, 1 << 16) << "5000 banks take some megabytes";
}

/// Of many programs, as saves of a watched file make them, only the last stay.
TEST(BankCache, KeepsTheLastProgramsWithinTheirBytes) {
  BankCache cache(BankCache::usual_bytes, std::size_t{1} << 20);
  const Program first = spring(50);
  const auto used = cache.get(key(first, 1));
  for (int i = 0; i < 200; ++i) {
    const Program program = spring(50);
    for (const float stiffness : {1.0f, 2.0f, 3.0f}) (void)cache.get(key(program, stiffness));
    EXPECT_NE(cache.find(key(program, 1)), nullptr) << "used last";
  }
  EXPECT_LT(cache.size(), 3u * 40) << "1 MB of programs that count as 32 kB each";
  EXPECT_EQ(cache.find(key(first, 1)), used) << "in use";
  BankCache small(BankCache::usual_bytes, 1);
  for (int i = 1; i <= 100; ++i) (void)small.get(key(first, static_cast<float>(i)));
  EXPECT_EQ(small.size(), 100u) << "one program is never too large";
}

TEST(BankCache, AProgramAtTheAddressOfAFreedOneIsAnother) {
  BankCache cache(1);
  for (int i = 0; i < 1000; ++i) {
    const float stiffness = static_cast<float>(i % 7);
    const Program program = spring(50, 1 + stiffness);  // often at the last one's address
    const auto bank = cache.get(key(program, 1));
    ASSERT_EQ(&bank->bank.program().decoded(), &program.decoded());
    ASSERT_FLOAT_EQ(static_cast<float>(trivial_potential_range(bank->bank)),
                    static_cast<float>((1 + stiffness) * std::hypot(0.02, 0.01)));
  }
}

TEST(BankCache, TheRangeIsTrivialUntilItIsSampled) {
  BankCache cache;
  const auto bank = cache.get(key(spring(50), 40));
  EXPECT_FALSE(bank->is_sampled());
  const double trivial = 9 * std::hypot(0.02, 0.01);
  EXPECT_NEAR(bank->potential_range(true), trivial, 1e-6);
  const std::atomic<bool> stop = true;
  EXPECT_FALSE(bank->sample(&stop));
  EXPECT_TRUE(bank->sample());
  EXPECT_EQ(bank->potential_range(true), potential_range(bank->bank));
  EXPECT_LT(bank->potential_range(true), 0.5 * trivial);
  EXPECT_NEAR(bank->potential_range(false), trivial, 1e-6);
  const auto remembering = cache.get({bead(50), {50}, size});
  EXPECT_TRUE(remembering->is_sampled()) << "with states the trivial bound is the only one";
}

}  // namespace
}  // namespace wale::bank_cache_test
