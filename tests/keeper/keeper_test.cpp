// A keeper and its owner, with one end of a socket for the device: what the keeper writes comes out of the other.

#include "runtime/keeper/keeper.hpp"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <poll.h>
#include <signal.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <string>
#include <thread>

#include "runtime/keeper/start_keeper.hpp"

namespace wale::keeper_test {
namespace {

using namespace std::chrono_literals;
using Verdict = Keeper::Verdict;

/// Waits until it holds, a minute at most.
template <class Condition>
bool eventually(Condition holds) {
  for (int look = 0; look < 60'000; ++look) {
    if (holds()) return true;
    std::this_thread::sleep_for(1ms);
  }
  return false;
}

/// Lets go by "Z", says farewell by "F".
class Device {
 public:
  Device() {
    int ends[2];
    if (socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, ends) != 0) std::abort();
    node = ends[0], far_ = ends[1];
    fcntl(far_, F_SETFL, O_NONBLOCK);
    plan.node = LetGoPlan::Node::hidraw;
    const std::uint8_t zero[] = {'Z'}, farewell[] = {'F'};
    plan.add({.way = LetGoStep::Way::report}, zero);
    plan.add({.way = LetGoStep::Way::report, .is_farewell = true}, farewell);
  }
  ~Device() {
    close(node);
    close(far_);
  }
  Device(const Device&) = delete;
  Device& operator=(const Device&) = delete;

  /// All that it has been told so far.
  const std::string& told() {
    char bytes[256];
    for (ssize_t got = 0; (got = read(far_, bytes, sizeof bytes)) > 0;) told_.append(bytes, static_cast<size_t>(got));
    return told_;
  }
  bool is_let_go() { return told().find('Z') != std::string::npos; }
  bool has_farewell() { return !told().empty() && told().back() == 'F'; }

  int node = -1;
  LetGoPlan plan;

