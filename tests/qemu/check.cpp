// Runs the USB drivers with models of devices, through a real kernel. The kernel's virtual host controller enumerates
// the models, and its HID driver binds them. The drivers reach them through usbfs, hidraw and evdev. The program runs
// as root with vhci-hcd loaded; tests/qemu/run starts a kernel for it. It asserts counts, order and bytes.

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdlib>
#include <fstream>

#include "runtime/device/falcon/falcon_device.hpp"
#include "tests/qemu/kernel_check.hpp"
#include "tests/usb/falcon_model.hpp"
#include "tests/usb/profiles.hpp"

namespace wale::test {

void check_falcon() {
  std::printf("-- Novint Falcon\n");
  FalconOptions options;
  options.firmware = "/tmp/firmware.bin";
  options.transport.timeout = options.transport.set_up_timeout = patience;
  options.transport.session.answer_silence = options.transport.session.command_silence = patience / 1000.0;
  options.transport.session.stale_after = patience / 1000.0;
  std::ofstream(options.firmware, std::ios::binary) << std::string(3000, 'w');
  auto model = std::make_unique<FalconModel>();
  model->moves = false;
  auto port = std::make_unique<UsbipPort>(std::move(model), 1);
  const auto open = [&](const Found& found) {
    return taken(FalconDevice::open(found.context, found.info, trusted(falcon_profile()), options));
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
    await(is_pushed(*device), "the hand gets the commanded force");
    device.reset();
    port->with<FalconModel>([](FalconModel& model) {
      demand(model.torques == glm::ivec3(0) && model.torques_before_home == 0 && model.wrong_packets == 0,
             "no torque before homing and after the end");
    });
  }
  const Found found = find(falcon::vendor, falcon::product);
  const auto device = open(found);
  await(is_pushed(*device), "its force is back");
  port.reset();
  await([&] { return device->was_lost(); }, "it is lost when unplugged");
  demand(device->reason() == "it was unplugged", "its reason is the unplugging");
}

}  // namespace wale::test

/// check NAME...: openffboard, rhino, falcon, dying_hidraw, dying_libusb, dying_evdev, dying_falcon, rates; without one
/// all of them.
int main(int count, char** words) {
  using namespace wale::test;
  const std::vector<std::string> named(words + 1, words + count);
  if (named == std::vector<std::string>{"game"}) play_as_game();
  const auto number = [&](std::size_t i) { return static_cast<std::uint16_t>(std::atoi(named[i].c_str())); };
  if (named.size() == 3 && named[0] == "nobody") push_as_nobody(number(1), number(2));
  if (named.size() == 4 && named[0] == "wale") {
    push_as_wale(*wale::read_transport_kind(named[1]), number(2), number(3));
  }
  if (named.size() == 4 && named[0] == "push") push_until_dead(named[1], number(2), number(3));
  const auto is_meant = [&](const char* name) {
    return named.empty() || std::ranges::find(named, name) != named.end();
  };
  const auto check_joystick = [](const PidFamily& family) {
    for (const auto transport : wale::transports_by_preference()) check_life(family, transport);
  };
  if (is_meant("openffboard")) check_joystick(openffboard());
  if (is_meant("rhino")) check_joystick(rhino());
  if (is_meant("falcon")) check_falcon();
  for (const char* by : {"hidraw", "libusb", "evdev", "falcon"})
    if (is_meant((std::string("dying_") + by).c_str())) check_dying(by);
  if (is_meant("rates")) measure_rates(openffboard());
  std::printf("all passed\n");
  return 0;
}
