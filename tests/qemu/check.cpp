// The USB drivers against models of devices that the kernel takes for real ones: its virtual host controller enumerates
// them, its HID driver binds them, and libusb reaches them through its usbfs. Runs as root where vhci-hcd is loaded;
// tests/qemu/run starts a kernel for it. What is asserted is counts, order and bytes.

#include <fcntl.h>
#include <linux/input.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>
#include <thread>
#include <vector>

#include "runtime/device/falcon/falcon_device.hpp"
#include "runtime/device/hid_pid/hid_pid_device.hpp"
#include "runtime/device/usb/list_usb_devices.hpp"
#include "tests/qemu/usbip_port.hpp"
#include "tests/usb/falcon_model.hpp"
#include "tests/usb/pid_model.hpp"
#include "tests/usb/profiles.hpp"

namespace wale::test {
namespace {

using namespace std::chrono_literals;

void demand(bool holds, const std::string& what) {
  std::printf("%s: %s\n", holds ? "ok" : "FAILED", what.c_str());
  std::fflush(stdout);
  if (!holds) std::_Exit(1);
}

/// Emulation is slow, and a real fault lasts for ever.
template <class Condition>
void await(Condition holds, const std::string& what) {
  for (int i = 0; i < 60'000; ++i) {
    if (holds()) return demand(true, what);
    std::this_thread::sleep_for(1ms);
  }
  demand(false, what);
}

/// The kernel's input device that can push with a constant force, because hid-pidff has taken the descriptor; empty:
/// there is none.
std::string pushing_input() {
  std::error_code error;
  for (const auto& entry : std::filesystem::directory_iterator("/dev/input", error)) {
    if (entry.path().filename().string().rfind("event", 0) != 0) continue;
    const int device = open(entry.path().c_str(), O_RDONLY | O_CLOEXEC);
    if (device < 0) continue;
    std::array<std::uint8_t, FF_MAX / 8 + 1> effects{};
    const int got = ioctl(device, EVIOCGBIT(EV_FF, effects.size()), effects.data());
    close(device);
    if (got > 0 && (effects[FF_CONSTANT / 8] >> FF_CONSTANT % 8 & 1) != 0) return entry.path();
  }
  return "";
}
bool kernel_pushes() { return !pushing_input().empty(); }

/// Pushes through the kernel's own driver: 1 / 2 of full force along x. Lets go when it ends.
class KernelPush {
 public:
  KernelPush() : device_(open(pushing_input().c_str(), O_RDWR | O_CLOEXEC)) {
    ff_effect effect{};
    effect.type = FF_CONSTANT;
    effect.id = -1;
    effect.direction = 0x4000;
    effect.replay.length = 0x7fff;
    effect.u.constant.level = 0x4000;
    demand(ioctl(device_, EVIOCSFF, &effect) == 0, "the kernel makes an effect on it");
    input_event play{};
    play.type = EV_FF;
    play.code = static_cast<std::uint16_t>(effect.id);
    play.value = 1;
    demand(write(device_, &play, sizeof play) == sizeof play, "and plays it");
  }
  ~KernelPush() { close(device_); }
  KernelPush(const KernelPush&) = delete;
  KernelPush& operator=(const KernelPush&) = delete;

