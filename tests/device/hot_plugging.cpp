// A device that is lost and comes back, without USB: readings, commands and the wiring.
#include <gtest/gtest.h>

#include <atomic>
#include <functional>
#include <mutex>
#include <thread>
#include <vector>

#include "runtime/device/hot_plugged_device.hpp"
#include "tests/runtime/programs.hpp"
#include "wale/stage.hpp"

namespace wale::hot_plugging_test {
namespace {

using namespace std::chrono_literals;

/// The state that a test shares with its device, which the HotPluggedDevice owns.
struct Plug {
  std::atomic<bool> is_out{false};
  std::atomic<int> alive{0}, opened{0};
  std::atomic<int> x{0}, y{0};  // counts along the device's own axes
  std::mutex mutex;
  std::vector<Force> commanded;  // along its own motors
};

class Fake final : public PluggedDevice {
 public:
  explicit Fake(Plug& plug) : plug_(plug), profile_(sandpaper()) {
    ++plug_.alive;
    ++plug_.opened;
  }
  ~Fake() override { --plug_.alive; }

  const DeviceProfile& profile() const noexcept override { return profile_; }
  void elapse(long) noexcept override {}
  Reading sample() noexcept override {
    Reading reading;
    reading.counts = glm::ivec2(plug_.x.load(), plug_.y.load());
    is_lost_ = is_lost_ || plug_.is_out;
    reading.contact = is_lost_ ? Contact::lost : Contact::good;
    return reading;
  }
  Force command(Force force) noexcept override {
    const std::lock_guard lock(plug_.mutex);
    plug_.commanded.push_back(force);
    return force;
  }
  std::string reason() const override { return is_lost_ ? "it was unplugged" : ""; }
  std::vector<std::pair<std::string, long>> tally() const override { return {{"opened", 1}}; }
  std::string manner() const override { return "by a test"; }

 private:
  Plug& plug_;
  DeviceProfile profile_;
  std::atomic<bool> is_lost_{false};
};

HotPluggedDevice::Reopen reopening(Plug& plug) {
  return [&plug]() -> OpenedDevice {
    if (plug.is_out) return Error{Code::absent_device, "it is not plugged in"};
    return std::make_unique<Fake>(plug);
  };
}

template <class Condition>
void await(Condition holds) {
  while (!holds()) std::this_thread::sleep_for(1ms);
}

TEST(HotPlugging, FollowsItsWiring) {
  Plug plug;
  DeviceWiring wiring;
  wiring.axes = {{{1, -1}, {0, 1}}};    // to the right is its -y
  wiring.motors = {{{0, -1}, {1, 1}}};  // its x motor pushes to the left
  wiring.gain = {0.5, 2};
  HotPluggedDevice device(std::make_unique<Fake>(plug), wiring, reopening(plug), 1ms);
  plug.x = 30;
  plug.y = 4;
  EXPECT_EQ(device.sample().counts, glm::ivec2(-4, 30));
  EXPECT_EQ(device.command({1, 1}), Force(1, 1)) << "along the handle's axes";
  EXPECT_EQ(plug.commanded.back(), Force(-2, 0.5)) << "a motor of gain 0.5 gets twice the command";
}

TEST(HotPlugging, HasNoForceWhileLostAndIsReopenedWhenBack) {
  Plug plug;
  {
    HotPluggedDevice device(std::make_unique<Fake>(plug), {}, reopening(plug), 1ms);
    plug.x = 7;
    EXPECT_EQ(device.sample().contact, Contact::good);
    plug.is_out = true;
    const Reading lost = device.sample();
    EXPECT_EQ(lost.contact, Contact::lost);
    EXPECT_EQ(lost.counts.x, 7) << "its last place";
    const std::size_t before = plug.commanded.size();
    EXPECT_EQ(device.command({3, 3}), Force(0));
    EXPECT_EQ(plug.commanded.size(), before);
    await([&] { return plug.alive == 0; });
    for (int i = 0; i < 10; ++i) EXPECT_EQ(device.sample().contact, Contact::lost);

    plug.x = 500;
    plug.is_out = false;
    long ticks_to_settle = 0;
    await([&] {
      device.elapse(1);
      const Reading reading = device.sample();
      if (plug.opened == 2 && reading.contact == Contact::lost && reading.counts.x == 500) ++ticks_to_settle;
      return reading.contact == Contact::good;
    });
    EXPECT_GE(ticks_to_settle, static_cast<long>(sandpaper().velocity_window)) << "no velocity across the gap";
    EXPECT_EQ(device.command({1, 0}), Force(1, 0));
    const HotPlugReport report = device.report();
    EXPECT_EQ(report.losses, 1);
    EXPECT_EQ(report.returns, 1);
    EXPECT_EQ(report.reason, "it was unplugged");
    EXPECT_EQ(report.refusal, "");
    EXPECT_EQ(report.tally, (std::vector<std::pair<std::string, long>>{{"opened", 2}}))
        << "the sum over both connections";
  }
  EXPECT_EQ(plug.alive, 0);
}

TEST(HotPlugging, ComesBackAfterEachLoss) {
  Plug plug;
  HotPluggedDevice device(std::make_unique<Fake>(plug), {}, reopening(plug), 1ms);
  for (int round = 0; round < 20; ++round) {
    plug.is_out = true;
    await([&] { return device.sample().contact == Contact::lost; });
    plug.is_out = false;
    await([&] {
      device.elapse(1);
      return device.sample().contact == Contact::good;
    });
    EXPECT_EQ(plug.alive, 1);
  }
  EXPECT_EQ(device.report().losses, 20);
  EXPECT_EQ(device.report().returns, 20);
}

TEST(HotPlugging, TheReasonForStayingLostIsReported) {
  Plug plug;
  HotPluggedDevice device(std::make_unique<Fake>(plug), {}, reopening(plug), 1ms);
  plug.is_out = true;
  device.sample();
  await([&] { return device.report().refusal == "it is not plugged in"; });
  EXPECT_EQ(device.report().returns, 0);
}

TEST(HotPlugging, AStageSlewsInAfterALoss) {
  Plug plug;
  plug.x = 200;
  plug.y = 0;
  HotPluggedDevice device(std::make_unique<Fake>(plug), {}, reopening(plug), 1ms);
  Stage stage(device);
  Patch patch = *stage.add(spring(300));
  std::atomic<bool> stop{false};
  long calls = 0, back = 0;
  RunOptions options{.seconds = 600, .stop = &stop};
  options.progress = [&](const Now& now) {
    ++calls;
    if (calls == 3) plug.is_out = true;
    if (calls == 5) plug.is_out = false;
    if (calls > 5 && now.inside && ++back == 3) stop = true;
  };
  const auto ran = stage.run(options);
  ASSERT_TRUE(ran);
  const RunResult& result = *ran;
  EXPECT_GT(result.guards.lost, 0);
  const auto& ticks = result.record.ticks;
  const double step = sandpaper().slew / sandpaper().rate;
  const float full = ticks.back().force.x;  // the spring's force there
  EXPECT_LT(full, -3);
  long lost = 0;
  float before = 0;
  for (const TickRecord& tick : ticks) {
    if (!tick.inside) {
      ++lost;
      EXPECT_EQ(tick.force, Force(0));
      before = 0;
    } else if (lost > 0) {
      EXPECT_LE(std::abs(tick.force.x - before), step + 1e-4);
      before = tick.force.x;
    }
  }
  EXPECT_EQ(lost, result.guards.lost);
}

}  // namespace
}  // namespace wale::hot_plugging_test