 private:
  int far_ = -1;
  std::string told_;
};

std::unique_ptr<Keeper> kept(const Device& device) {
  auto keeper = Keeper::start(device.plan, device.node, {.program = WALE_KEEPER});
  EXPECT_TRUE(keeper) << in_words(keeper.error());
  return keeper ? *std::move(keeper) : nullptr;
}

bool lives(pid_t process) { return kill(process, 0) == 0; }

TEST(AKeeper, DoesNothingWhileTheLoopTicksAndGoesWithItsOwner) {
  Device device;
  auto keeper = kept(device);
  const pid_t process = keeper->process();
  long ticks = 0;
  for (int attempt = 0; attempt < 1000 && ticks < 300; ++attempt) {  // this thread may itself wait for a processor
    const auto began = std::chrono::steady_clock::now();
    keeper->beat();
    keeper->note_push();
    std::this_thread::sleep_for(1ms);
    keeper->note_slack();
    const bool was_late = std::chrono::steady_clock::now() - began > 90ms;
    if (was_late && keeper->look() == Verdict::latched) GTEST_SKIP() << "the machine is too busy";
    ASSERT_NE(keeper->look(), Verdict::latched);
    ticks += was_late ? 0 : 1;
  }
  keeper.reset();
  EXPECT_TRUE(eventually([&] { return !lives(process); }));
  EXPECT_EQ(device.told(), "");
}

TEST(AKeeper, TakesADeviceThatPushesWhenTheLoopDoesNotTick) {
  Device device;
  auto keeper = kept(device);
  keeper->beat();
  keeper->note_push();
  EXPECT_TRUE(eventually([&] { return keeper->look() == Verdict::latched; }));
  EXPECT_EQ(keeper->why(Verdict::latched), "its keeper let it go, because the loop did not tick for 100 ms");
  EXPECT_TRUE(eventually([&] { return device.is_let_go(); }));
  keeper->beat();
  EXPECT_EQ(keeper->look(), Verdict::latched) << "for good";
  const std::size_t before = device.told().size();
  EXPECT_TRUE(eventually([&] { return device.told().size() > before + 3; }))
      << "again and again: something may still come";
  EXPECT_FALSE(device.has_farewell());
  keeper.reset();
  EXPECT_TRUE(device.has_farewell()) << device.told();
}

TEST(AKeeper, LeavesADeviceAtRestAlone) {
  Device device;
  auto keeper = kept(device);
  keeper->beat();
  keeper->note_push();
  keeper->note_slack();
  EXPECT_TRUE(eventually([&] { return keeper->look() == Verdict::late; }));
  std::this_thread::sleep_for(200ms);
  EXPECT_EQ(keeper->look(), Verdict::late) << "no latch";
  keeper->beat();
  EXPECT_EQ(keeper->look(), Verdict::good);
  EXPECT_EQ(device.told(), "");
}

TEST(AKeeper, IsMissedWhenItDies) {
  Device device;
  const auto keeper = kept(device);
  keeper->beat();
  kill(keeper->process(), SIGKILL);
  EXPECT_TRUE(eventually([&] {
    keeper->beat();
    return keeper->look() == Verdict::gone;
  }));
  EXPECT_EQ(keeper->why(Verdict::gone), "its keeper has ended, and nothing may push without one");
}

TEST(AKeeper, IsMissedWhenItIsStopped) {
  Device device;
  const auto keeper = kept(device);
  kill(keeper->process(), SIGSTOP);
  EXPECT_TRUE(eventually([&] {
    keeper->beat();
    return keeper->look() == Verdict::gone;
  }));
  kill(keeper->process(), SIGCONT);
}

/// As when both are frozen: what was commanded before is old, though the keeper looks and the loop ticks again.
TEST(AKeeper, ThatWasStoppedWithItsOwnerDoesNotHideThatTheLoopStalled) {
  Device device;
  auto keeper = kept(device);
  keeper->beat();
  kill(keeper->process(), SIGSTOP);
  std::this_thread::sleep_for(1100ms);
  keeper->beat();
  EXPECT_NE(keeper->look(), Verdict::stalled) << "nothing was pushed meanwhile";
  keeper->note_push();
  std::this_thread::sleep_for(1100ms);
  keeper->beat();
  EXPECT_EQ(keeper->why(Verdict::stalled), "the loop did not tick for a second");
  keeper->note_slack();
  kill(keeper->process(), SIGCONT);
  EXPECT_TRUE(eventually([&] { return keeper->look() == Verdict::stalled; })) << "once the keeper looks again";
  keeper->beat();
  EXPECT_EQ(keeper->look(), Verdict::stalled) << "for good";
}

TEST(AKeeper, TellsThatTheComputerWasAsleep) {
  static std::atomic<std::int64_t> slept{7'000'000'000};
  Device device;
  auto keeper = Keeper::start(device.plan, device.node,
                              {.program = WALE_KEEPER, .asleep = []() noexcept { return slept.load(); }});
  ASSERT_TRUE(keeper);
  (*keeper)->beat();
  EXPECT_EQ((*keeper)->look(), Verdict::good) << "what it slept before is over";
  slept += 1'000'000'000;
  (*keeper)->beat();
  EXPECT_EQ((*keeper)->look(), Verdict::slept) << "so what was commanded before is old";
  EXPECT_EQ((*keeper)->why(Verdict::slept), "the computer was asleep");
}

TEST(AKeeper, HearsNoSignalThatEndsTheSession) {
  Device device;
  auto keeper = kept(device);
  for (const int signal : {SIGHUP, SIGINT, SIGQUIT, SIGTERM, SIGPIPE, SIGALRM, SIGUSR1, SIGTSTP})
    kill(keeper->process(), signal);
  std::this_thread::sleep_for(50ms);
  EXPECT_TRUE(lives(keeper->process()));
  EXPECT_NE(getsid(keeper->process()), getsid(0)) << "a session of its own";
}

TEST(AKeeper, IsNoChildOfItsOwner) {
  static std::atomic<int> children{0};
  struct sigaction own {
  }, before{};
  own.sa_handler = [](int) { ++children; };
  sigaction(SIGCHLD, &own, &before);
  {
    Device device;
    const auto keeper = kept(device);
    EXPECT_EQ(waitpid(-1, nullptr, WNOHANG), -1);
    EXPECT_EQ(errno, ECHILD);
  }
  EXPECT_EQ(children, 0);
  sigaction(SIGCHLD, &before, nullptr);
}

TEST(AKeeper, HasNothingOfItsOwnersOpen) {
  Device device;
  int pipe_ends[2];
  ASSERT_EQ(pipe(pipe_ends), 0);  // without close-on-exec, as careless programs do
  const auto keeper = kept(device);
  close(pipe_ends[1]);
  pollfd ended{pipe_ends[0], POLLIN, 0};
  EXPECT_EQ(poll(&ended, 1, 10'000), 1) << "the reader sees the end of the pipe";
  close(pipe_ends[0]);
  int open = 0;
  for (const auto& each : std::filesystem::directory_iterator("/proc/" + std::to_string(keeper->process()) + "/fd"))
    open += std::stoi(each.path().filename()) > 2;
  EXPECT_EQ(open, 4) << "the shared memory, its owner, the call, the device";
}

/// A process that owns a device, pushes and ticks, until it does what `end` does.
template <class End>
pid_t owner_that(const Device& device, End end) {
  const pid_t child = fork();
  if (child != 0) return child;
  const auto keeper = kept(device);
  keeper->note_push();
  for (int tick = 0; tick < 50; ++tick) {
    keeper->beat();
    std::this_thread::sleep_for(1ms);
  }
  end(*keeper);
  _exit(9);
}

TEST(AnOwner, ThatIsKilledIsFollowedByLettingGoAndAFarewell) {
  Device device;
  const pid_t owner = owner_that(device, [](Keeper&) { raise(SIGKILL); });
  EXPECT_TRUE(eventually([&] { return device.is_let_go(); }));
  waitpid(owner, nullptr, 0);
  EXPECT_TRUE(eventually([&] { return device.has_farewell(); })) << device.told();
}

TEST(AnOwner, ThatIsStoppedFindsItsDeviceTakenWhenItContinues) {
  Device device;
  const pid_t owner = owner_that(device, [](Keeper& keeper) {
    raise(SIGSTOP);
    keeper.beat();
    _exit(keeper.look() == Verdict::latched ? 0 : 1);
  });
  EXPECT_TRUE(eventually([&] { return device.is_let_go(); }));
  EXPECT_FALSE(device.has_farewell()) << "it is held meanwhile";
  kill(owner, SIGCONT);
  int status = 0;
  waitpid(owner, &status, 0);
  EXPECT_EQ(status, 0);
  EXPECT_TRUE(eventually([&] { return device.has_farewell(); }));
}

TEST(AnOwner, ThatCrashesAsksForAllItsDevicesAtOnce) {
  Device first, second;
  const pid_t owner = owner_that(first, [&](Keeper& keeper) {
    const auto other = kept(second);
    keeper.beat();
    let_all_devices_go();
    _exit(keeper.look() == Verdict::latched && other->look() == Verdict::latched ? 0 : 1);
  });
  int status = 0;
  waitpid(owner, &status, 0);
  EXPECT_EQ(status, 0);
  EXPECT_TRUE(first.is_let_go() && second.is_let_go()) << "before it ended";
}

TEST(FindingAKeeper, SaysWhereItWasLookedFor) {
  const auto named = find_keeper("/nowhere/wale-keeper");
  ASSERT_FALSE(named);
  EXPECT_EQ(named.error().code, Code::no_keeper);
  EXPECT_EQ(named.error().sentence, "the keeper is no program that can be run");
  const auto nowhere = find_keeper("", {"/nowhere/wale-keeper", "/elsewhere/wale-keeper"});
  ASSERT_FALSE(nowhere);
  EXPECT_EQ(nowhere.error().code, Code::no_keeper);
  EXPECT_EQ(nowhere.error().place.name, "/nowhere/wale-keeper");
  const auto ours = find_keeper("");
  ASSERT_TRUE(ours) << "../libexec/wale from a program, here as where Wale is installed";
  EXPECT_EQ(*ours, WALE_KEEPER);
  const auto no_program = Keeper::start({}, -1, {.program = "/dev/null"});
  ASSERT_FALSE(no_program);
  EXPECT_EQ(no_program.error().code, Code::no_keeper);
  const auto no_device = Keeper::start({}, -1, {.program = WALE_KEEPER});
  ASSERT_FALSE(no_device) << "without a node it could not let anything go";
  EXPECT_EQ(no_device.error().sentence, "the keeper ended before it began");
}

}  // namespace
}  // namespace wale::keeper_test
