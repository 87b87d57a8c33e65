// Every way to die while a device pushes, through unmodified libusb: the model's force is zero within 250 frames of a
// millisecond or more. Who owns an interface is not judged here; tests/qemu does that.

#include <gtest/gtest.h>

#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <glm/geometric.hpp>
#include <random>

#include "runtime/device/driver.hpp"
#include "tests/usb/falcon_model.hpp"
#include "tests/usb/profiles.hpp"
#include "tests/usb_mock/running_wale.hpp"
#include "tests/usb_mock/usb_driver.hpp"
#include "tests/usb_mock/usb_mock.hpp"

namespace wale::test {
namespace {

/// A wall of 3 N to the right, wherever the hand is.
constexpr char pushing[] = "wale 1\n\nmaterial push {\n  physical {\n    force = vector(3 N, 0 N)\n  }\n}\n";

constexpr long most_frames = 250;

/// How a process may end, by a signal to it.
const int signals[] = {SIGHUP, SIGINT, SIGQUIT, SIGTERM, SIGALRM, SIGUSR1, SIGXCPU, SIGSEGV, SIGBUS,
                       SIGFPE, SIGILL, SIGABRT, SIGTRAP, SIGSYS,  SIGKILL, SIGSTOP, SIGTSTP};

/// How a process that felt ended by a signal.
struct End {
  int signal = 0;
  Outcome outcome;
};

class Dying : public testing::Test {
 protected:
  Dying() : connections_(Connections::open()) { mock_.waits_for_drivers = false; }

  void await_plugged() {
    await([&] { return plugged_in(connections_).size() == 1; });
  }
  std::string feel(const std::string& more = "") {
    return "feel " + folder_.write("push.wale", pushing) + " --seconds 600 " + more;
  }
  /// The keeper of that process.
  static pid_t keeper_of(pid_t owner) {
    pid_t found = 0;
    for (const auto& each : std::filesystem::directory_iterator("/proc")) {
      const std::string name = each.path().filename();
      if (name.find_first_not_of("0123456789") != std::string::npos) continue;
      if (text_of(each.path() / "comm") != "wale-keeper\n") continue;
      // Its owner's pidfd says whose it is.
      for (int descriptor = 3; descriptor < 64; ++descriptor) {
        const std::string info = text_of(each.path() / "fdinfo" / std::to_string(descriptor));
        if (info.find("Pid:\t" + std::to_string(owner) + "\n") != std::string::npos) found = std::stoi(name);
      }
    }
    return found;
  }
  /// Sends the signal between two requests to the device, and returns the frame in which it was sent. A process that
  /// was stopped within one goes on until it pushes again, and is stopped once more.
  template <class Pushes>
  long tell(const Running& feeling, int signal, Pushes pushes) {
    while (true) {
      const long began = mock_.frames();
      feeling.tell(signal);
      if (signal != SIGSTOP && signal != SIGTSTP) return began;
      await([&] {
        return text_of("/proc/" + std::to_string(feeling.process()) + "/stat").find(") T ") != std::string::npos;
      });
      for (int look = 0; look < 30; ++look) {
        std::this_thread::sleep_for(std::chrono::milliseconds(1));
        if (!MockUsbDevice::is_answering()) return began;
      }
      feeling.tell(SIGCONT);
      await(pushes);
    }
  }
  /// Frames since `began` until the device pushes nothing, and stays so for another 100.
  template <class Force>
  long frames_until_slack(Force force, long began) {
    await([&] { return force() == 0; });
    const long ended = mock_.frames();
    await([&] { return mock_.frames() > ended + 100; });
    EXPECT_EQ(force(), 0) << "and stays so";
    return ended - began;
  }

  /// Feels until the device pushes with more than `felt` N, then sends each signal at a random moment of 20 ms, and
  /// checks that the force ends in time. `check` gets each end.
  template <class Force, class Check>
  void die_of_each(Force force, double felt, Check check) {
    std::minstd_rand random(1995);
    for (const int signal : signals) {
      Running feeling(feel());
      await([&] { return force() > felt; });
      std::this_thread::sleep_for(std::chrono::milliseconds(random() % 20));
      const long began = tell(feeling, signal, [&] { return force() > felt; });
      const long frames = frames_until_slack(force, began);
      EXPECT_LE(frames, most_frames) << signal;
      RecordProperty("ms_after_signal_" + std::to_string(signal), static_cast<int>(frames));
      std::fprintf(stderr, "signal %d: %ld ms\n", signal, frames);
      if (signal == SIGSTOP || signal == SIGTSTP) {
        feeling.tell(SIGCONT);  // it is set up again from no force, and felt again
        await([&] { return force() > felt; });
        feeling.tell(SIGTERM);
      }
      check(End{signal, feeling.outcome()});
    }
  }

