#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <set>

#include "tests/qemu/kernel_check.hpp"
#include "tests/usb/profiles.hpp"

namespace wale::test {
namespace {

constexpr long ticks = 4500;        // 5 s at 900 Hz
constexpr long counts_a_tick = 7;   // of 32767, so that each force identifies its tick
constexpr double full_newton = 10;  // of `joystick_profile`

using Threads = std::set<std::string>;

Threads threads_now() {
  Threads threads;
  for (const auto& entry : std::filesystem::directory_iterator("/proc/self/task")) {
    threads.insert(entry.path().filename());
  }
  return threads;
}

/// Seconds that the processor has spent on all threads but these.
double processor_seconds(const Threads& but) {
  double nanoseconds = 0;
  for (const std::string& thread : threads_now()) {
    if (but.contains(thread)) continue;
    std::ifstream file("/proc/self/task/" + thread + "/schedstat");
    double spent = 0;
    if (file >> spent) nanoseconds += spent;
  }
  return nanoseconds * 1e-9;
}

/// The time of each tick's command, and the age of its force when it reached the device, in microseconds.
struct Ages {
  std::array<std::atomic<std::int64_t>, ticks + 1> commanded{};
  std::array<std::vector<std::int64_t>, 2> of_axis;
};

double at(std::vector<std::int64_t> sorted, double share) {
  if (sorted.empty()) return 0;
  std::ranges::sort(sorted);
  return static_cast<double>(sorted[static_cast<std::size_t>(share * static_cast<double>(sorted.size() - 1))]) / 1000;
}

void measure(UsbipPort& port, const PidFamily& family, PidTransportKind transport) {
  Ages ages;
  const Threads others = threads_now();
  const Found found = find(family.vendor, family.product);
  HidPidDevice::Options options = patient(transport);
  auto device = taken(HidPidDevice::open(found.context, found.info, trusted(joystick_profile()), options));
  port.with<PidModel>([&](PidModel& model) {
    model.logs = false;
    model.when_taken = [&ages, &family](const std::vector<std::uint8_t>& report) {
      if (report[0] != family.constant || report.size() != 4) return;
      const int counts = std::abs(static_cast<std::int16_t>(report[2] | report[3] << 8));
      const long tick = std::lround(static_cast<double>(counts) / counts_a_tick);
      if (tick < 1 || tick > ticks) return;
      const std::size_t axis = report[1] % 2 == 1 ? 0 : 1;
      ages.of_axis[axis].push_back(microseconds_now() - ages.commanded[static_cast<std::size_t>(tick)]);
    };
  });
  const double processor = processor_seconds(others);
  const auto began = std::chrono::steady_clock::now();
  tick(ticks, [&](long i) {
    const auto newton = static_cast<float>(static_cast<double>((i + 1) * counts_a_tick) / 32767 * full_newton);
    device->sample();
    ages.commanded[static_cast<std::size_t>(i + 1)] = microseconds_now();
    device->command({newton, newton});
  });
  const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - began).count();
  const double share = (processor_seconds(others) - processor) / seconds;
  const auto sent = device->counts().forces_sent;
  // Packets under way still arrive.
  std::this_thread::sleep_for(std::chrono::milliseconds(500));
  port.with<PidModel>([](PidModel& model) { model.when_taken = {}; });
  std::vector<std::int64_t> all = ages.of_axis[0];
  all.insert(all.end(), ages.of_axis[1].begin(), ages.of_axis[1].end());
  const auto arrived = static_cast<long>(all.size());
  std::printf("   %-7s %5.0f %5.0f %5.0f   %6.2f %6.2f %7.2f   %5ld   %4.1f %%\n",
              std::string(in_words(transport)).c_str(), static_cast<double>(ticks) / seconds,
              static_cast<double>(ages.of_axis[0].size()) / seconds,
              static_cast<double>(ages.of_axis[1].size()) / seconds, at(all, 0.5), at(all, 0.99), at(all, 1),
              std::max(0L, sent[0] + sent[1] - arrived), 100 * share);
  demand(!device->was_lost() && arrived > 100, "forces arrive by " + std::string(in_words(transport)));
}

}  // namespace

void measure_rates(const PidFamily& family) {
  std::printf("-- rates of %s, two axes that change with each tick\n", family.name);
  std::printf("           loop  x / s y / s   age: median, 99 %%, most (ms)   lost   processor\n");
  auto port = plugged(family);
  await([] { return !pushing_input().empty(); }, "the kernel's own driver binds it");
  for (int round = 0; round < 2; ++round) {
    for (const PidTransportKind transport :
         {PidTransportKind::hidraw, PidTransportKind::libusb, PidTransportKind::evdev}) {
      await([] { return !pushing_input().empty(); }, "the kernel's own driver is there");
      measure(*port, family, transport);
    }
  }
}

}  // namespace wale::test
