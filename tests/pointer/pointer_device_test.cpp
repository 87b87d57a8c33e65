#include "runtime/device/pointer/pointer_device.hpp"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <poll.h>
#include <signal.h>
#include <stdlib.h>
#include <sys/ioctl.h>
#include <sys/wait.h>
#include <termios.h>
#include <unistd.h>

#include <chrono>
#include <cmath>
#include <cstring>
#include <string>
#include <thread>

#include "tests/usb/profiles.hpp"

// The device runs on its own terminal (a pty). The test holds the other end, and reads and writes its bytes.

namespace wale::test::pointer_device {
namespace {

constexpr char taken[] = "\033[?1049h\033[2J\033[?25l\033[?1003h\033[?1006h";
constexpr char given_back[] = "\033[?1016l\033[?1006l\033[?1003l\033[?25h\033[?1049l";

DeviceProfile profile() {
  DeviceProfile profile = joystick_profile();
  profile.name = "pointer";
  profile.position_counts = 1000;
  profile.force_counts = 2048;
  profile.patch_width = profile.patch_height = 0.12;
  return profile;
}

/// A terminal of 80 by 24 cells.
class Pty {
 public:
  Pty() : master_(posix_openpt(O_RDWR | O_NOCTTY | O_CLOEXEC)) {
    grantpt(master_);
    unlockpt(master_);
    path = ptsname(master_);
    slave_ = open(path.c_str(), O_RDWR | O_NOCTTY | O_CLOEXEC);
    resize(0, 0);
    tcgetattr(slave_, &before_);
  }
  ~Pty() {
    close(slave_);
    hang_up();
  }

  void resize(unsigned short width, unsigned short height) const {
    const winsize window{24, 80, width, height};
    ioctl(master_, TIOCSWINSZ, &window);
  }
  void type(const std::string& text) const {
    ASSERT_EQ(write(master_, text.data(), text.size()), ssize_t(text.size()));
  }
  void hang_up() {
    if (master_ >= 0) close(master_);
    master_ = -1;
  }

  /// All output so far. Waits until it contains `part`.
  const std::string& screen_with(const std::string& part) {
    while (screen_.find(part) == std::string::npos) read_some(-1);
    return screen_;
  }
  const std::string& screen() {
    while (read_some(0)) {
    }
    return screen_;
  }
  bool is_as_before() const {
    termios now{};
    tcgetattr(slave_, &now);
    return now.c_lflag == before_.c_lflag && std::memcmp(now.c_cc, before_.c_cc, sizeof now.c_cc) == 0;
  }

  std::string path;

 private:
  bool read_some(int patience) {
    pollfd waited{master_, POLLIN, 0};
    if (poll(&waited, 1, patience) <= 0) return false;
    char bytes[4096];
    const ssize_t got = read(master_, bytes, sizeof bytes);
    if (got <= 0) return false;
    screen_.append(bytes, static_cast<std::size_t>(got));
    return true;
  }

