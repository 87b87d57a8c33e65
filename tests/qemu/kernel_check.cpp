#include "tests/qemu/kernel_check.hpp"

#include <fcntl.h>
#include <linux/input.h>
#include <signal.h>
#include <spawn.h>
#include <sys/ioctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cstdlib>
#include <filesystem>

#include "runtime/device/driver.hpp"
#include "tests/usb/profiles.hpp"

namespace wale::test {

void demand(bool holds, const std::string& what) {
  std::printf("%s: %s\n", holds ? "ok" : "FAILED", what.c_str());
  std::fflush(stdout);
  if (!holds) std::_Exit(1);
}

Found find(std::uint16_t vendor, std::uint16_t product) {
  Found found;
  await(
      [&] {
        found.context = taken(UsbContext::open());
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

HidPidDevice::Options patient(PidTransportKind transport) {
  HidPidDevice::Options options;
  options.timeout = options.set_up_timeout = patience;
  options.session.command_silence = options.session.input_silence = patience / 1000.0;
  options.transport = transport;
  return options;
}

std::unique_ptr<UsbipPort> plugged(const PidFamily& family) {
  auto model = std::make_unique<PidModel>(family);
  model->moves = false;
  model->tells_state = true;
  return std::make_unique<UsbipPort>(std::move(model), 0);
}

glm::dvec2 force_of(UsbipPort& port) {
  return port.with<PidModel>([](PidModel& model) { return model.force(); });
}

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

OtherProcess::OtherProcess(std::vector<std::string> words) {
  const std::string self = std::filesystem::read_symlink("/proc/self/exe");
  std::vector<char*> raw{const_cast<char*>(self.c_str())};
  for (std::string& word : words) raw.push_back(word.data());
  raw.push_back(nullptr);
  demand(posix_spawn(&process_, self.c_str(), nullptr, nullptr, raw.data(), environ) == 0, "another program starts");
}

void OtherProcess::kill() {
  if (process_ <= 0) return;
  ::kill(process_, SIGKILL);
  waitpid(process_, nullptr, 0);
  process_ = 0;
}

bool OtherProcess::ends_well() {
  int status = 0;
  waitpid(process_, &status, 0);
  process_ = 0;
  return WIFEXITED(status) && WEXITSTATUS(status) == 0;
}

void push_as_nobody(std::uint16_t vendor, std::uint16_t product) {
  constexpr uid_t nobody = 65534;
  demand(setuid(nobody) == 0, "a user without rights");
  const Found found = find(vendor, product);
  const auto listed = plugged_in({found.context});
  demand(listed.size() == 1 && !listed[0].obstacle, "the list says that it is driven by " + listed.at(0).transport);
  HidPidDevice::Options options = patient(PidTransportKind::evdev);
  options.transport.reset();
  const auto device = taken(HidPidDevice::open(found.context, found.info, trusted(joystick_profile()), options));
  demand(device->transport() == PidTransportKind::evdev, "the driver runs it: " + device->manner());
  std::_Exit(0);
}

void play_as_game() {
  const int device = open(pushing_input().c_str(), O_RDWR | O_CLOEXEC);
  ff_effect effect{};
  effect.type = FF_CONSTANT;
  effect.id = -1;
  effect.direction = 0x4000;
  effect.replay.length = 0x7fff;
  effect.u.constant.level = 0x4000;
  if (ioctl(device, EVIOCSFF, &effect) != 0) std::_Exit(1);
  input_event play{};
  play.type = EV_FF;
  play.code = static_cast<std::uint16_t>(effect.id);
  play.value = 1;
  if (write(device, &play, sizeof play) != sizeof play) std::_Exit(1);
  while (true) pause();
}

void push_as_wale(PidTransportKind transport, std::uint16_t vendor, std::uint16_t product) {
  const auto context = taken(UsbContext::open());
  for (const UsbDeviceInfo& info : context->devices()) {
    if (info.vendor != vendor || info.product != product) continue;
    const auto device = taken(HidPidDevice::open(context, info, trusted(joystick_profile()), patient(transport)));
    while (true) {
      device->command({3, 0});
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
  }
  std::_Exit(1);
}

}  // namespace wale::test
