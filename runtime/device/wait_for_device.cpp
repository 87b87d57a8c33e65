#include "runtime/device/wait_for_device.hpp"

#include <chrono>
#include <thread>
#include <utility>
#include <vector>

#include "schema/sentence.hpp"

namespace wale {

Result<ChosenDevice> wait_for_device(Connections& connections, const DeviceRequest& request,
                                     std::span<const DeclaredDevice> known, std::span<const TrustedDevice> trusted,
                                     std::optional<double> seconds, const std::atomic<bool>& stop, Drivers drivers,
                                     const std::function<Connections()>& open) {
  using Clock = std::chrono::steady_clock;
  constexpr auto between_looks = std::chrono::milliseconds(100);
  constexpr int most_looks = 20;  // at a device that was just plugged in: udev gives permission a moment later
  constexpr int rest = 5;         // rounds between other looks: only USB tells what comes and goes
  const auto begun = Clock::now();
  std::vector<UsbDeviceInfo> seen;
  int looks = 1;  // the device may have come before the first look
  Error newest{Code::absent_device, "no such device is plugged in"};
  for (int round = 0; !stop.load(std::memory_order_relaxed); ++round) {
    if (seconds && std::chrono::duration<double>(Clock::now() - begun).count() >= *seconds) {
      if (newest.code == Code::absent_device) newest.sentence += sentence(", and none came within ", *seconds, " s");
      return newest;
    }
    std::this_thread::sleep_for(between_looks);
    if (!connections.usb && round % rest == 0) connections = open();
    if (connections.usb) {
      auto now = (*connections.usb)->devices();
      if (now != seen) looks = most_looks;
      seen = std::move(now);
    }
    if (looks == 0 && round % rest != 0) continue;
    const bool was_absent = newest.code == Code::absent_device;
    auto choice = choose_device(request, known, trusted, plugged_in(connections, request.spelling, drivers), drivers);
    if (choice) return choice;
    newest = std::move(choice.error());
    if (looks > 0) {
      --looks;
    } else if (was_absent && newest.code != Code::absent_device) {
      looks = most_looks;
    }
    if (newest.code != Code::absent_device && looks == 0) return newest;
  }
  return Error{Code::stopped, "stopped while waiting for a device"};
}

}  // namespace wale
