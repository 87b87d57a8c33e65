#include "runtime/device/identify_device.hpp"

#include <algorithm>
#include <chrono>
#include <thread>
#include <utility>

namespace wale {

Result<Identified> identify_device(Device& device, const IdentifyOptions& options,
                                   const std::function<void(std::string_view)>& say, const std::atomic<bool>& stop) {
  using Clock = std::chrono::steady_clock;
  Identification identification(device.profile(), options);
  const auto period =
      std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(1 / device.profile().rate));
  std::string_view said;
  for (auto next = Clock::now(); !identification.is_done();) {
    device.elapse(1);
    const Reading reading = device.sample();
    const bool is_stopped = stop.load(std::memory_order_relaxed);
    if (is_stopped || reading.contact == Contact::lost) {
      device.command(Force(0));
      if (is_stopped) return Error{Code::stopped, "stopped before the device's axes were found"};
      return Error{Code::lost_device, "the device was lost before its axes were found"};
    }
    device.command(reading.contact == Contact::good ? identification.tick(reading.counts) : Force(0));
    if (identification.request() != said && !identification.is_done()) say(said = identification.request());
    next = std::max(next + period, Clock::now());  // a late tick is not caught up
    std::this_thread::sleep_until(next);
  }
  device.command(Force(0));
  return identification.result();
}

DeviceWiring rewired(DeviceWiring wiring, const Identified& found) {
  wiring = wiring.with_motors(*found.motors_settled);
  wiring.axes = *found.axes_settled;
  return wiring;
}

}  // namespace wale
