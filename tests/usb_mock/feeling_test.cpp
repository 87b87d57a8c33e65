// `wale feel`, `wale devices` and `wale devices --identify` with mock devices, from finding a device to releasing it.
// All other parts are the real ones. The tests assert counts, order and bytes, never durations.

#include <gtest/gtest.h>
#include <sched.h>
#include <signal.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <atomic>
#include <chrono>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <glm/geometric.hpp>
#include <iterator>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <thread>
#include <utility>

#include "runtime/device/open_device.hpp"
#include "runtime/device/shipped_devices.hpp"
#include "runtime/stage/scheduling.hpp"
#include "tests/temporary_folder.hpp"
#include "tests/usb_mock/running_wale.hpp"
#include "tests/usb_mock/usb_driver.hpp"
#include "tests/usb_mock/usb_mock.hpp"
#include "wale/library.hpp"
#include "wale/stage.hpp"

namespace wale::test {
namespace {

using namespace std::chrono_literals;

const std::string corduroy = std::string(WALE_SOURCE_DIR) + "/library/fabric/corduroy.wale";

std::vector<std::string> log_of(const std::shared_ptr<MockJoystick>& joystick) {
  return joystick->with_model([](PidModel& model) { return model.log; });
}

/// The counts of OpenFFBoard's Set Constant Force packets to one block, without the packets of setting up.
std::vector<int> pushes_in(const std::vector<std::string>& log, int block) {
  std::vector<int> pushes;
  for (const std::string& line : log) {
    if (line.rfind("OUT 05 0" + std::to_string(block), 0) != 0) continue;
    const auto bytes = from_hex(line.substr(4));
    pushes.push_back(static_cast<std::int16_t>(bytes[2] | bytes[3] << 8));
  }
  if (!pushes.empty()) pushes.erase(pushes.begin());
  return pushes;
}

const std::vector<std::string> set_up_of_openffboard{
    "GET 13",          "OUT 0C 08",       "OUT 0C 01",
    "OUT 0D FF",       "SET 11 01 00 00", "GET 12",
    "SET 11 01 00 00", "GET 12",          "OUT 01 01 01 C8 00 00 00 00 00 00 00 FF 00 04 28 23 00 00",
    "OUT 05 01 00 00", "OUT 0A 01 01 01", "OUT 01 02 01 C8 00 00 00 00 00 00 00 FF 00 04 50 46 00 00",
    "OUT 05 02 00 00", "OUT 0A 02 01 01"};
const std::vector<std::string> leave_of_openffboard{"OUT 05 01 00 00", "OUT 05 02 00 00", "OUT 0A 01 03 00",
                                                    "OUT 0A 02 03 00", "OUT 0C 04",       "OUT 0B 01",
                                                    "OUT 0B 02",       "OUT 0C 08",       "OUT 0C 02"};

std::vector<std::string> first(const std::vector<std::string>& log, std::size_t count) {
  return {log.begin(), log.begin() + static_cast<long>(std::min(count, log.size()))};
}
std::vector<std::string> last(const std::vector<std::string>& log, std::size_t count) {
  return {log.end() - static_cast<long>(std::min(count, log.size())), log.end()};
}

class Feeling : public testing::Test {
 protected:
  Feeling() : connections_(Connections::open()) {}

  /// The devices that are plugged in. Waits until there are this many.
  std::vector<PluggedIn> found(std::size_t count) const {
    std::vector<PluggedIn> all;
    await([&] { return (all = plugged_in(connections_)).size() == count; });
    return all;
  }
  ChosenDevice chosen(const std::string& spelling, std::size_t plugged) const {
    auto choice = choose_device({.spelling = spelling}, *shipped_devices(), *trusted_devices(), found(plugged));
    if (!choice) throw std::runtime_error(choice.error().sentence);
    return *std::move(choice);
  }
  Program built(const ChosenDevice& device) const {
    return library_.open(corduroy, {.device = device.declared->profile.name})->program;
  }
  std::unique_ptr<HotPluggedDevice> opened(const ChosenDevice& device) const {
    auto result = open_device(connections_, device, {.priority = usual_priority - 1, .keeper = {WALE_KEEPER}});
    if (!result) throw std::runtime_error(result.error().sentence);
    return *std::move(result);
  }

