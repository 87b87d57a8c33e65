// Every way to end `wale feel` that can be caught, on the simulated device and in a terminal: the recording is whole,
// the terminal is as before, the exit status is the signal's, and one line says why. Real devices:
// tests/usb_mock/dying_test.cpp.

#include <fcntl.h>
#include <gtest/gtest.h>
#include <poll.h>
#include <signal.h>
#include <spawn.h>
#include <stdlib.h>
#include <sys/ioctl.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <termios.h>
#include <unistd.h>

#include <chrono>
#include <string>
#include <thread>
#include <vector>

#include "tests/command_line/child.hpp"

namespace wale::command_line::dying_test {
namespace {

struct Case {
  int signal;
  const char* said;
};
const Case ends[] = {{SIGHUP, "wale: ended by the signal HUP (Hangup)\n"},
                     {SIGQUIT, "wale: ended by the signal QUIT (Quit)\n"},
                     {SIGTERM, "wale: ended by the signal TERM (Terminated)\n"},
                     {SIGALRM, "wale: ended by the signal ALRM (Alarm clock)\n"},
                     {SIGUSR1, "wale: ended by the signal USR1 (User defined signal 1)\n"},
                     {SIGXCPU, "wale: ended by the signal XCPU (CPU time limit exceeded)\n"}};
const Case crashes[] = {{SIGSEGV, "wale: crashed by the signal SEGV (Segmentation fault)"},
                        {SIGBUS, "wale: crashed by the signal BUS (Bus error)"},
                        {SIGFPE, "wale: crashed by the signal FPE (Floating point exception)"},
                        {SIGILL, "wale: crashed by the signal ILL (Illegal instruction)"},
                        {SIGABRT, "wale: crashed by the signal ABRT (Aborted)"}};

/// A `wale feel` that records, once it has done so for a while.
struct Recording {
  TemporaryFolder folder;
  std::string file = folder / "a.wrec", out = folder / "out", err = folder / "err";
  Child child;

