#include "tests/usb_mock/hid_nodes.hpp"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <signal.h>
#include <spawn.h>
#include <sys/ioctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "runtime/device/driver.hpp"
#include "runtime/device/usb/kernel_nodes.hpp"
#include "tests/usb/profiles.hpp"
#include "tests/usb_mock/usb_driver.hpp"

// A joystick through its hidraw and its event node, found by sysfs, opened by path: as a program does that knows
// nothing of the mock. tests/usb has both transports alone, and tests/qemu a real kernel.

namespace wale::test::hid_nodes {
namespace {

constexpr PidTransportKind of_nodes[] = {PidTransportKind::hidraw, PidTransportKind::evdev};

class HidNodes : public MockedUsb {
 protected:
  /// Plugs one in that tells its state, and has it bound by the kernel's driver.
  MockHidNodes& plug(const PidFamily& family, int port = 1) {
    PidModel model(family);
    model.tells_state = true;
    joystick_ = mock_.plug(std::move(model), port);
    nodes_ = std::make_unique<MockHidNodes>(mock_.testbed(), *joystick_, ++number_);
    return *nodes_;
  }
  void unplug() {
    mock_.unplug(joystick_);
    nodes_.reset();
    joystick_.reset();
  }

  Result<std::unique_ptr<HidPidDevice>> open(std::optional<PidTransportKind> transport) const {
    HidPidDevice::Options options = in_mock_time();
    options.transport = transport;
    return HidPidDevice::open(context(), found(1), trusted(joystick_profile()), options);
  }
  std::unique_ptr<HidPidDevice> opened(std::optional<PidTransportKind> transport) const {
    auto result = open(transport);
    if (!result) throw std::runtime_error(in_words(result.error()));
    return *std::move(result);
  }

  template <class Look>
  auto model(Look look) const {
    return joystick_->with_model(look);
  }
  glm::dvec2 force() const {
    return model([](PidModel& model) { return model.force(); });
  }
  std::vector<std::string> log() const {
    return model([](PidModel& model) { return model.log; });
  }
  void clear_log() const {
    model([](PidModel& model) { model.log.clear(); });
  }
  /// Effects that exist in the device.
  long blocks() const {
    return model([](PidModel& model) { return std::ranges::count_if(model.effects, &PidModel::Effect::exists); });
  }

  /// Commands until the device exerts that fraction of its full force, within a hundredth.
  void push(HidPidDevice& device, Force newton, glm::dvec2 fraction, int line = __builtin_LINE()) const {
    await(
        [&] {
          device.command(newton);
          const glm::dvec2 now = force();
          return std::abs(now.x - fraction.x) < 0.01 && std::abs(now.y - fraction.y) < 0.01;
        },
        line);
  }

  std::shared_ptr<MockJoystick> joystick_;
  std::unique_ptr<MockHidNodes> nodes_;
  int number_ = 0;
};

bool contains(const std::vector<std::string>& log, const std::string& line) {
  return std::ranges::find(log, line) != log.end();
}

/// The magnitudes that OpenFFBoard was told for a block, in order.
std::vector<int> told(const std::vector<std::string>& log, int block) {
  std::vector<int> counts;
  for (const std::string& line : log) {
    if (line.find(" 05 0" + std::to_string(block)) != 3) continue;
    const auto bytes = from_hex(line.substr(4));
    counts.push_back(static_cast<std::int16_t>(bytes[2] | bytes[3] << 8));
  }
  return counts;
}

/// Another program with the event node open, which plays half of full force along x.
class Game {
 public:
  explicit Game(const std::string& event) : node_(::open(event.c_str(), O_RDWR | O_CLOEXEC)) {
    effect_.type = FF_CONSTANT;
    effect_.id = -1;
    effect_.direction = 0x4000;
    effect_.replay.length = 0x7fff;
    effect_.u.constant.level = 0x4000;
    EXPECT_EQ(ioctl(node_, EVIOCSFF, &effect_), 0);
    input_event play{};
    play.type = EV_FF;
    play.code = static_cast<std::uint16_t>(effect_.id);
    play.value = 1;
    EXPECT_EQ(write(node_, &play, sizeof play), static_cast<ssize_t>(sizeof play));
  }
  ~Game() { close(node_); }
  Game(const Game&) = delete;
  Game& operator=(const Game&) = delete;