 private:
  int device_;
};

/// What is plugged in, as a new look at it tells: nobody passes the kernel's news on here.
struct Found {
  std::shared_ptr<UsbContext> context;
  UsbDeviceInfo info;
};
Found find(std::uint16_t vendor, std::uint16_t product) {
  Found found;
  await(
      [&] {
        found.context = std::get<std::shared_ptr<UsbContext>>(UsbContext::open());
        for (const UsbDeviceInfo& each : found.context->devices()) {
          if (each.vendor == vendor && each.product == product) {
            found.info = each;
            return true;
          }
        }
        return false;
      },
      "libusb finds " + in_words(vendor, product));
  return found;
}

// An emulated processor that others keep busy may take its time.
constexpr unsigned patience = 5000;  // ms

PidTransport::Options patient() {
  PidTransport::Options options;
  options.timeout = options.set_up_timeout = patience;
  options.session.command_silence = options.session.input_silence = patience / 1000.0;
  return options;
}

template <class Opened>
auto taken(Opened opened) {
  if (const auto* refusal = std::get_if<Refusal>(&opened)) demand(false, refusal->reason);
  return std::move(std::get<0>(opened));
}

/// Ticks at 900 Hz, as well as this machine can.
template <class Serve>
void tick(long ticks, Serve serve) {
  auto next = std::chrono::steady_clock::now();
  for (long i = 0; i < ticks; ++i) {
    serve(i);
    next = std::max(next + 1111us, std::chrono::steady_clock::now());
    std::this_thread::sleep_until(next);
  }
}

auto force_of(UsbipPort& port) {
  return port.with<PidModel>([](PidModel& model) { return model.force(); });
}

void check_joystick(const PidFamily& family) {
  std::printf("-- %s\n", family.name);
  const auto plugged = [&] {
    auto model = std::make_unique<PidModel>(family);
    model->moves = false;
    return std::make_unique<UsbipPort>(std::move(model), 0);
  };
  auto port = plugged();
  await(kernel_pushes, "the kernel's hid-pidff binds it");
  {
    const KernelPush push;
    await([&] { return std::abs(std::abs(force_of(*port).x) - 0.5) < 0.01; }, "which the model feels");
  }
  await([&] { return force_of(*port) == glm::dvec2(0); }, "until it is let go");
  {
    const Found found = find(family.vendor, family.product);
    const auto listed = list_usb_devices(*found.context);
    demand(listed.size() == 1 && listed[0].obstacle.empty(), "it is listed as usable: " + listed.at(0).can);
    demand(kernel_pushes(), "looking takes nothing from the kernel's driver");
    auto device = taken(HidPidDevice::open(found.context, found.info, joystick_profile(), patient()));
    demand(!kernel_pushes(), "the kernel's driver has been detached");
    port->with<PidModel>([](PidModel& model) {
      model.log.clear();
      model.wrong_reports = 0;  // the kernel's, if any
    });
    const long out = port->packets_out, in = port->packets_in;
    const auto began = std::chrono::steady_clock::now();
    constexpr long ticks = 1500;
    tick(ticks, [&](long i) {
      const auto newton = static_cast<float>(static_cast<double>(i + 1) / ticks * 5);
      device->sample();
      device->command({newton, -newton});
    });
    const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - began).count();
    std::printf("   %.0f packets out and %.0f in a second\n", static_cast<double>(port->packets_out - out) / seconds,
                static_cast<double>(port->packets_in - in) / seconds);
    await(
        [&] {
          device->command({5, -5});  // or it would let go
          return std::abs(force_of(*port).x - 0.5) < 0.01 && std::abs(force_of(*port).y - 0.5) < 0.01;
        },
        "the newest force arrives (HID's y is to the user) " + device->reason());
    demand(!device->was_lost(), "nothing is lost");
    const auto counts = device->counts();
    demand(counts.forces_sent[0] > 20 && counts.inputs > 20 && counts.bad_inputs == 0, "packets go both ways");
    double before = 0;
    bool rises = true;
    port->with<PidModel>([&](PidModel& model) {
      for (const std::string& line : model.log) {
        if (line.substr(0, 7) != "OUT " + hex({family.constant}) + " " || line.substr(7, 2) != "01") continue;
        const auto bytes = from_hex(line.substr(4));
        const double size = static_cast<std::int16_t>(bytes[2] | bytes[3] << 8);
        rises = rises && size >= before;
        before = size;
      }
      demand(rises, "no old force comes after a newer one");
      demand(model.wrong_reports == 0, "every report is as the device wants it");
    });
    device.reset();
    demand(force_of(*port) == glm::dvec2(0), "it is left without force");
    await(kernel_pushes, "the kernel's driver is back");
  }
  {
    const Found found = find(family.vendor, family.product);
    const auto device = taken(HidPidDevice::open(found.context, found.info, joystick_profile(), patient()));
    tick(200, [&](long) { device->command({2, 1}); });
    port.reset();
    await([&] { return device->was_lost(); }, "unplugged in the middle, it is lost");
    demand(device->reason() == "it was unplugged", "and says so: " + device->reason());
  }
  port = plugged();
  const Found found = find(family.vendor, family.product);
  const auto device = taken(HidPidDevice::open(found.context, found.info, joystick_profile(), patient()));
  await(
      [&] {
        device->command({3, 0});
        return std::abs(force_of(*port).x - 0.3) < 0.01;
      },
      "plugged in again, it is felt again");
}

void check_falcon() {
  std::printf("-- Novint Falcon\n");
  FalconOptions options;
  options.firmware = "/tmp/firmware.bin";
  options.transport.timeout = options.transport.set_up_timeout = patience;
  options.transport.session.answer_silence = options.transport.session.command_silence = patience / 1000.0;
  options.stale_after = patience / 1000.0;
  std::ofstream(options.firmware, std::ios::binary) << std::string(3000, 'w');
  auto model = std::make_unique<FalconModel>();
  model->moves = false;
  auto port = std::make_unique<UsbipPort>(std::move(model), 1);
  const auto open = [&](const Found& found) {
    return taken(FalconDevice::open(found.context, found.info, falcon_profile(), options));
  };
  const auto is_pushed = [&](FalconDevice& device) {
    return [&] {
      device.sample();
      device.command({1.5f, -1});
      const glm::dvec3 force = port->with<FalconModel>([](FalconModel& model) { return model.force(); });
      return std::abs(force.x - 1.5) < 0.05 && std::abs(force.y + 1) < 0.05;
    };
  };
  {
    const Found found = find(falcon::vendor, falcon::product);
    auto device = open(found);
    demand(device->counts().firmware_chunks == (3000 + 61) / 62, "its firmware is loaded, and it is homed");
    const auto began = std::chrono::steady_clock::now();
    const long before = device->counts().answers;
    tick(1000, [&](long) { is_pushed (*device)(); });
    const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - began).count();
    std::printf("   %.0f commands and answers a second\n",
                static_cast<double>(device->counts().answers - before) / seconds);
    await(is_pushed(*device), "the hand is pushed as was asked for");
    device.reset();
    port->with<FalconModel>([](FalconModel& model) {
      demand(model.torques == glm::ivec3(0) && model.torques_before_home == 0 && model.wrong_packets == 0,
             "no torque before homing and after the end");
    });
  }
  const Found found = find(falcon::vendor, falcon::product);
  const auto device = open(found);
  await(is_pushed(*device), "it is felt once more");
  port.reset();
  await([&] { return device->was_lost(); }, "unplugged in the middle, it is lost");
  demand(device->reason() == "it was unplugged", "and says so");
}

}  // namespace
}  // namespace wale::test

/// check NAME...: openffboard, rhino, falcon; without one all of them.
int main(int count, char** words) {
  using namespace wale::test;
  const std::vector<std::string> named(words + 1, words + count);
  const auto is_meant = [&](const char* name) {
    return named.empty() || std::ranges::find(named, name) != named.end();
  };
  if (is_meant("openffboard")) check_joystick(openffboard());
  if (is_meant("rhino")) check_joystick(rhino());
  if (is_meant("falcon")) check_falcon();
  std::printf("all passed\n");
  return 0;
}
