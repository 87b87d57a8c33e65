#include "runtime/stage/loop.hpp"

#include <gtest/gtest.h>

#include <map>
#include <vector>

#include "runtime/stage/cost_meter.hpp"
#include "runtime/stage/time_histogram.hpp"

namespace wale::loop_test {
namespace {

constexpr auto never = []() noexcept { return false; };

/// A clock that oversleeps, in ns, at some of its wakings.
struct FakeClock {
  std::int64_t time = 5'000'000'000;
  std::map<int, std::int64_t> oversleeps;  // by the number of the waking
  std::vector<std::int64_t> deadlines = {};
  int wakings = 0;

  std::int64_t now() const { return time; }
  void sleep_until(std::int64_t when) {
    deadlines.push_back(when);
    if (when > time) time = when;
    if (const auto late = oversleeps.find(wakings++); late != oversleeps.end()) time += late->second;
  }
};

TEST(Loop, ServesEveryPeriodAtDeadlinesThatDoNotDrift) {
  FakeClock clock;
  std::vector<Beat> beats;
  EXPECT_EQ(run_loop(clock, 900, 9000, never, [&](const Beat& beat) { beats.push_back(beat); }), 0);
  ASSERT_EQ(beats.size(), 9000u);
  EXPECT_EQ(beats[0].elapsed, 0);
  for (long n = 0; n < 9000; ++n) {
    ASSERT_EQ(beats[n].period, n);
    ASSERT_EQ(beats[n].lateness, 0);
    ASSERT_EQ(beats[n].elapsed, n == 0 ? 0 : 1);
    // Deadline n is n / 900 s, rounded to ns: even 10 s after the first the error is below 1 ns.
    ASSERT_LE(std::abs((clock.deadlines[n] - clock.deadlines[0]) * 9 - n * 10'000'000), 9);
  }
}

TEST(Loop, SkipsPeriodsThatPassedAndNeverServesThemInABurst) {
  FakeClock clock{.oversleeps = {{3, 2'500'000}}};  // 2.5 periods of 1 ms late in period 3
  std::vector<Beat> beats;
  EXPECT_EQ(run_loop(clock, 1000, 10, never, [&](const Beat& beat) { beats.push_back(beat); }), 2);
  ASSERT_EQ(beats.size(), 8u);
  EXPECT_EQ(beats[2].period, 2);
  EXPECT_EQ(beats[3].period, 5);  // 3 and 4 are gone
  EXPECT_EQ(beats[3].elapsed, 3);
  EXPECT_EQ(beats[3].skipped, 2);
  EXPECT_EQ(beats[3].lateness, 2'500'000);
  EXPECT_EQ(beats[4].period, 6);
  EXPECT_EQ(beats[4].elapsed, 1);
  EXPECT_EQ(beats[4].lateness, 0) << "the next deadline has not moved";
}

TEST(Loop, LateByLessThanAPeriodSkipsNothing) {
  FakeClock clock{.oversleeps = {{0, 999'999}, {5, 500'000}}};
  std::vector<Beat> beats;
  EXPECT_EQ(run_loop(clock, 1000, 10, never, [&](const Beat& beat) { beats.push_back(beat); }), 0);
  EXPECT_EQ(beats.size(), 10u);
  EXPECT_EQ(beats[5].lateness, 500'000);
}

TEST(Loop, LateByExactlyOnePeriodSkipsOne) {
  // At 900 Hz, 4 periods are 4 444 444.4 ns and 5 are 5 555 555.6.
  for (const auto& [late, skipped] : {std::pair{1'111'111, 0}, std::pair{1'111'112, 1}}) {
    FakeClock clock{.oversleeps = {{4, late}}};
    long served = 0;
    EXPECT_EQ(run_loop(clock, 900, 10, never, [&](const Beat&) { ++served; }), skipped);
    EXPECT_EQ(served, 10 - skipped);
  }
}

TEST(Loop, AServiceThatTakesTooLongCostsTheNextPeriods) {
  FakeClock clock;
  std::vector<long> served;
  const long missed = run_loop(clock, 1000, 10, never, [&](const Beat& beat) {
    served.push_back(beat.period);
    if (beat.period == 1) clock.time += 3'200'000;
  });
  EXPECT_EQ(missed, 2);  // from 1.0 to 4.2 ms: 2 and 3 have passed, 4 is under way
  EXPECT_EQ(served, (std::vector<long>{0, 1, 4, 5, 6, 7, 8, 9}));
}

TEST(Loop, ServedAndMissedAddUpEvenWhenTheEndIsSleptThrough) {
  FakeClock clock{.oversleeps = {{7, 60'000'000'000}}};
  long served = 0;
  EXPECT_EQ(run_loop(clock, 1000, 10, never, [&](const Beat&) { ++served; }), 3);
  EXPECT_EQ(served, 7);
}

TEST(Loop, StopsWhenTold) {
  FakeClock clock;
  long served = 0;
  EXPECT_EQ(run_loop(
                clock, 900, 1000, [&] { return served == 10; }, [&](const Beat&) { ++served; }),
            0);
  EXPECT_EQ(served, 10);
}

TEST(Loop, MonotonicClockWakesAfterItsDeadline) {
  MonotonicClock clock;
  const std::int64_t when = clock.now() + 2'000'000;
  clock.sleep_until(when);
  EXPECT_GE(clock.now(), when);
}

TEST(Lateness, NothingIsNotLate) {
  const Lateness none = TimeHistogram().summary();
  EXPECT_EQ(none.p50, 0);
  EXPECT_EQ(none.p99, 0);
  EXPECT_EQ(none.maximum, 0);
}

TEST(Lateness, PercentilesAreWithinThreePercentAndTheMaximumExact) {
  for (const double scale : {1.0, 37.0, 1e4, 3.3e7}) {
    TimeHistogram histogram;
    for (int i = 1; i <= 1000; ++i) histogram.add(static_cast<std::int64_t>(i * scale));
    const Lateness late = histogram.summary();
    EXPECT_NEAR(late.p50, 500 * scale * 1e-9, 0.03 * 500 * scale * 1e-9);
    EXPECT_NEAR(late.p99, 990 * scale * 1e-9, 0.03 * 990 * scale * 1e-9);
    EXPECT_DOUBLE_EQ(late.maximum, static_cast<double>(static_cast<std::int64_t>(1000 * scale)) * 1e-9);
  }
}

TEST(Lateness, TakesAnyNumber) {
  TimeHistogram histogram;
  histogram.add(-5);
  EXPECT_EQ(histogram.summary().maximum, 0);
  histogram.add(INT64_MAX);
  EXPECT_NEAR(histogram.summary().maximum, 9.22e9, 1e7);
  EXPECT_EQ(histogram.summary().p50, 0);
  EXPECT_NEAR(histogram.summary().p99, 9.22e9, 0.03 * 9.22e9);
}

TEST(CostMeter, AWholeTickIsTheSumOfItsSteps) {
  CostMeter meter(true);
  meter.begin();
  for (std::size_t step = 0; step < TickCosts::steps; ++step) meter.end(static_cast<TickCosts::Step>(step));
  meter.end_tick();
  const auto costs = meter.summary();
  ASSERT_TRUE(costs);
  double sum = 0;
  for (const Times& step : costs->of) sum += step.maximum;
  EXPECT_NEAR(costs->whole.maximum, sum, 1e-12) << "the clock is read once between two steps";
}

TEST(CostMeter, InVirtualTimeThereIsNone) {
  CostMeter meter(false);
  meter.begin();
  meter.end(TickCosts::guard);
  meter.end_tick();
  EXPECT_FALSE(meter.summary());
}

}  // namespace
}  // namespace wale::loop_test