 private:
  int node_;
  ff_effect effect_{};
};

TEST_F(HidNodes, AreFoundAndListed) {
  const MockHidNodes& nodes = plug(openffboard());
  const KernelNodes known = kernel_nodes(found(1));
  ASSERT_EQ(known.hid.size(), 1u);
  EXPECT_EQ(known.hid[0].hidraw, nodes.hidraw());
  EXPECT_EQ(known.hid[0].pushing, std::vector<std::string>{nodes.event()});
  EXPECT_EQ(known.hid[0].report_descriptor, report_descriptor(openffboard()));
  const auto listed = plugged_in({context()});
  ASSERT_EQ(listed.size(), 1u);
  EXPECT_FALSE(listed[0].obstacle);
  EXPECT_EQ(listed[0].transport, "hidraw");
  EXPECT_EQ(joystick_->claims, 0) << "the report descriptor is read from sysfs";
  EXPECT_TRUE(log().empty());
}

TEST_F(HidNodes, AWholeLife) {
  for (const PidTransportKind transport : of_nodes) {
    SCOPED_TRACE(in_words(transport));
    plug(openffboard());
    auto device = opened(transport);
    EXPECT_EQ(device->transport(), transport);
    for (const int block : {1, 2}) {
      const auto magnitudes = told(log(), block);
      EXPECT_TRUE(std::ranges::all_of(magnitudes, [](int counts) { return counts == 0; })) << "it pushes when opened";
    }
    long tick = 0;
    await([&] {
      const float newton = static_cast<float>(std::min(++tick, 500L)) / 100;
      device->sample();
      device->command({newton, -newton});
      const glm::dvec2 now = force();  // HID's y is to the user
      return std::abs(now.x - 0.5) < 0.01 && std::abs(now.y - 0.5) < 0.01;
    });
    const auto magnitudes = told(log(), 1);
    EXPECT_TRUE(std::ranges::is_sorted(magnitudes)) << "no old force after a newer one";
    EXPECT_GT(magnitudes.size(), 10u);
    await([&] {
      device->command({2, 1});
      const glm::dvec2 position = model([](PidModel& model) { return model.position(); });
      return std::abs(device->sample().counts.x * joystick_profile().position_step() - position.x) < 0.005;
    });
    EXPECT_FALSE(device->was_lost()) << device->reason();
    device.reset();
    await([&] { return force() == glm::dvec2(0) && blocks() == 0; });
    EXPECT_EQ(model([](PidModel& model) { return model.wrong_reports; }), 0);
    EXPECT_EQ(joystick_->claims, 0) << "the kernel's driver stays";
    unplug();
  }
}

TEST_F(HidNodes, EachFamilyIsFelt) {
  for (const PidTransportKind transport : of_nodes) {
    for (const PidFamily& family : all_families()) {
      SCOPED_TRACE(family.name);
      plug(family);
      auto device = opened(transport);
      push(*device, {5, 2.5}, {0.5, -0.25});
      device.reset();
      EXPECT_EQ(model([](PidModel& model) { return model.wrong_reports; }), 0);
      unplug();
    }
  }
}

/// By hidraw too, if the game is seen in /proc, which umockdev cannot show: tests/qemu.
TEST_F(HidNodes, AGameThatOpensItFirstIsFeltBesideAndAfterwards) {
  const MockHidNodes& nodes = plug(openffboard());
  const Game game(nodes.event());
  await([&] { return std::abs(force().x - 0.5) < 0.01; });
  clear_log();
  auto device = opened(PidTransportKind::evdev);
  EXPECT_FALSE(contains(log(), "OUT 0C 08")) << "a reset would end what the game plays";
  push(*device, {0, -2}, {0.5, 0.2});
  device.reset();
  await([&] { return std::abs(force().x - 0.5) < 0.01 && std::abs(force().y) < 0.01 && blocks() == 1; });
}

TEST_F(HidNodes, AGameThatOpensItLaterIsFeltBeside) {
  for (const PidTransportKind transport : of_nodes) {
    SCOPED_TRACE(in_words(transport));
    const MockHidNodes& nodes = plug(openffboard());
    auto device = opened(transport);
    push(*device, {0, -2}, {0, 0.2});
    {
      const Game game(nodes.event());
      push(*device, {0, -2}, {0.5, 0.2});
      EXPECT_FALSE(device->was_lost()) << device->reason();
    }
    await([&] {
      device->command({0, -2});
      return blocks() == 2;
    });
    push(*device, {0, -2}, {0, 0.2});
    device.reset();
    await([&] { return blocks() == 0; });
    unplug();
  }
}

TEST_F(HidNodes, ARivalsResetIsNoticedOnHidraw) {
  const MockHidNodes& nodes = plug(openffboard());
  auto device = opened(PidTransportKind::hidraw);
  push(*device, {4, 0}, {0.4, 0});
  await([&] {
    device->command({4, 0});
    return device->counts().refreshes >= 2 || device->was_lost();
  });
  ASSERT_FALSE(device->was_lost()) << device->reason();
  const int rival = ::open(nodes.hidraw().c_str(), O_RDWR | O_CLOEXEC);
  const std::uint8_t reset[] = {0x0c, 8};
  EXPECT_EQ(write(rival, reset, sizeof reset), static_cast<ssize_t>(sizeof reset));
  close(rival);
  await([&] {
    device->command({4, 0});
    return device->was_lost();
  });
  EXPECT_EQ(force(), glm::dvec2(0));
  clear_log();
  device.reset();
  device = opened(PidTransportKind::hidraw);
  EXPECT_EQ(told(log(), 1), std::vector<int>{0}) << "set up again from zero";
  push(*device, {4, 0}, {0.4, 0});
}

/// The device has told that its actuators were enabled, and then disabled by our own reset, before anybody listens.
TEST_F(HidNodes, ReportsOfItsOwnSetUpAreNotTakenForARivals) {
  for (int life = 0; life < 10; ++life) {
    plug(openffboard());
    auto device = opened(PidTransportKind::hidraw);
    await([&] {
      device->command({4, 0});
      return device->counts().states >= 2 || device->was_lost();
    });
    ASSERT_FALSE(device->was_lost()) << device->reason();
    device.reset();
    unplug();
  }
}

/// The kernel's driver does not know of it: see evdev_transport.hpp, and tests/qemu for a real kernel.
TEST_F(HidNodes, ARivalsResetIsFeltAsNoForceOnEvdevUntilItIsOpenedAgain) {
  plug(openffboard());
  auto device = opened(PidTransportKind::evdev);
  push(*device, {4, 0}, {0.4, 0});
  model([](PidModel& model) { model.output({0x0c, 8}); });
  const long before = device->counts().refreshes;
  await([&] {
    device->command({4, 0});
    return device->counts().refreshes >= before + 4;
  });
  EXPECT_EQ(force(), glm::dvec2(0));
  EXPECT_FALSE(device->was_lost());
}

TEST_F(HidNodes, UnpluggedInTheMiddleAndPluggedInAgain) {
  for (const PidTransportKind transport : of_nodes) {
    SCOPED_TRACE(in_words(transport));
    plug(openffboard());
    auto device = opened(transport);
    push(*device, {2, 0}, {0.2, 0});
    mock_.unplug(joystick_);
    await([&] { return device->was_lost(); });
    EXPECT_EQ(device->reason(), "it was unplugged");
    EXPECT_EQ(device->sample().contact, Contact::lost);
    device.reset();
    nodes_.reset();
    plug(openffboard());
    device = opened(transport);
    push(*device, {3, 0}, {0.3, 0});
    device.reset();
    unplug();
  }
}

TEST_F(HidNodes, WithoutAHidrawNodeTheNextTransportIsTaken) {
  const MockHidNodes& nodes = plug(openffboard());
  EXPECT_EQ(opened({})->transport(), PidTransportKind::hidraw);
  gchar* root = umockdev_testbed_get_root_dir(mock_.testbed());
  std::filesystem::remove(root + nodes.hidraw());
  g_free(root);
  joystick_->is_claimed_elsewhere = true;
  const auto refused = open({});
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().sentence, "1209:ffb0: another program has claimed it");
  joystick_->is_claimed_elsewhere = false;
  EXPECT_EQ(opened({})->transport(), PidTransportKind::libusb);
  EXPECT_EQ(opened(PidTransportKind::evdev)->transport(), PidTransportKind::evdev);
}

TEST_F(HidNodes, AKilledProcessIsFeltNoLonger) {
  for (const PidTransportKind transport : of_nodes) {
    SCOPED_TRACE(in_words(transport));
    plug(openffboard());
    found(1);
    const std::string self = std::filesystem::read_symlink("/proc/self/exe");
    std::string option = "--push-until-killed", name(in_words(transport));
    pid_t child = 0;
    char* words[] = {const_cast<char*>(self.c_str()), option.data(), name.data(), nullptr};
    ASSERT_EQ(posix_spawn(&child, self.c_str(), nullptr, nullptr, words, environ), 0);
    await([&] { return force().x > 0.29; });
    kill(child, SIGKILL);
    int status = 0;
    waitpid(child, &status, 0);
    EXPECT_TRUE(WIFSIGNALED(status));
    nodes_->close_all();
    await([&] { return force() == glm::dvec2(0); });
    if (transport == PidTransportKind::hidraw) {
      EXPECT_TRUE(model([](PidModel& model) { return model.effects[1].plays; })) << "nobody stopped it";
    } else {
      await([&] { return blocks() == 0; });
    }
    unplug();
  }
}

}  // namespace
}  // namespace wale::test::hid_nodes