  UsbMock mock_;
  Connections connections_;
  TemporaryFolder folder_;
};

TEST_F(Dying, OfEachSignalAJoystickIsLetGo) {
  const auto stick = mock_.plug(PidModel(openffboard()), 1);
  await_plugged();
  const auto force = [&] { return stick->with_model([](PidModel& model) { return glm::length(model.force()); }); };
  die_of_each(force, 0.1, [&](const End& end) {
    const bool ends_by_it = end.signal != SIGINT && end.signal != SIGSTOP && end.signal != SIGTSTP;
    EXPECT_EQ(end.outcome.signal, ends_by_it ? end.signal : end.signal == SIGINT ? 0 : SIGTERM) << end.outcome.err;
    stick->close_all();
    EXPECT_EQ(stick->with_model([](PidModel& model) { return model.wrong_reports; }), 0);
  });
}

TEST_F(Dying, OfEachSignalAFalconIsLetGo) {
  setenv("WALE_FALCON_FIRMWARE", folder_.write("firmware.bin", std::string(3000, 'w')).c_str(), 1);
  FalconModel model({}, true);
  const auto falcon = mock_.plug(std::move(model), 1);
  await_plugged();
  const auto force = [&] { return falcon->with_model([](FalconModel& each) { return glm::length(each.force()); }); };
  die_of_each(force, 1, [&](const End&) { falcon->close_all(); });
}

TEST_F(Dying, WithoutItsKeeperNothingPushesUntilThereIsAnother) {
  const auto stick = mock_.plug(PidModel(openffboard()), 1);
  await_plugged();
  const auto force = [&] { return stick->with_model([](PidModel& model) { return glm::length(model.force()); }); };
  Running feeling(feel("--json"));
  await([&] { return force() > 0.1; });
  const pid_t owner = feeling.process(), keeper = keeper_of(owner);
  ASSERT_GT(keeper, 0);
  kill(keeper, SIGKILL);
  const long began = mock_.frames();
  await([&] { return force() == 0; });
  EXPECT_LE(mock_.frames() - began, most_frames);
  await([&] { return force() > 0.1; });
  const pid_t another = keeper_of(owner);
  EXPECT_GT(another, 0);
  EXPECT_NE(another, keeper);
  feeling.interrupt();
  const Outcome outcome = feeling.outcome();
  EXPECT_NE(outcome.out.find("its keeper has ended, and nothing may push without one"), std::string::npos)
      << outcome.out;
  EXPECT_EQ(keeper_of(owner), 0);
}

TEST_F(Dying, TogetherWithItsKeeperAJoystickThatHonoursDurationsIsFree) {
  const auto stick = mock_.plug(PidModel(openffboard()), 1);
  await_plugged();
  const auto force = [&] { return stick->with_model([](PidModel& model) { return glm::length(model.force()); }); };
  Running feeling(feel());
  await([&] { return force() > 0.1; });
  const pid_t keeper = keeper_of(feeling.process());
  ASSERT_GT(keeper, 0);
  const long began = mock_.frames();
  kill(keeper, SIGKILL);
  feeling.tell(SIGKILL);
  feeling.outcome();
  stick->close_all();
  const long frames = frames_until_slack(force, began);
  EXPECT_LE(frames, most_frames);
  EXPECT_TRUE(stick->with_model([](PidModel& model) { return model.effects[1].plays; })) << "nobody stopped it";
}

TEST_F(Dying, WithoutAKeeperADeviceIsNotOpened) {
  const auto stick = mock_.plug(PidModel(openffboard()), 1);
  await_plugged();
  const auto listed = plugged_in(connections_);
  const auto opened = listed.at(0).driver->open(connections_, listed[0], trusted(joystick_profile()),
                                                {.keeper = {"/nowhere/wale-keeper"}});
  ASSERT_FALSE(opened);
  EXPECT_EQ(opened.error().code, Code::no_keeper);
  EXPECT_EQ(stick->with_model([](PidModel& model) { return model.force(); }), glm::dvec2(0));
}

}  // namespace
}  // namespace wale::test
