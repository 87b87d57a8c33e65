// Every way to die that no handler catches, through a real kernel, while 3 N are commanded: how long the model's motors
// push on. schema/SECURITY.md has the table.

#include <fcntl.h>
#include <pthread.h>
#include <sched.h>
#include <signal.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <functional>
#include <random>

#include "runtime/device/falcon/falcon_device.hpp"
#include "runtime/stage/scheduling.hpp"
#include "tests/qemu/kernel_check.hpp"
#include "tests/usb/falcon_model.hpp"
#include "tests/usb/profiles.hpp"

namespace wale::test {
namespace {

/// How often each way is tried: 20 times, or as WALE_DYING_TIMES says.
int times() {
  const char* asked = std::getenv("WALE_DYING_TIMES");
  return asked != nullptr ? std::max(1, std::atoi(asked)) : 20;
}
/// Whether WALE_DYING_WAY, a part of its name, chooses this way; all are chosen without it.
bool is_chosen(const std::string& way) {
  const char* asked = std::getenv("WALE_DYING_WAY");
  return asked == nullptr || way.find(asked) != std::string::npos;
}
constexpr long most_frames = 250;
int late_deaths = 0;  // ways in which it took longer

// What a process that pushes is told by SIGUSR1 and SIGUSR2.
volatile sig_atomic_t is_to_crash = 0, is_to_run_away = 0;

void make_real_time(int priority) {
  sched_param parameters{};
  parameters.sched_priority = priority;
  pthread_setschedparam(pthread_self(), SCHED_FIFO, &parameters);
}

std::unique_ptr<PluggedDevice> open_to_push(const Found& found, const std::string& way) {
  if (way == "falcon") {
    FalconOptions options;
    options.firmware = "/tmp/firmware.bin";
    options.transport.keeper.emplace();
    options.transport.timeout = options.transport.set_up_timeout = patience;
    return taken(FalconDevice::open(found.context, found.info, trusted(falcon_profile()), options));
  }
  HidPidDevice::Options options;
  options.timeout = options.set_up_timeout = patience;
  options.priority = usual_priority - 1;
  options.transport = read_transport_kind(way);
  options.keeper.emplace();
  return taken(HidPidDevice::open(found.context, found.info, trusted(joystick_profile()), options));
}

pid_t keeper_now() {
  for (const auto& each : std::filesystem::directory_iterator("/proc")) {
    std::ifstream file(each.path() / "comm");
    std::string name;
    if (std::getline(file, name) && name == "wale-keeper") return std::atoi(each.path().filename().c_str());
  }
  return 0;
}

struct Way {
  const char* name;
  std::function<void(pid_t owner)> die;
  std::function<void(pid_t owner)> go_on{};  ///< wakes what was only stopped

