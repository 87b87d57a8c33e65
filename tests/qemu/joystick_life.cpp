#include <fcntl.h>
#include <linux/hidraw.h>
#include <sys/ioctl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "runtime/device/driver.hpp"
#include "runtime/device/usb/kernel_nodes.hpp"
#include "tests/qemu/kernel_check.hpp"
#include "tests/usb/profiles.hpp"

namespace wale::test {
namespace {

constexpr double near = 0.01;  // of full force

bool kernel_pushes() { return !pushing_input().empty(); }

bool is_hidraw_there() {
  std::error_code error;
  return std::ranges::any_of(std::filesystem::directory_iterator("/dev", error),
                             [](const auto& entry) { return entry.path().filename().string().starts_with("hidraw"); });
}

std::string hidraw_of(const Found& found) { return kernel_nodes(found.info).hid.at(0).hidraw; }

/// Whether the model got a force other than zero since its log was cleared.
bool was_pushed(UsbipPort& port, const PidFamily& family) {
  return port.with<PidModel>([&](PidModel& model) {
    return std::ranges::any_of(model.log, [&](const std::string& line) {
      return line.size() == 15 && line.substr(4, 2) == hex({family.constant}) && line.substr(10) != "00 00";
    });
  });
}

void clear_log(UsbipPort& port) {
  port.with<PidModel>([](PidModel& model) {
    model.log.clear();
    model.wrong_reports = 0;  // the kernel's, if any
  });
}

std::unique_ptr<HidPidDevice> opened(const Found& found, PidTransportKind transport) {
  return taken(HidPidDevice::open(found.context, found.info, trusted(joystick_profile()), patient(transport)));
}

void await_force(UsbipPort& port, HidPidDevice& device, Force newton, glm::dvec2 fraction, const std::string& what) {
  await(
      [&] {
        device.command(newton);  // without commands the device ends its force
        const glm::dvec2 force = force_of(port);
        return std::abs(force.x - fraction.x) < near && std::abs(force.y - fraction.y) < near;
      },
      what);
}

/// The forces sent to the first effect never fall while the commanded force rises.
void demand_order(UsbipPort& port, const PidFamily& family) {
  port.with<PidModel>([&](PidModel& model) {
    double before = 0;
    bool rises = true;
    for (const std::string& line : model.log) {
      if (line.substr(0, 7) != "OUT " + hex({family.constant}) + " " || line.substr(7, 2) != "01") continue;
      const auto bytes = from_hex(line.substr(4));
      const double size = static_cast<std::int16_t>(bytes[2] | bytes[3] << 8);
      rises = rises && size >= before;
      before = size;
    }
    demand(rises, "no old force comes after a newer one");
    demand(model.wrong_reports == 0, "every report is valid");
  });
}

void check_whole_life(UsbipPort& port, const PidFamily& family, PidTransportKind transport) {
  const Found found = find(family.vendor, family.product);
  const auto listed = plugged_in({found.context});
  demand(listed.size() == 1 && !listed[0].obstacle, "it is listed as usable: " + listed.at(0).can);
  demand(kernel_pushes(), "listing devices leaves the kernel's driver attached");
  clear_log(port);
  auto device = opened(found, transport);
  demand(force_of(port) == glm::dvec2(0) && !was_pushed(port, family), "it does not push when it is opened");
  const bool is_exclusive = transport == PidTransportKind::libusb;
  demand(kernel_pushes() != is_exclusive && is_hidraw_there() != is_exclusive,
         is_exclusive ? "the kernel's driver has been detached" : "games still see it");
  constexpr long ticks = 1500;
  tick(ticks, [&](long i) {
    const auto newton = static_cast<float>(static_cast<double>(i + 1) / ticks * 5);
    device->sample();
    device->command({newton, -newton});
  });
  await_force(port, *device, {5, -5}, {0.5, 0.5},
              "the newest force arrives (HID's y is to the user) " + device->reason());
  demand(!device->was_lost(), "nothing is lost");
  const auto counts = device->counts();
  demand(counts.forces_sent[0] > 20 && counts.bad_inputs == 0, "packets go out");
  demand(counts.inputs > 20 || transport == PidTransportKind::evdev, "packets come in");
  demand_order(port, family);
  device.reset();
  await([&] { return force_of(port) == glm::dvec2(0); }, "it is left without force");
  await(kernel_pushes, is_exclusive ? "the kernel's driver is back" : "the kernel's driver was never away");
}

void check_refused_set_up(UsbipPort& port, const PidFamily& family) {
  const Found found = find(family.vendor, family.product);
  port.with<PidModel>([](PidModel& model) { model.faults.short_load = true; });
  const auto refused =
      HidPidDevice::open(found.context, found.info, trusted(joystick_profile()), patient(PidTransportKind::libusb));
  demand(!refused, "a set-up that fails is an error: " + (refused ? "" : refused.error().sentence));
  port.with<PidModel>([](PidModel& model) { model.faults.short_load = false; });
  await(kernel_pushes, "and the kernel's driver is back all the same");
}

void check_killed(UsbipPort& port, const PidFamily& family, PidTransportKind transport) {
  OtherProcess wale(
      {"wale", std::string(in_words(transport)), std::to_string(family.vendor), std::to_string(family.product)});
  await([&] { return std::abs(force_of(port).x - 0.3) < near; }, "another process pushes");
  wale.kill();
  await([&] { return force_of(port) == glm::dvec2(0); }, "and when it is killed the force ends");
  if (transport == PidTransportKind::libusb) {
    opened(find(family.vendor, family.product), transport).reset();
    await(kernel_pushes, "the next one gives the kernel's driver back");
  }
}

void check_game_first(UsbipPort& port, const PidFamily& family, PidTransportKind transport) {
  const OtherProcess game({"game"});
  await([&] { return std::abs(std::abs(force_of(port).x) - 0.5) < near; }, "a game pushes through the kernel's driver");
  const double game_force = force_of(port).x;
  const Found found = find(family.vendor, family.product);
  const auto listed = plugged_in({found.context});
  const std::string holder = listed.at(0).held_by.empty() ? "nobody" : listed[0].held_by[0];
  demand(listed[0].held_by.size() == 1 && holder.find("(" + std::to_string(game.process()) + ")") != std::string::npos,
         "it is seen to hold the stick: " + holder);
  clear_log(port);
  auto device = opened(found, transport);
  demand(!was_pushed(port, family), "the take-over sends no force");
  if (transport == PidTransportKind::libusb) {
    demand(force_of(port) == glm::dvec2(0), "after the take-over it has no force");
    await_force(port, *device, {0, -2}, {0, 0.2}, "and then what is commanded");
  } else {
    demand(std::abs(force_of(port).x - game_force) < near, "the game's force continues");
    await_force(port, *device, {0, -2}, {game_force, 0.2}, "beside what is commanded");
  }
  demand(!device->was_lost(), "nothing is lost");
  device.reset();
  await(kernel_pushes, "it is given back");
}

/// A game that comes later: with some kernels its first effect resets the device.
void check_game_second(UsbipPort& port, const PidFamily& family, PidTransportKind transport) {
  const Found found = find(family.vendor, family.product);
  auto device = opened(found, transport);
  await_force(port, *device, {0, -2}, {0, 0.2}, "it is felt");
  const OtherProcess game({"game"});
  int losses = 0;
  await(
      [&] {
        device->command({0, -2});
        if (device->was_lost()) {
          ++losses;
          std::printf("   %s\n", device->reason().c_str());
          device.reset();
          device = opened(found, transport);
        }
        const glm::dvec2 force = force_of(port);
        return std::abs(std::abs(force.x) - 0.5) < near && std::abs(force.y - 0.2) < near;
      },
      "a game that comes later and it are both felt");
  std::printf("   set up again %d times\n", losses);
}

constexpr std::uint8_t enable = 0x97, stop_all = 0x99, reset = 0x9a;  // usages of page 0F

/// Writes a Device Control report as another program does.
void control_as_rival(const std::string& node, const PidFamily& family, std::uint8_t usage, const std::string& what) {
  const auto at = std::ranges::find(family.control_orders, usage) - family.control_orders.begin();
  const auto order = static_cast<std::uint8_t>(family.control_is_mask ? 1 << at : at + 1);
  const std::uint8_t report[] = {family.control, order};
  const int rival = open(node.c_str(), O_RDWR | O_CLOEXEC);
  demand(rival >= 0 && write(rival, report, sizeof report) == sizeof report, what);
  close(rival);
}

long blocks_of(UsbipPort& port) {
  return port.with<PidModel>(
      [](PidModel& model) { return std::ranges::count_if(model.effects, &PidModel::Effect::exists); });
}

void check_rival(UsbipPort& port, const PidFamily& family) {
  const Found found = find(family.vendor, family.product);
  auto device = opened(found, PidTransportKind::hidraw);
  tick(300, [&](long) {
    device->command({4, 0});
  });  // its effects have been started again, so that their state is known
  await_force(port, *device, {4, 0}, {0.4, 0}, "it pushes");
  control_as_rival(hidraw_of(found), family, reset, "a rival resets the device");
  await([&] { return device->was_lost(); }, "which is noticed: " + device->reason());
  demand(force_of(port) == glm::dvec2(0), "no force is left");
  clear_log(port);
  device.reset();
  device = opened(found, PidTransportKind::hidraw);
  demand(!was_pushed(port, family) && force_of(port) == glm::dvec2(0), "it is set up again from zero force");
  await_force(port, *device, {4, 0}, {0.4, 0}, "and felt again");
  tick(300, [&](long) { device->command({4, 0}); });
  const long blocks = blocks_of(port);
  await(
      [&] {
        device->command({4, 0});
        if (!device->was_lost()) control_as_rival(hidraw_of(found), family, stop_all, "a rival stops all effects");
        return device->was_lost();
      },
      "which is noticed: " + device->reason());
  device.reset();
  await([&] { return blocks_of(port) == blocks - 2; }, "its blocks are given back");
}

/// What evdev_transport.hpp says of this.
void check_unnoticed_rival(UsbipPort& port, const PidFamily& family) {
  const Found found = find(family.vendor, family.product);
  auto device = opened(found, PidTransportKind::evdev);
  await_force(port, *device, {4, 0}, {0.4, 0}, "it pushes");
  control_as_rival(hidraw_of(found), family, reset, "a rival resets the device");
  constexpr long ticks = 900;
  tick(ticks, [&](long i) { device->command({i % 2 == 0 ? 4.0f : 3.0f, 1}); });
  demand(force_of(port) == glm::dvec2(0), "nothing pushes any more");
  demand(!device->was_lost(), "and nothing on the event node tells why " + device->reason());
  device.reset();
  control_as_rival(hidraw_of(found), family, enable, "the rival enables the actuators");
  device = opened(found, PidTransportKind::evdev);
  await_force(port, *device, {4, 0}, {0.4, 0}, "opened again, it is felt again");
}

void check_handed_in(UsbipPort& port, const PidFamily& family, PidTransportKind transport) {
  const Found found = find(family.vendor, family.product);
  const KernelNodes nodes = kernel_nodes(found.info);
  const std::string path = transport == PidTransportKind::hidraw   ? nodes.hid.at(0).hidraw
                           : transport == PidTransportKind::libusb ? nodes.usbfs
                                                                   : nodes.hid.at(0).pushing.at(0);
  const int descriptor = open(path.c_str(), O_RDWR | O_CLOEXEC | O_NONBLOCK);
  auto device = taken(HidPidDevice::open(found.context, descriptor, trusted(joystick_profile()), patient(transport)));
  demand(device->transport() == transport, "a descriptor of " + path + " is recognised");
  await_force(port, *device, {2, -1}, {0.2, 0.1}, "and used");
  device.reset();
  demand(fcntl(descriptor, F_GETFD) >= 0, "it stays open");
  close(descriptor);
  await([&] { return force_of(port) == glm::dvec2(0); }, "without force");
}

/// Without a udev rule only the event node is open to a user at the desk.
void check_permissions(const PidFamily& family) {
  const KernelNodes nodes = kernel_nodes(find(family.vendor, family.product).info);
  for (const std::string& node : {nodes.usbfs, nodes.hid.at(0).hidraw}) chmod(node.c_str(), 0600);
  for (const std::string& node : nodes.hid.at(0).events) chmod(node.c_str(), 0666);
  OtherProcess nobody({"nobody", std::to_string(family.vendor), std::to_string(family.product)});
  demand(nobody.ends_well(), "without permission to the others, evdev is taken");
}

void check_unplugged(std::unique_ptr<UsbipPort>& port, const PidFamily& family, PidTransportKind transport) {
  {
    const auto device = opened(find(family.vendor, family.product), transport);
    tick(200, [&](long) { device->command({2, 1}); });
    port.reset();
    await([&] { return device->was_lost(); }, "unplugged in the middle, it is lost");
    await([&] { return !device->reason().empty(); }, "and says so");
    demand(device->reason() == "it was unplugged", device->reason());
  }
  port = plugged(family);
  await(kernel_pushes, "the kernel's driver binds it again");
  const auto device = opened(find(family.vendor, family.product), transport);
  await_force(*port, *device, {3, 0}, {0.3, 0}, "plugged in again, it is felt again");
}

}  // namespace

void check_life(const PidFamily& family, PidTransportKind transport) {
  std::printf("-- %s by %s\n", family.name, std::string(in_words(transport)).c_str());
  auto port = plugged(family);
  await(kernel_pushes, "the kernel's own driver binds it");
  check_whole_life(*port, family, transport);
  if (transport == PidTransportKind::libusb) check_refused_set_up(*port, family);
  check_handed_in(*port, family, transport);
  check_game_first(*port, family, transport);
  if (transport != PidTransportKind::libusb) check_game_second(*port, family, transport);
  if (transport == PidTransportKind::hidraw) check_rival(*port, family);
  if (transport == PidTransportKind::evdev) {
    check_unnoticed_rival(*port, family);
    check_permissions(family);
  }
  check_killed(*port, family, transport);
  check_unplugged(port, family, transport);
}

}  // namespace wale::test