  int master_, slave_ = -1;
  termios before_{};
  std::string screen_;
};

/// A pointer that has taken the terminal, as it does at its first command.
std::unique_ptr<PointerDevice> opened(const Pty& pty) {
  auto result = PointerDevice::open(profile(), {pty.path, 100});
  if (!result) {
    ADD_FAILURE() << result.error().sentence;
    return nullptr;
  }
  auto device = *std::move(result);
  EXPECT_TRUE(pty.is_as_before()) << "the terminal shows messages until the first command";
  device->command({0, 0});
  while (pty.is_as_before()) std::this_thread::sleep_for(std::chrono::milliseconds(1));
  return device;
}

template <class Condition>
void await(Condition holds) {
  while (!holds()) std::this_thread::sleep_for(std::chrono::milliseconds(1));
}

bool ends_with(const std::string& text, const std::string& end) {
  return text.size() >= end.size() && text.compare(text.size() - end.size(), end.size(), end) == 0;
}

TEST(PointerDevice, TakesTheTerminalAndGivesItBack) {
  Pty pty;
  auto device = opened(pty);
  ASSERT_NE(device, nullptr);
  EXPECT_FALSE(pty.is_as_before());
  EXPECT_EQ(pty.screen_with("\033[14t").find(std::string(taken) + "\033[?1016$p\033[14t"), 0u);
  device.reset();
  EXPECT_TRUE(ends_with(pty.screen(), given_back));
  EXPECT_TRUE(pty.is_as_before());
  auto unused = PointerDevice::open(profile(), {pty.path});
  const std::size_t so_far = pty.screen().size();
  unused = Error{Code::stopped, "let go"};
  EXPECT_EQ(pty.screen().size(), so_far) << "without a command, the device leaves the terminal alone";
}

TEST(PointerDevice, CharacterCellsMoveTheHand) {
  Pty pty;
  const auto device = opened(pty);
  EXPECT_EQ(device->sample().counts, glm::ivec2(0)) << "before the first mouse report";
  // 23 rows twice as high as wide, 46 widths are 200 mm: 5 counts are a millimetre. The middle of column 63 is 22.5
  // widths to the right, that of row 1 is 11 rows up.
  pty.type("\033[<35;63;1M");
  await([&] { return device->sample().counts != glm::ivec2(0); });
  const Reading reading = device->sample();
  EXPECT_EQ(reading.counts, glm::ivec2(std::lround(22.5 / 46 * 1000), std::lround(22.0 / 46 * 1000)));
  EXPECT_FALSE(reading.button);
  EXPECT_EQ(reading.contact, Contact::good);
  EXPECT_TRUE(std::isnan(reading.interaction.x)) << "a mouse does not measure the hand's force";
  pty.type("\033[<0;63;1M");
  await([&] { return device->sample().button; });
  EXPECT_EQ(device->manner(), "the mouse by the letter; forces are drawn, not felt");
}

TEST(PointerDevice, PixelsAreUsedIfTheTerminalReportsThem) {
  Pty pty;
  pty.resize(800, 480);
  const auto device = opened(pty);
  pty.screen_with("\033[14t");
  pty.type("\033[?1016;2$y");
  pty.screen_with("\033[?1016h");
  // Cells of 10 by 20 pixels; the workspace is 460 pixels, its middle at (400, 230).
  pty.type("\033[<35;516;116M");
  await([&] { return device->sample().counts != glm::ivec2(0); });
  EXPECT_EQ(device->sample().counts, glm::ivec2(std::lround(115.5 / 460 * 1000), std::lround(114.5 / 460 * 1000)));
  EXPECT_EQ(device->manner(), "the mouse by the pixel; forces are drawn, not felt");
}

TEST(PointerDevice, TheTerminalIsAskedForItsSizeInPixels) {
  Pty pty;
  const auto device = opened(pty);
  pty.type("\033[?1016;1$y\033[<35;516;116M\033[4;480;800t");
  pty.screen_with("\033[?1016h");
  pty.type("\033[<35;516;116M");
  await([&] { return device->sample().counts != glm::ivec2(0); });
  EXPECT_EQ(device->sample().counts, glm::ivec2(std::lround(115.5 / 460 * 1000), std::lround(114.5 / 460 * 1000)))
      << "the picture for an unknown size is gone";
}

TEST(PointerDevice, ForcesAreDrawn) {
  Pty pty;
  const auto device = opened(pty);
  EXPECT_EQ(device->command({1.5f, -2}), Force(1.5f, -2));
  pty.screen_with("1.50 N to the right, -2.00 N away: drawn, not felt");
  EXPECT_EQ(device->command({99, std::nanf("")}), Force(10, 0)) << "the profile's peak";
  pty.screen_with("10.00 N to the right, 0.00 N away");
  EXPECT_GT(device->tally()[1].second, 0);
}

TEST(PointerDevice, AClosedTerminalIsALostDevice) {
  Pty pty;
  const auto device = opened(pty);
  pty.hang_up();
  await([&] { return device->sample().contact == Contact::lost; });
  EXPECT_EQ(device->reason(), "the terminal was closed");
  EXPECT_EQ(device->command({1, 1}), Force(0));
}

TEST(PointerDevice, IsRefusedWithoutATerminal) {
  const auto none = PointerDevice::open(profile(), {"/nowhere/tty"});
  EXPECT_EQ(none.error().sentence, "there is no terminal: /nowhere/tty: No such file or directory");
  const auto file = PointerDevice::open(profile(), {"/dev/null"});
  EXPECT_EQ(file.error().sentence, "/dev/null is not a terminal");
  Pty pty;
  const auto device = opened(pty);
  const auto second = PointerDevice::open(profile(), {pty.path});
  EXPECT_EQ(second.error().sentence, "the terminal is in use already");
}

TEST(PointerDevice, AProcessThatExitsOrGivesItBackInAHandlerLeavesTheTerminalAsBefore) {
  constexpr int leaves_by_exit = 0;
  for (const int signal : {leaves_by_exit, SIGTERM, SIGSEGV}) {
    Pty pty;
    const pid_t child = fork();
    if (child == 0) {
      ::signal(signal, [](int number) {
        pointer::give_terminal_back();
        ::signal(number, SIG_DFL);
        raise(number);
      });
      const auto device = opened(pty);
      std::this_thread::sleep_for(std::chrono::milliseconds(20));  // long enough to be at any step
      if (signal == leaves_by_exit) exit(0);
      raise(signal);
      _exit(9);
    }
    int status = 0;
    waitpid(child, &status, 0);
    if (signal != leaves_by_exit) {
      EXPECT_TRUE(WIFSIGNALED(status)) << signal;
      EXPECT_EQ(WTERMSIG(status), signal) << "it dies of the signal";
    }
    EXPECT_TRUE(ends_with(pty.screen(), given_back)) << signal;
    EXPECT_TRUE(pty.is_as_before()) << signal;
  }
}

TEST(PointerDevice, HandlesNoSignalItself) {
  Pty pty;
  const auto device = opened(pty);
  for (const int signal : {SIGINT, SIGTERM, SIGHUP, SIGQUIT, SIGSEGV, SIGABRT, SIGPIPE, SIGTSTP}) {
    struct sigaction now {};
    sigaction(signal, nullptr, &now);
    EXPECT_EQ(now.sa_handler, SIG_DFL) << signal;
  }
}

TEST(PointerDevice, GivenBackItIsTakenAgainWhenTheProcessContinues) {
  Pty pty;
  const auto device = opened(pty);
  pointer::give_terminal_back();
  EXPECT_TRUE(pty.screen().find(given_back) != std::string::npos);
  EXPECT_TRUE(pty.is_as_before());
  const std::size_t so_far = pty.screen().size();
  pointer::take_terminal_again();
  await([&] { return pty.screen().find(taken, so_far) != std::string::npos; });
  EXPECT_FALSE(pty.is_as_before());
}

}  // namespace
}  // namespace wale::test::pointer_device
