// Measures the work beside the real-time loop: how soon changes are felt. For tests/benchmarks/control.
//
//   bench_control start               1000 patches of two materials by turns: from the call until the first tick
//   bench_control move                a move, while banks are being prepared all the time: until it is felt
//   bench_control set PROGRAM...      a parameter of the touched patch, for each program (.wpp): until it is felt
//   bench_control stream SECONDS      10 000 patches that come and go: memory, numbers, the cost of one change

#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <deque>
#include <fstream>
#include <iterator>
#include <string>
#include <thread>
#include <vector>

#include "tests/benchmarks/measure.hpp"
#include "tests/runtime/figures.hpp"
#include "tests/runtime/programs.hpp"
#include "wale/loop.hpp"
#include "wale/stage.hpp"

namespace wale::benchmarks {
namespace {

[[noreturn]] void fail(const std::string& why) {
  std::fprintf(stderr, "wale: %s\n", why.c_str());
  std::exit(1);
}

template <class Value>
Value good(Result<Value> result) {
  if (!result) fail(in_words(result.error()));
  return *std::move(result);
}

double since(double start) { return (now() - start) * 1e-6; }  // ms

/// A handle at rest that notes when its first tick was and when its force changed last.
class Noting : public Device {
 public:
  explicit Noting(DeviceProfile profile) : profile_(std::move(profile)) {}
  const DeviceProfile& profile() const noexcept override { return profile_; }
  void elapse(long) noexcept override {}
  Reading sample() noexcept override {
    if (first == 0) first = now();
    return {};
  }
  Force command(Force force) noexcept override {
    if (force.x != last_) {
      last_ = force.x;
      changed = now();
    }
    return force;
  }

  std::atomic<double> first = 0, changed = 0;