  /// Whether its force may last until it goes on: nobody is left to end it, and the device cannot.
  bool may_last(const std::string& by) const { return by == "falcon" && std::string_view(name).starts_with("both"); }
};

const std::vector<Way>& ways() {
  static const std::vector<Way> all{
      {"SIGKILL", [](pid_t owner) { ::kill(owner, SIGKILL); }},
      {"SIGSTOP, then SIGCONT", [](pid_t owner) { ::kill(owner, SIGSTOP); },
       [](pid_t owner) { ::kill(owner, SIGCONT); }},
      {"a crash with a core dump", [](pid_t owner) { ::kill(owner, SIGUSR1); }},
      {"a loop that runs away", [](pid_t owner) { ::kill(owner, SIGUSR2); }},
      {"its keeper killed", [](pid_t) { ::kill(keeper_now(), SIGKILL); }},
      {"both killed",
       [](pid_t owner) {
         ::kill(keeper_now(), SIGKILL);
         ::kill(owner, SIGKILL);
       }},
      // As the kernel does to all processes before the computer sleeps, and after it woke up.
      {"both stopped, then awake",
       [](pid_t owner) {
         ::kill(keeper_now(), SIGSTOP);
         ::kill(owner, SIGSTOP);
       },
       [](pid_t owner) {
         ::kill(owner, SIGCONT);
         ::kill(keeper_now(), SIGCONT);
       }}};
  return all;
}

double milliseconds_until(const std::function<bool()>& holds, double most) {
  const std::int64_t began = microseconds_now();
  while (true) {
    const double passed = static_cast<double>(microseconds_now() - began) / 1000;
    if (holds() || passed > most) return passed;
    std::this_thread::sleep_for(std::chrono::microseconds(500));
  }
}

/// How long a force lasted: by the clock, at most 2000 ms, and by the device's frames. An emulated processor that
/// others keep busy makes frames longer than a millisecond; a device's durations and the bus go by frames, the keeper
/// by the clock.
struct Lasted {
  double milliseconds = 0;
  long frames = 0;
};

/// When the device last pushed, from now on, until it has not for 200 ms; 2000 ms where it does not end. A loop that
/// the emulated processor keeps waiting is silent for a while too, so the first moment without force is not the end.
Lasted last_push(const std::function<double()>& force, const std::atomic<long>& frames, long first_frame) {
  constexpr double long_time = 2000, calm = 200;  // ms
  const std::int64_t began = microseconds_now();
  Lasted last;
  while (true) {
    const double passed = static_cast<double>(microseconds_now() - began) / 1000;
    if (force() > 0) last = {passed, frames - first_frame};
    if (passed > long_time || passed - last.milliseconds > calm) return last;
    std::this_thread::sleep_for(std::chrono::microseconds(500));
  }
}

/// How long the force lasted, and how long again where the process went on; -1 where no force was left then.
struct Death {
  Lasted lasted;
  Lasted after{-1, 0};
};

/// One death at a random moment.
Death die_once(const Way& way, const std::string& by, const UsbDeviceInfo& info, const std::function<double()>& force,
               const std::atomic<long>& frames, std::minstd_rand& random) {
  OtherProcess owner({"push", by, std::to_string(info.vendor), std::to_string(info.product)});
  const bool is_pushed = milliseconds_until([&] { return force() > 0; }, 60'000) < 60'000;
  if (!is_pushed) demand(false, "it pushes before it dies");
  std::this_thread::sleep_for(std::chrono::microseconds(random() % 40'000));
  // An emulated loop that was kept waiting may just have been let go.
  milliseconds_until([&] { return force() > 0; }, 60'000);
  const long first_frame = frames;
  way.die(owner.process());
  Death death{last_push(force, frames, first_frame)};
  if (way.go_on) {
    const bool pushed = force() > 0;
    constexpr double sleep = 2000;  // ms
    std::this_thread::sleep_for(std::chrono::duration<double, std::milli>(sleep - death.lasted.milliseconds));
    way.go_on(owner.process());
    const Lasted after = last_push(force, frames, frames);
    // What only its process or its keeper can end had ended before both were stopped: the emulated processor had kept
    // the loop waiting for 100 ms, and nothing was pushed that could be left over.
    const bool had_ended = !pushed && way.may_last(by);
    if (pushed)
      death.after = after;
    else if (after.milliseconds > 0 && !had_ended)
      demand(false, "continued, it does not push on");
  }
  owner.kill();
  milliseconds_until([&] { return keeper_now() == 0; }, 60'000);
  std::error_code ignored;
  for (const auto& each : std::filesystem::directory_iterator("/tmp", ignored))
    if (each.path().filename().string().starts_with("core")) std::filesystem::remove(each.path(), ignored);
  return death;
}

void die_of_all(const std::string& by, const UsbDeviceInfo& info, const std::function<double()>& force,
                const std::atomic<long>& frames, const std::function<void()>& between) {
  std::minstd_rand random(1995);
  for (const Way& way : ways()) {
    if (!is_chosen(way.name)) continue;
    std::vector<double> lasted;
    long most = 0;
    Lasted after{-1, 0};
    for (int i = 0; i < times(); ++i) {
      between();
      const Death once = die_once(way, by, info, force, frames, random);
      lasted.push_back(once.lasted.milliseconds);
      most = std::max(most, once.lasted.frames);
      after = {std::max(after.milliseconds, once.after.milliseconds), std::max(after.frames, once.after.frames)};
    }
    std::ranges::sort(lasted);
    std::printf("   %-26s %-7s median %4.0f ms, most %4.0f ms and %3ld frames, of %d\n", way.name, by.c_str(),
                lasted[lasted.size() / 2], lasted.back(), most, times());
    if (after.milliseconds >= 0)
      std::printf("   %-26s %-7s awake, most %4.0f ms and %3ld frames\n", "", by.c_str(), after.milliseconds,
                  after.frames);
    std::fflush(stdout);
    if ((most > most_frames && !way.may_last(by)) || after.frames > most_frames) ++late_deaths;
  }
}

}  // namespace

void push_until_dead(const std::string& by, std::uint16_t vendor, std::uint16_t product) {
  signal(SIGUSR1, [](int) { is_to_crash = 1; });
  signal(SIGUSR2, [](int) { is_to_run_away = 1; });
  const rlimit unlimited{RLIM_INFINITY, RLIM_INFINITY};
  setrlimit(RLIMIT_CORE, &unlimited);
  if (chdir("/tmp") != 0) std::_Exit(1);
  std::vector<char> memory(96 << 20, 'x');  // whose dump takes its time
  const Found found = find(vendor, product);
  const auto device = open_to_push(found, by);
  make_real_time(usual_priority);
  while (device->sample().contact != Contact::lost) {
    device->command({3, 0});
    if (is_to_crash != 0) *static_cast<volatile char*>(nullptr) = memory[4711];
    while (is_to_run_away != 0) {
    }
    std::this_thread::sleep_for(std::chrono::microseconds(1111));
  }
  std::printf("   %s\n", device->reason().c_str());
  while (true) pause();
}

void check_dying(const std::string& by) {
  std::printf("-- dying, %s\n", by.c_str());
  make_real_time(95);  // the model's threads too: what stands for the device waits for no processor
  late_deaths = 0;
  if (by == "falcon") {
    std::ofstream("/tmp/firmware.bin", std::ios::binary) << std::string(3000, 'w');
    auto model = std::make_unique<FalconModel>();
    model->moves = model->logs = false;
    model->runs_firmware = true;
    UsbipPort port(std::move(model), 1);
    const Found found = find(falcon::vendor, falcon::product);
    const auto force = [&] {
      return port.with<FalconModel>([](FalconModel& each) { return std::hypot(each.force().x, each.force().y); });
    };
    die_of_all(by, found.info, force, port.frames,
               [&] { port.with<FalconModel>([](FalconModel& each) { each.torques = {}; }); });
  } else {
    auto port = plugged(openffboard());
    await([] { return !pushing_input().empty(); }, "the kernel's own driver binds it");
    port->with<PidModel>([](PidModel& each) { each.logs = false; });
    const Found found = find(openffboard().vendor, openffboard().product);
    const auto force = [&] { return std::hypot(force_of(*port).x, force_of(*port).y); };
    die_of_all(by, found.info, force, port->frames,
               [] { milliseconds_until([] { return !pushing_input().empty(); }, 60'000); });
  }
  demand(late_deaths == 0, "however it dies, the force ends within 250 frames");
}

}  // namespace wale::test
