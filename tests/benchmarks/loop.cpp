// Runs only the real-time loop, for tests/benchmarks/loop and tests/benchmarks/soak.
//
//   bench_loop lateness SECONDS   runs corduroy on the simulated joystick; a line for each tick: how late it began, ns
//   bench_loop soak SECONDS       changes everything all the time; fails when something is lost or memory grows

#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <string>
#include <thread>
#include <vector>

#include "tests/runtime/figures.hpp"
#include "tests/runtime/programs.hpp"
#include "wale/simulated.hpp"
#include "wale/stage.hpp"

namespace wale::benchmarks {
namespace {

using Clock = std::chrono::steady_clock;

[[noreturn]] void fail(const std::string& why) {
  std::fprintf(stderr, "wale: %s\n", why.c_str());
  std::exit(1);
}

RunResult good(Result<RunResult> run) {
  if (!run) fail(in_words(run.error()));
  return *std::move(run);
}

const StageOptions punctual{.priority = usual_priority, .lock_memory = true, .low_latency = true};

void lateness(double seconds) {
  SimulatedJoystick joystick(sandpaper(), normal_hand(), Lateral{0.04, 1});
  Stage stage(joystick, punctual);
  Patch patch = *stage.add(corduroy(1.934f));
  const RunResult run = good(stage.run({.seconds = seconds}));
  std::fprintf(stderr, "%s; %ld ticks, %ld missed\n", run.scheduling.c_str(), run.ticks_run, run.ticks_missed);
  for (const TickRecord& tick : run.record.ticks) std::printf("%.0f\n", 1e9 * static_cast<double>(tick.lateness));
}

/// The memory in use by this process, in bytes.
long resident() {
  std::ifstream file("/proc/self/statm");
  long all = 0, used = 0;
  file >> all >> used;
  return used * sysconf(_SC_PAGESIZE);
}

/// A handle at rest that records its last command.
class Shown : public Device {
 public:
  const DeviceProfile& profile() const noexcept override { return profile_; }
  void elapse(long) noexcept override {}
  Reading sample() noexcept override { return {}; }
  Force command(Force force) noexcept override {
    commanded.store(force.x, std::memory_order_relaxed);
    return force;
  }

  DeviceProfile profile_ = sandpaper();
  std::atomic<float> commanded = 0;
};

void soak(double seconds) {
  constexpr std::size_t others = 1000;
  Shown device;
  Stage stage(device, punctual);
  Patch patch = *stage.add(push(0));
  std::vector<Patch> lying;
  for (std::size_t i = 0; i < others; ++i)
    lying.push_back(*stage.add(spring(50), {.at = {0.02f + 0.00005f * static_cast<float>(i), 0.03f},
                                            .size = PatchSize{.width = 0.005f, .height = 0.005f}}));

  std::atomic<bool> done = false;                    // before the run is: what it is told last it may not get round to
  long changes = 0, swaps = 0, moves = 0, lost = 0;  // of the thread that changes, until it has joined
  Clock::duration longest{0};                        // from a change until it is felt, its
  std::thread changing([&] {
    for (long n = 1; !done; ++n) {
      const auto change = [&](const Result<>& taken) { lost += !taken; };
      if (n % 50 == 0) change(patch.replace(push(0))), ++swaps;
      if (n % 3 == 0) change(lying[static_cast<std::size_t>(n) % 20].move({0.05f, 0.04f})), ++moves;
      const float value = 0.001f * static_cast<float>(n % 997);
      change(patch.set("push", value)), ++changes;
      // A change has arrived when the handle gets the new force. No other change comes before that.
      const auto told = Clock::now();
      while (device.commanded.load(std::memory_order_relaxed) != value) {
        if (Clock::now() - told > std::chrono::minutes(1)) {
          ++lost;
          break;
        }
        std::this_thread::sleep_for(std::chrono::milliseconds(1));
      }
      longest = std::max(longest, Clock::now() - told);
      std::this_thread::sleep_for(std::chrono::milliseconds(5));
    }
  });
  // The check covers the last nine tenths. Memory for the set-up, in the first tenth, does not count.
  long before = 0, after = 0;
  const auto look = [&](const Now& now) {
    after = resident();
    if (now.time > std::max(0.9 * seconds, seconds - 60)) done = true;
    if (before == 0 && now.time > 0.1 * seconds) before = after;
  };
  const RunResult run = good(stage.run({.seconds = seconds, .progress = look}));
  done = true;
  changing.join();

  const long periods = std::lround(seconds * device.profile().rate);
  long gaps = 0;
  double next = 0;
  for (const TickRecord& tick : run.record.ticks) {
    next += tick.skipped * run.record.seconds_per_tick;
    gaps += std::abs(tick.time - next) > 0.1 * run.record.seconds_per_tick;
    next = tick.time + run.record.seconds_per_tick;
  }
  std::printf("%s\n", run.scheduling.c_str());
  std::printf("%ld ticks run, %ld missed; lateness p50 %.1f us, p99 %.1f us, maximum %.1f us\n", run.ticks_run,
              run.ticks_missed, 1e6 * run.lateness.p50, 1e6 * run.lateness.p99, 1e6 * run.lateness.maximum);
  if (run.costs)
    std::printf("a tick takes p50 %.1f us, p99 %.1f us, at most %.1f us\n", 1e6 * run.costs->whole.p50,
                1e6 * run.costs->whole.p99, 1e6 * run.costs->whole.maximum);
  std::printf("%ld changes of a parameter, %ld swaps, %ld moves: %ld lost; felt after %.0f ms at most\n", changes,
              swaps, moves, lost, 1e3 * std::chrono::duration<double>(longest).count());
  std::printf("memory %.1f MB, then %.1f MB\n", static_cast<double>(before) * 1e-6, static_cast<double>(after) * 1e-6);
  if (lost > 0) fail("changes were lost");
  if (run.ticks_run + run.ticks_missed != periods || gaps > 0) fail("ticks are missing from the record");
  if (after - before > 1 << 20) fail("memory grew");
}

}  // namespace
}  // namespace wale::benchmarks

int main(int count, char** words) {
  const std::string what = count == 3 ? words[1] : "";
  const double seconds = count == 3 ? std::atof(words[2]) : 0;
  if (seconds > 0 && what == "lateness") {
    wale::benchmarks::lateness(seconds);
  } else if (seconds > 0 && what == "soak") {
    wale::benchmarks::soak(seconds);
  } else {
    wale::benchmarks::fail("bench_loop lateness|soak SECONDS");
  }
}