 private:
  DeviceProfile profile_;
  float last_ = 0;
};

/// So that a force changes at once.
DeviceProfile without_slew() {
  DeviceProfile profile = sandpaper();
  profile.slew = 1e9, profile.mass = 0;
  return profile;
}

void start() {
  std::vector<double> times;
  const std::vector<Program> two{corduroy(1.934f), bead(200)};
  for (int turn = 0; turn < 11; ++turn) {
    Noting device(sandpaper());
    Stage stage(device);
    const double begun = now();
    for (std::size_t i = 0; i < 1000; ++i)
      (void)good(stage.add(two[i % 2], {.at = {0.0001f * static_cast<float>(i), 0}}));
    if (auto started = stage.start(); !started) fail(in_words(started.error()));
    while (device.first == 0) std::this_thread::sleep_for(std::chrono::microseconds(100));
    times.push_back((device.first - begun) * 1e-6);
  }
  std::printf("1000 patches of two materials, until the first tick: %.1f ms in the median, %.1f ms at most (bar 50)\n",
              median(times), *std::ranges::max_element(times));
}

void move() {
  Noting device(without_slew());
  Stage stage(device, {.priority = usual_priority});
  Patch touched = good(stage.add(push(1)));
  std::vector<Patch> others;
  const Program prepared = corduroy(1.934f);
  for (std::size_t i = 0; i < 1000; ++i)
    others.push_back(good(stage.add(prepared, {.at = {0.03f, 0}, .size = PatchSize{.width = 0.01f, .height = 0.01f}})));
  if (auto started = stage.start(); !started) fail(in_words(started.error()));
  std::atomic<bool> done = false;
  std::thread changing([&] {
    for (long n = 0; !done; ++n) {
      (void)others[static_cast<std::size_t>(n) % 1000].set("wale", 0.001f + 1e-6f * static_cast<float>(n % 3001));
      if (n % 20 == 0) std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
  });
  std::vector<double> periods;
  std::this_thread::sleep_for(std::chrono::milliseconds(300));
  for (int n = 0; n < 300; ++n) {
    const double told = now();
    if (auto moved = touched.move({n % 2 == 0 ? 0.2f : 0, 0}); !moved) fail(in_words(moved.error()));
    while (device.changed < told && since(told) < 5000) std::this_thread::sleep_for(std::chrono::microseconds(50));
    if (device.changed < told) fail("a move was not felt");
    periods.push_back((device.changed - told) * 1e-9 * sandpaper().rate);
    std::this_thread::sleep_for(std::chrono::milliseconds(7));
  }
  done = true;
  changing.join();
  const auto run = stage.stop();
  std::ranges::sort(periods);
  std::printf(
      "a move beside the preparation of banks, until it is felt: %.1f periods in the median, %.1f for 99 %%, "
      "%.1f at most (bar: the first tick after 2); %ld ticks missed, %s\n",
      periods[150], periods[296], periods.back(), run ? run->ticks_missed : 0, run ? run->scheduling.c_str() : "");
}

Program program_of(const char* path) {
  std::ifstream file(path, std::ios::binary);
  const std::string text{std::istreambuf_iterator<char>(file), {}};
  return good(Program::load(std::as_bytes(std::span(text))));
}

/// ms until a change of each parameter is felt; steps a loop as often as it can.
std::vector<double> times_of(const Program& program) {
  std::vector<double> times;
  Stage stage(program.description().device);
  Patch patch = good(stage.add(program));
  Loop loop = good(Loop::begin(stage));
  const auto step_until = [&](long revision) {
    const double begun = now();
    while (stage.now().revision < revision) {
      (void)loop.step({});
      if (since(begun) > 5000) fail(program.description().material + ": a change was not felt");
      std::this_thread::sleep_for(std::chrono::microseconds(50));
    }
  };
  step_until(1);
  const auto& parameters = program.description().parameters;
  for (std::size_t n = 0; n < 3 * parameters.size(); ++n) {
    const Parameter& one = parameters[n % parameters.size()];
    const float share = 0.2137f + 0.0511f * static_cast<float>(n / parameters.size());
    if (!(one.high > one.low) || !std::isfinite(one.high - one.low)) continue;
    // Bounds that are tightened later are revisions too: none is under way when it has been quiet for a while.
    for (long quiet = 0, last = stage.now().revision; quiet < 20; ++quiet) {
      std::this_thread::sleep_for(std::chrono::milliseconds(2));
      (void)loop.step({});
      if (const long newer = stage.now().revision; newer != last) last = newer, quiet = 0;
    }
    const double told = now();
    const long before = stage.now().revision;
    if (auto set = patch.set(one.name, one.low + share * (one.high - one.low)); !set) continue;
    step_until(before + 1);
    times.push_back(since(told));
  }
  return times;
}

void set(int count, char** paths) {
  std::vector<double> all;
  double slowest = 0;
  const char* of = "";
  for (int i = 0; i < count; ++i) {
    const Program program = program_of(paths[i]);
    if (program.description().parameters.empty()) continue;
    const std::vector<double> times = times_of(program);
    if (times.empty()) continue;
    all.push_back(median(times));
    if (all.back() > slowest) slowest = all.back(), of = paths[i];
  }
  if (all.empty()) fail("no program has a parameter");
  std::printf(
      "a parameter of the touched patch, until it is felt: %.2f ms in the median of %zu programs (bar 5), "
      "%.2f ms for the slowest (bar 20), %s\n",
      median(all), all.size(), slowest, of);
}

/// The memory in use by this process, in bytes.
long resident() {
  std::ifstream file("/proc/self/statm");
  long all = 0, used = 0;
  file >> all >> used;
  return used * sysconf(_SC_PAGESIZE);
}

void stream(double seconds) {
  constexpr std::size_t there_at_once = 10000;
  Noting device(sandpaper());
  Stage stage(device, {.priority = usual_priority});
  const std::vector<Program> two{corduroy(1.934f), bead(200)};
  std::deque<Patch> patches;
  std::size_t come = 0;
  std::uint32_t greatest = 0;
  const auto add = [&] {
    const auto n = static_cast<float>(come % 9973);
    patches.push_back(good(stage.add(
        two[come % 2], {.at = {0.00002f * n - 0.1f, 0.1f * std::sin(n)}, .size = PatchSize{0.002f, 0.002f, 0.0005f}})));
    greatest = std::max(greatest, patches.back().number());
    ++come;
  };
  while (patches.size() < there_at_once) add();
  if (auto started = stage.start(); !started) fail(in_words(started.error()));
  std::vector<double> calls;
  long before = 0, after = 0;
  const double begun = now();
  while (since(begun) < 1000 * seconds) {
    const double told = now();
    add();
    if (auto removed = patches.front().remove(); !removed) fail(in_words(removed.error()));
    calls.push_back((now() - told) * 1e-3);
    if (calls.size() == 100000) calls.erase(calls.begin(), calls.begin() + 50000);
    patches.pop_front();
    std::this_thread::sleep_for(std::chrono::microseconds(500));
    if (before == 0 && since(begun) > 300 * seconds) before = resident();
    after = resident();
  }
  const auto run = stage.stop();
  std::ranges::sort(calls);
  std::printf(
      "%zu patches came and went among 10 000: adding one and removing one %.0f us in the median, %.0f us for "
      "99 %%; greatest number %u; memory %.1f MB, then %.1f MB; %ld ticks run, %ld missed\n",
      come - there_at_once, calls[calls.size() / 2], calls[calls.size() * 99 / 100], greatest,
      static_cast<double>(before) * 1e-6, static_cast<double>(after) * 1e-6, run ? run->ticks_run : 0,
      run ? run->ticks_missed : 0);
  if (greatest > 2 * there_at_once) fail("numbers of removed patches were not used again");
  if (after - before > 2 << 20) fail("memory grew");
}

}  // namespace
}  // namespace wale::benchmarks

int main(int count, char** words) {
  using namespace wale::benchmarks;
  const std::string what = count > 1 ? words[1] : "";
  if (what == "start" && count == 2)
    start();
  else if (what == "move" && count == 2)
    move();
  else if (what == "set" && count > 2)
    set(count - 2, words + 2);
  else if (what == "stream" && count == 3 && std::atof(words[2]) > 0)
    stream(std::atof(words[2]));
  else
    fail("bench_control start | move | set PROGRAM... | stream SECONDS");
}