  UsbMock mock_;
  Connections connections_;
  Library library_;
};

TEST_F(Feeling, AutoFindsADeviceThatIsUnpluggedAndPluggedInAgain) {
  const auto stick = mock_.plug(PidModel(openffboard()), 1), other = mock_.plug(PidModel(rhino()), 2);
  const ChosenDevice device = chosen("auto", 2);
  EXPECT_EQ(device.declared->profile.name, "openffboard");
  EXPECT_EQ(device.plugged->port, "1-1");
  EXPECT_EQ(device.said,
            "using OpenFFBoard (1209:ffb0 at port 1-1) as openffboard\n"
            "  also plugged in: VPforce Rhino (ffff:2055 at port 1-2); --device 1-2");
  const Program program = built(device);
  auto joystick = opened(device);
  Stage stage(*joystick);
  Patch patch = *stage.add(program);

  std::atomic<bool> stop{false};
  std::shared_ptr<MockJoystick> again;
  long calls = 0, felt_again = 0;
  std::size_t under_way = 0;
  RunOptions options{.seconds = 120, .stop = &stop};
  options.progress = [&](const Now& now) {
    ++calls;
    if (calls == 20) {
      under_way = log_of(stick).size();
      mock_.unplug(stick);
    }
    if (calls == 24) again = mock_.plug(PidModel(openffboard()), 1);
    if (again && now.inside && ++felt_again == 20) stop = true;
  };
  const auto ran = stage.run(options);
  ASSERT_TRUE(ran) << in_words(ran.error());
  const RunResult& result = *ran;
  EXPECT_GT(result.ticks_run, 3000);
  EXPECT_GT(under_way, set_up_of_openffboard.size() + 100);

  const HotPlugReport report = joystick->report();
  EXPECT_EQ(report.losses, 1);
  EXPECT_EQ(report.returns, 1);
  EXPECT_EQ(report.reason, "it was unplugged");
  EXPECT_TRUE(report.manner.starts_with("one effect for each axis, by direction, by libusb")) << report.manner;
  EXPECT_GT(result.guards.lost, 0);

  // While the device is lost there is no force and no patch. After its return, the slew limits the first force.
  const DeviceProfile& profile = joystick->profile();
  const double step = profile.slew / profile.rate + 2 * profile.force_step();
  long lost = 0;
  bool was_lost = false;
  for (const TickRecord& tick : result.record.ticks) {
    if (!tick.inside) {
      EXPECT_EQ(tick.force, Force(0));
      ++lost;
    } else if (was_lost) {
      EXPECT_LE(glm::length(tick.force), step);
    }
    was_lost = !tick.inside;
  }
  EXPECT_EQ(lost, result.guards.lost);

  joystick.reset();
  EXPECT_EQ(first(log_of(stick), set_up_of_openffboard.size()), set_up_of_openffboard);
  const auto log = log_of(again);
  EXPECT_EQ(first(log, set_up_of_openffboard.size()), set_up_of_openffboard) << "set up again";
  EXPECT_EQ(last(log, leave_of_openffboard.size()), leave_of_openffboard) << "ended in order";
  for (const auto& one : {stick, again})
    EXPECT_EQ(one->with_model([](PidModel& model) { return model.wrong_reports; }), 0);
  EXPECT_TRUE(log_of(other).empty()) << "the other device is left alone";
  EXPECT_EQ(again->releases, again->claims);

  // The forces along x that each device got are commanded forces of ticks, in order. Some ticks are left out.
  std::size_t tick = 0;
  long told = 0;
  for (const auto& one : {stick, again})
    for (const int counts : pushes_in(log_of(one), 1)) {
      if (counts == 0) continue;
      const auto& ticks = result.record.ticks;
      const auto is_it = [&] { return std::lround(ticks[tick].force.x / profile.force_newton * 32767) == counts; };
      while (tick < ticks.size() && !is_it()) ++tick;
      ASSERT_LT(tick, ticks.size()) << "no later tick commanded this force: " << counts;
      ++told;
    }
  EXPECT_GT(told, 200);
}

TEST_F(Feeling, OneOfTwoDevicesIsUnplugged) {
  const auto left = mock_.plug(PidModel(openffboard()), 1), right = mock_.plug(PidModel(openffboard()), 2);
  const ChosenDevice on_left = chosen("1-1", 2), on_right = chosen("1-2", 2);
  EXPECT_EQ(on_right.plugged->port, "1-2");
  const Program program = built(on_left);
  auto first_joystick = opened(on_left), second_joystick = opened(on_right);
  const int claims = right->claims;
  std::atomic<bool> stop{false};
  const auto run = [&](HotPluggedDevice& device, const std::function<void(long)>& each) {
    Stage stage(device);
    Patch patch = *stage.add(program);
    long calls = 0;
    RunOptions options{.seconds = 120, .stop = &stop};
    options.progress = [&](const Now&) { each(++calls); };
    return *stage.run(options);
  };
  RunResult of_second;
  std::thread second([&] { of_second = run(*second_joystick, [](long) {}); });
  const RunResult of_first = run(*first_joystick, [&](long calls) {
    if (calls == 5) mock_.unplug(left);
    if (calls == 20) stop = true;
  });
  second.join();
  EXPECT_GT(of_first.guards.lost, 0);
  EXPECT_EQ(of_second.guards.lost, 0);
  EXPECT_EQ(first_joystick->report().losses, 1);
  EXPECT_EQ(first_joystick->report().returns, 0) << "the other device of the same kind does not replace it";
  EXPECT_EQ(first_joystick->report().refusal, "it is not plugged in");
  EXPECT_EQ(second_joystick->report().losses, 0);
  EXPECT_GT(pushes_in(log_of(right), 1).size(), pushes_in(log_of(left), 1).size());
  second_joystick.reset();
  EXPECT_EQ(last(log_of(right), leave_of_openffboard.size()), leave_of_openffboard);
  EXPECT_EQ(right->claims, claims) << "the driver does not claim it, either";
}

TEST_F(Feeling, AnUnknownStickUsesTheGenericProfileWithAWarning) {
  PidFamily family = arduino();
  family.vendor = 0x1234;
  family.product = 0x5678;
  family.name = "Stick of my own";
  const auto stick = mock_.plug(PidModel(family), 3);
  const ChosenDevice device = chosen("auto", 1);
  EXPECT_EQ(device.declared->profile.name, "usb_joystick");
  EXPECT_TRUE(device.is_generic);
  EXPECT_EQ(device.said,
            "using Stick of my own (1234:5678 at port 1-3) as usb_joystick\n"
            "  no declaration is about it, so its figures are assumed; `wale devices --identify 1-3` prints one to "
            "begin with");
  auto joystick = opened(device);
  await([&] {
    joystick->command({5, 0});
    return stick->with_model([](PidModel& model) { return model.force().x; }) > 0.2;
  });
  joystick.reset();
  EXPECT_EQ(stick->with_model([](PidModel& model) { return model.force(); }), glm::dvec2(0));
}

// Tests of the `wale` program in its own process.

TEST_F(Feeling, APersonPlugsItInAndFeelsCorduroy) {
  const auto stick = mock_.plug(PidModel(openffboard()), 1);
  found(1);
  const Outcome felt = run_wale("feel " + corduroy + " --seconds 2 --json");
  ASSERT_EQ(felt.status, 0) << felt.err;
  EXPECT_TRUE(contains(felt.err, "using OpenFFBoard (1209:ffb0 at port 1-1) as openffboard")) << felt.err;
  const auto json = nlohmann::json::parse(felt.out);
  EXPECT_EQ(json.at("device"), "OpenFFBoard (1209:ffb0 at port 1-1)");
  EXPECT_EQ(json.at("profile"), "openffboard");
  EXPECT_EQ(json.at("plugged").at("losses"), 0);
  const auto log = log_of(stick);
  EXPECT_EQ(first(log, set_up_of_openffboard.size()), set_up_of_openffboard);
  EXPECT_EQ(last(log, leave_of_openffboard.size()), leave_of_openffboard);
  EXPECT_GT(pushes_in(log, 1).size(), 50u);
  // The sender counts the packets. The session's end sends one more, and the end of the run may send another after it.
  const auto sent = json.at("plugged").at("tally").at("forces_sent_x").get<std::size_t>();
  EXPECT_LE(sent + 1, pushes_in(log, 1).size());
  EXPECT_GE(sent + 2, pushes_in(log, 1).size());
  EXPECT_EQ(stick->with_model([](PidModel& model) { return model.wrong_reports; }), 0);
  EXPECT_TRUE(contains(run_wale("feel " + corduroy + " --seconds 0.5").out, "driven       one effect for each axis"));
}

TEST_F(Feeling, ADeviceOnTheCommandLineIsTheRealOne) {
  const auto stick = mock_.plug(PidModel(openffboard()), 1), rhino_stick = mock_.plug(PidModel(rhino()), 2);
  found(2);
  const auto device_of = [](const std::string& spelling) -> std::string {
    const Outcome felt = run_wale("feel " + corduroy + " --seconds 0.2 --json --device " + spelling);
    return felt.status == 0 ? nlohmann::json::parse(felt.out).at("device").get<std::string>() : felt.err;
  };
  EXPECT_EQ(device_of("vpforce_rhino"), "VPforce Rhino (ffff:2055 at port 1-2)");
  EXPECT_EQ(device_of("ffff:2055"), "VPforce Rhino (ffff:2055 at port 1-2)");
  EXPECT_EQ(device_of("1-2"), "VPforce Rhino (ffff:2055 at port 1-2)");
  EXPECT_EQ(device_of("usb"), "OpenFFBoard (1209:ffb0 at port 1-1)");
  EXPECT_EQ(device_of("hid-pid"), "OpenFFBoard (1209:ffb0 at port 1-1)");
  const std::size_t before = log_of(stick).size() + log_of(rhino_stick).size();
  EXPECT_EQ(device_of("simulated"), "simulated");
  EXPECT_EQ(device_of("simulated:openffboard"), "simulated");
  EXPECT_EQ(device_of("sandpaper"), "simulated") << "declared, but not a device that can be plugged in";
  EXPECT_EQ(log_of(stick).size() + log_of(rhino_stick).size(), before) << "neither device got a packet";
}

TEST_F(Feeling, ADeviceOnTheCommandLineIsAwaited) {
  mock_.plug(PidModel(rhino()), 2);
  found(1);
  const std::pair<const char*, const char*> asked[] = {{"openffboard", "no openffboard is plugged in"},
                                                       {"1209:ffb0", "no device 1209:ffb0 is plugged in"},
                                                       {"1-1", "no device is plugged in at port 1-1"}};
  for (const auto& [spelling, absent] : asked) {
    Running feeling("feel " + corduroy + " --seconds 60 --json --device " + spelling);
    await([&] { return contains(feeling.said(), absent) && contains(feeling.said(), ": waiting for it; Ctrl-C"); });
    const auto stick = mock_.plug(PidModel(openffboard()), 1);
    await([&] { return pushes_in(log_of(stick), 1).size() > 50; });
    EXPECT_TRUE(contains(feeling.said(), "using OpenFFBoard (1209:ffb0 at port 1-1) as openffboard"));
    feeling.interrupt();
    const Outcome felt = feeling.outcome();
    EXPECT_EQ(felt.status, 0) << felt.err;
    EXPECT_EQ(nlohmann::json::parse(felt.out).at("device"), "OpenFFBoard (1209:ffb0 at port 1-1)");
    EXPECT_EQ(first(log_of(stick), set_up_of_openffboard.size()), set_up_of_openffboard);
    EXPECT_EQ(last(log_of(stick), leave_of_openffboard.size()), leave_of_openffboard);
    mock_.unplug(stick);
  }
}

TEST_F(Feeling, WaitingEnds) {
  const Outcome late = run_wale("feel " + corduroy + " --seconds 0.3 --device 1209:ffb0");
  EXPECT_EQ(late.status, 1);
  EXPECT_TRUE(contains(late.err, "no device 1209:ffb0 is plugged in, and none came within 0.3 s")) << late.err;

  Running ended("feel " + corduroy + " --device usb");
  await([&] { return contains(ended.said(), ": waiting for it; Ctrl-C"); });
  ended.interrupt();
  const Outcome stopped = ended.outcome();
  EXPECT_EQ(stopped.status, 1);
  EXPECT_TRUE(contains(stopped.err, "stopped while waiting for a device")) << stopped.err;

  Running refused("feel " + corduroy + " --device openffboard");
  await([&] { return contains(refused.said(), ": waiting for it; Ctrl-C"); });
  const auto taken = mock_.plug(PidModel(openffboard()), 1, true);
  const Outcome in_use = refused.outcome();
  EXPECT_EQ(in_use.status, 1);
  EXPECT_TRUE(contains(in_use.err, "cannot be used: another program has claimed it")) << in_use.err;
  EXPECT_EQ(taken->claims, 0);
}

TEST_F(Feeling, AProgramForAnotherDeviceIsRefusedWithARemedy) {
  const auto stick = mock_.plug(PidModel(openffboard()), 1);
  found(1);
  const TemporaryFolder folder;
  const std::string program = folder / "corduroy.wpp";
  ASSERT_EQ(run_wale("build " + corduroy + " --device sandpaper -o " + program).status, 0);
  const Outcome named = run_wale("feel " + program + " --seconds 0.2 --device usb");
  EXPECT_EQ(named.status, 1);
  EXPECT_TRUE(contains(named.err, "build it for that (`wale build FILE --device openffboard -o OUT.wpp`)"))
      << named.err;
  const Outcome by_itself = run_wale("feel " + program + " --seconds 0.2 --json");
  EXPECT_EQ(by_itself.status, 0);
  EXPECT_EQ(nlohmann::json::parse(by_itself.out).at("device"), "simulated");
  EXPECT_TRUE(contains(by_itself.err, "is used as openffboard, and the program is built for sandpaper"))
      << by_itself.err;
  EXPECT_TRUE(log_of(stick).empty());
}

TEST_F(Feeling, DevicesListsPluggedInDevicesAndObstacles) {
  EXPECT_TRUE(contains(run_wale("devices").out, "no device to feel on"));
  mock_.plug(PidModel(openffboard()), 1);
  PidModel plain(arduino());
  plain.descriptor = from_hex("05 01 09 04 A1 01 09 30 15 00 25 7F 75 08 95 01 81 02 C0");
  mock_.plug(std::move(plain), 2);
  mock_.plug(PidModel(rhino()), 3)->is_claimed_elsewhere = true;
  found(3);
  const auto json = nlohmann::json::parse(run_wale("devices --json").out);
  std::vector<nlohmann::json> plugged;
  for (const auto& each : json)
    if (each.contains("plugged_in")) plugged.push_back(each);
  ASSERT_EQ(plugged.size(), 3u);
  EXPECT_EQ(plugged[0].at("feel"), true);
  EXPECT_EQ(plugged[0].at("profile"), "openffboard");
  EXPECT_EQ(plugged[0].at("can"), "two axes by direction, 32767 steps of force to each side");
  EXPECT_EQ(plugged[1].at("feel"), false);
  EXPECT_EQ(plugged[1].at("obstacle"),
            "it is not a force device: nothing in its report descriptor is of usage page 0F");
  EXPECT_EQ(plugged[2].at("feel"), false);
  EXPECT_EQ(plugged[2].at("obstacle"), "another program has claimed it");
  EXPECT_TRUE(contains(run_wale("devices").out, "another program has claimed it"));
  const Outcome felt = run_wale("feel " + corduroy + " --seconds 0.2 --device 1-3");
  EXPECT_EQ(felt.status, 1);
  EXPECT_TRUE(contains(felt.err, "cannot be used: another program has claimed it")) << felt.err;
}

// What it calls itself is a stranger's text: nothing in it acts on the terminal, and it forges no line.
TEST_F(Feeling, ADevicesOwnNameIsShownAndNotObeyed) {
  PidFamily family = arduino();
  family.vendor = 0x1234;
  family.product = 0x5678;
  family.name = R"(Stick\nforged: line\033[2J\302\23331m\342\200\256\377)";  // as the mock reads it
  mock_.plug(PidModel(family), 3);
  found(1);
  const std::string shown = R"(Stick\u000aforged: line\u001b[2J\u009b31m\u202e)"
                            "\uFFFD";
  const Outcome listed = run_wale("devices"), json = run_wale("devices --json");
  EXPECT_TRUE(contains(listed.out, shown)) << listed.out;
  EXPECT_EQ(nlohmann::json::parse(json.out).back().at("name"), shown);
  const Outcome felt = run_wale("feel " + corduroy + " --seconds 0.2 --device usb");
  EXPECT_TRUE(contains(felt.err, shown)) << felt.err;
  for (const Outcome* each : {&listed, &json, &felt})
    for (const std::string& text : {each->out, each->err}) {
      EXPECT_FALSE(contains(text, "\033") || contains(text, "\u202e") || contains(text, "\nforged")) << text;
    }
}

TEST_F(Feeling, IdentifyFindsTheAxesAndLeavesNoForce) {
  const auto stick = mock_.plug(PidModel(openffboard()), 1);
  stick->with_model([](PidModel& model) { model.let_go(); });
  found(1);
  const Outcome identified = run_wale("devices --identify 1-1");
  ASSERT_EQ(identified.status, 0) << identified.err;
  EXPECT_TRUE(contains(identified.out, "  axes      x, y\n") || contains(identified.out, "  axes x, y\n"))
      << identified.out;
  EXPECT_TRUE(contains(identified.out, "motors x, y")) << identified.out;
  EXPECT_TRUE(contains(identified.out, "  gain unknown\n")) << identified.out;
  EXPECT_TRUE(contains(identified.err, "Keep your hand off the handle"));
  EXPECT_EQ(last(log_of(stick), leave_of_openffboard.size()), leave_of_openffboard);
  // At most a fifth of its force: 6554 of 32767.
  for (const int block : {1, 2})
    for (const int counts : pushes_in(log_of(stick), block)) EXPECT_LE(std::abs(counts), 6554);
  // What was printed, in the folder of a material, is somebody's: it is named, and not used.
  const TemporaryFolder folder;
  folder.write("devices.wale", identified.out);
  std::filesystem::copy_file(corduroy, folder / "corduroy.wale");
  const std::string feel = "feel " + (folder / "corduroy.wale") + " --seconds 0.2 --json";
  const Outcome others = run_wale(feel);
  EXPECT_EQ(nlohmann::json::parse(others.out).at("profile"), "openffboard");
  EXPECT_TRUE(contains(others.err, "`my_openffboard`, which the material or its project declares, is not used"))
      << others.err;
  // Where a person names the file, or keeps it as their own, the device is driven by it.
  const Outcome named = run_wale(feel + " --devices " + (folder / "devices.wale"));
  EXPECT_TRUE(contains(named.err, "at port 1-1) as my_openffboard")) << named.err;
  EXPECT_EQ(nlohmann::json::parse(named.out).at("profile"), "my_openffboard");
  const TemporaryFolder home;
  const Outcome saved = run_wale("devices --identify 1-1 --save", home / "");
  EXPECT_EQ(saved.status, 0) << saved.err;
  const Outcome own = run_wale("feel " + corduroy + " --seconds 0.2 --json", home / "");
  EXPECT_EQ(nlohmann::json::parse(own.out).at("profile"), "my_openffboard") << own.err;
  EXPECT_TRUE(contains(run_wale("devices", home / "").out, "used as my_openffboard, which ")) << "and says so";
  const Outcome twice = run_wale("devices --identify 1-1 --save", home / "");
  EXPECT_EQ(twice.status, 1);
  EXPECT_TRUE(contains(twice.err, "it declares `my_openffboard` already")) << twice.err;

  const Outcome weak = run_wale("devices --identify --max-force '1 mN'");
  EXPECT_EQ(weak.status, 1);
  EXPECT_TRUE(contains(weak.err, "nothing moved")) << weak.err;
  EXPECT_EQ(weak.out, "");
}

/// A person holds a gauge that shows 0.9 (c - 0.5 N) for a command of c; then 2 N are commanded by what gives 2 N.
TEST_F(Feeling, ACalibratedDeviceIsCommandedByWhatGivesTheForce) {
  const auto stick = mock_.plug(PidModel(openffboard()), 1);
  found(1);
  std::string typed;
  const std::vector<double> shares{0, 0.02, 0.04, 0.07, 0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8, 0.9, 1};
  const auto type = [&](double share, int round) {
    const double command = 20 * share, newton = 0.9 * std::max(0.0, command - 0.5) + (round == 1 ? 0.002 : -0.002);
    typed += "\n" + std::to_string(newton) + " N\n";
  };
  for (const double share : shares) type(share, 1);
  for (auto share = shares.rbegin(); share != shares.rend(); ++share) type(*share, 2);
  typed += "skip\nskip\nskip\nn\nyes\n";  // the other ways, the shaking; and it is written
  const TemporaryFolder home;
  const std::string input = home.write("typed", typed), file = home / "wale/devices.wale";
  const Outcome measured = run_wale("calibrate-device --device 1-1 --hold 0.03 <" + input, home / "");
  ASSERT_EQ(measured.status, 0) << measured.err;
  EXPECT_EQ(last(log_of(stick), leave_of_openffboard.size()), leave_of_openffboard);
  const std::string declaration = text_of(file);
  EXPECT_TRUE(contains(declaration, "export device my_openffboard {\n  usb \"1209:ffb0\"\n")) << declaration;
  EXPECT_TRUE(contains(declaration, "\n  gain right 0.") || contains(declaration, "\n  gain right 0.9,"))
      << declaration;
  EXPECT_TRUE(contains(declaration, "\n  dead_band right 0.")) << declaration;
  // To the left nothing was measured: there a command is the force.
  for (const auto& [force, counts] :
       {std::pair("2 N", (2 / 0.9 + 0.5) / 20 * 32767), std::pair("-2 N", -2.0 / 20 * 32767)}) {
    const std::string material = home.write(
        "push.wale", std::string("wale 1\nmaterial push { physical { force = vector(") + force + ", 0 N) } }\n");
    stick->with_model([](PidModel& model) { model.log.clear(); });
    const Outcome felt = run_wale("feel " + material + " --seconds 0.6", home / "");
    EXPECT_TRUE(contains(felt.err, "as my_openffboard")) << felt.err;
    double most = 0;
    for (const int each : pushes_in(log_of(stick), 1))
      if (std::abs(each) > std::abs(most)) most = each;
    EXPECT_NEAR(most, counts, 60) << force;
  }
}

TEST_F(Feeling, IdentifyIsEndedAtOnceByCtrlC) {
  const auto stick = mock_.plug(PidModel(openffboard()), 1);
  found(1);
  Running identifying("devices --identify");
  await([&] {
    const auto pushes = pushes_in(log_of(stick), 1);
    return !pushes.empty() && pushes.back() != 0;
  });
  identifying.interrupt();
  EXPECT_EQ(identifying.outcome().status, 1);
  EXPECT_EQ(last(log_of(stick), leave_of_openffboard.size()), leave_of_openffboard);
  EXPECT_EQ(stick->with_model([](PidModel& model) { return model.force(); }), glm::dvec2(0));
}

/// The number of this process's threads with a SCHED_FIFO priority.
int threads_with(int priority) {
  int count = 0;
  for (const auto& task : std::filesystem::directory_iterator("/proc/self/task")) {
    sched_param parameters{};
    const pid_t thread = std::stoi(task.path().filename());
    if (sched_getscheduler(thread) == SCHED_FIFO && sched_getparam(thread, &parameters) == 0 &&
        parameters.sched_priority == priority)
      ++count;
  }
  return count;
}

TEST_F(Feeling, ThreadsOfADeviceHaveAPriorityJustBelowTheLoops) {
  std::atomic<bool> is_permitted{false};
  std::thread([&] {
    sched_param parameters{};
    parameters.sched_priority = usual_priority;
    is_permitted = pthread_setschedparam(pthread_self(), SCHED_FIFO, &parameters) == 0;
  }).join();
  if (!is_permitted) GTEST_SKIP() << "SCHED_FIFO is not permitted here";
  const auto stick = mock_.plug(PidModel(openffboard()), 1);
  const ChosenDevice device = chosen("auto", 1);
  EXPECT_EQ(threads_with(usual_priority - 1), 0);
  const auto joystick = opened(device);
  EXPECT_EQ(threads_with(usual_priority - 1), 2) << "one thread for libusb's events, one that submits forces";
  mock_.unplug(stick);
  await([&] { return joystick->sample().contact == Contact::lost; });
  mock_.plug(PidModel(openffboard()), 1);
  await([&] {
    joystick->elapse(1);
    return joystick->sample().contact == Contact::good;
  });
  EXPECT_EQ(threads_with(usual_priority - 1), 2) << "the same after a second set-up";
}

}  // namespace
}  // namespace wale::test