  explicit Recording(const std::vector<int>& ignored = {})
      : child({"feel", corduroy, "--device", "simulated", "--seconds", "600", "--record", file}, out, err, {},
              ignored) {
    EXPECT_TRUE(eventually([&] { return fs::exists(file) && fs::file_size(file) > 100'000; })) << bytes_of(err);
    std::this_thread::sleep_for(std::chrono::milliseconds(100));  // the file is this large before the first tick
  }
};

TEST(Dying, ASignalThatAsksForTheEndGetsAWholeRecordingAndItsOwnStatus) {
  for (const auto& [signal, said] : ends) {
    Recording feeling;
    feeling.child.tell(signal);
    const int status = feeling.child.wait();
    EXPECT_TRUE(WIFSIGNALED(status) && WTERMSIG(status) == signal) << said << status;
    EXPECT_TRUE(contains(bytes_of(feeling.err), said)) << bytes_of(feeling.err);
    EXPECT_TRUE(contains(bytes_of(feeling.out), "roughness")) << "and its report: " << bytes_of(feeling.out);
    const Outcome replayed = wale({"replay", feeling.file, "--json"});
    EXPECT_EQ(replayed.status, 0) << replayed.err;
    EXPECT_EQ(replayed.json()["complete"], true) << said;
  }
}

TEST(Dying, ACrashLeavesARecordingUpToTheLastTick) {
  for (const auto& [signal, said] : crashes) {
    Recording feeling;
    feeling.child.tell(signal);
    const int status = feeling.child.wait();
    EXPECT_TRUE(WIFSIGNALED(status) && WTERMSIG(status) == signal) << said << status;
    EXPECT_TRUE(contains(bytes_of(feeling.err), said)) << bytes_of(feeling.err);
    EXPECT_EQ(wale({"replay", feeling.file, "--json"}).status, 0) << said;
  }
}

TEST(Dying, ARecordingThatSomebodyTruncatesIsACrashThatIsSaid) {
  Recording feeling;
  ASSERT_EQ(chmod(feeling.file.c_str(), 0644), 0);  // it is read-only during the run
  ASSERT_EQ(truncate(feeling.file.c_str(), 0), 0);
  const int status = feeling.child.wait();
  EXPECT_TRUE(WIFSIGNALED(status) && WTERMSIG(status) == SIGBUS) << status;
  EXPECT_TRUE(contains(bytes_of(feeling.err), crashes[1].said)) << bytes_of(feeling.err);
}

TEST(Dying, CtrlCIsHowAPersonEndsARun) {
  Recording feeling;
  feeling.child.tell(SIGINT);
  EXPECT_EQ(feeling.child.wait(), 0) << bytes_of(feeling.err);
  EXPECT_TRUE(contains(bytes_of(feeling.err), "wale: ended by the signal INT (Interrupt)\n"));
}

TEST(Dying, WhatWasIgnoredFromTheBeginningStaysIgnored) {
  Recording feeling({SIGHUP});
  feeling.child.tell(SIGHUP);
  std::this_thread::sleep_for(std::chrono::milliseconds(100));
  feeling.child.tell(SIGTERM);
  const int status = feeling.child.wait();
  EXPECT_TRUE(WIFSIGNALED(status) && WTERMSIG(status) == SIGTERM) << "and not HUP: " << status;
}

/// A terminal whose other end the test holds.
class Pty {
 public:
  Pty() : master_(posix_openpt(O_RDWR | O_NOCTTY | O_CLOEXEC | O_NONBLOCK)) {
    grantpt(master_);
    unlockpt(master_);
    path = ptsname(master_);
    slave_ = open(path.c_str(), O_RDWR | O_NOCTTY | O_CLOEXEC);
    const winsize window{24, 80, 0, 0};
    ioctl(master_, TIOCSWINSZ, &window);
    tcgetattr(slave_, &before_);
  }
  ~Pty() {
    close(slave_);
    close(master_);
  }
  Pty(const Pty&) = delete;
  Pty& operator=(const Pty&) = delete;

  const std::string& screen() {
    char bytes[4096];
    for (ssize_t got = 0; (got = read(master_, bytes, sizeof bytes)) > 0;)
      screen_.append(bytes, static_cast<size_t>(got));
    return screen_;
  }
  bool is_as_before() const {
    termios now{};
    tcgetattr(slave_, &now);
    return now.c_lflag == before_.c_lflag;
  }

  std::string path;

 private:
  int master_, slave_ = -1;
  termios before_{};
  std::string screen_;
};

TEST(Dying, TheTerminalIsGivenBack) {
  constexpr char taken[] = "\033[?1003h", given_back[] = "\033[?25h\033[?1049l";
  for (const int signal : {SIGHUP, SIGQUIT, SIGTERM, SIGSEGV, SIGABRT, SIGTSTP}) {
    Pty pty;
    const TemporaryFolder folder;
    Child child({"feel", corduroy, "--device", "pointer", "--seconds", "600"}, folder / "out", folder / "err",
                pty.path);
    ASSERT_TRUE(eventually([&] { return contains(pty.screen(), taken); })) << bytes_of(folder / "err");
    ASSERT_FALSE(pty.is_as_before());
    child.tell(signal);
    if (signal == SIGTSTP) {
      EXPECT_TRUE(WIFSTOPPED(child.wait(WUNTRACED)));
      EXPECT_TRUE(contains(pty.screen(), given_back) && pty.is_as_before()) << signal;
      const std::size_t so_far = pty.screen().size();
      child.tell(SIGCONT);
      EXPECT_TRUE(eventually([&] { return pty.screen().find(taken, so_far) != std::string::npos; }));
      child.tell(SIGTERM);
    }
    int status = 0;
    ASSERT_TRUE(eventually([&] { return !pty.screen().empty() && child.has_ended(status); }));
    EXPECT_TRUE(WIFSIGNALED(status)) << signal;
    EXPECT_TRUE(contains(pty.screen(), given_back)) << signal;
    EXPECT_TRUE(pty.is_as_before()) << signal;
  }
}

}  // namespace
}  // namespace wale::command_line::dying_test
