#include "library/device_to_feel.hpp"

#include <fmt/format.h>

#include <chrono>
#include <thread>
#include <utility>
#include <vector>

#include "library/devices_known.hpp"
#include "library/load_trace.hpp"
#include "wale/simulated_pad.hpp"

namespace wale {
namespace {

using namespace std::chrono_literals;
using Choice = std::variant<ChosenDevice, Absent, Refusal>;

/// Looks again whenever something is plugged in, until what is asked for is there, or cannot be used.
std::variant<ChosenDevice, Refusal> wait_for(const Absent& absent, const Connections& connections,
                                             const DeviceRequest& request, const std::vector<DeclaredDevice>& known,
                                             std::optional<double> seconds, const std::atomic<bool>& stop) {
  using Clock = std::chrono::steady_clock;
  constexpr auto between_looks = 100ms;
  constexpr int most_looks = 20;  // at what has just been plugged in: permissions come a moment after it
  const auto begun = Clock::now();
  std::vector<UsbDeviceInfo> seen;
  int looks = 1;         // something may have come before the first of them
  std::string obstacle;  // of what has come and cannot be used
  while (!stop.load(std::memory_order_relaxed)) {
    if (seconds && std::chrono::duration<double>(Clock::now() - begun).count() >= *seconds)
      return Refusal{
          obstacle.empty() ? fmt::format("{}, and none was within {:.4g} s", absent.what, *seconds) : obstacle, {}};
    std::this_thread::sleep_for(between_looks);
    auto now = connections.usb->devices();
    if (now != seen) looks = most_looks;
    seen = std::move(now);
    if (looks == 0) continue;
    --looks;
    Choice choice = choose_device(request, known, plugged_in(connections, request.spelling));
    if (auto* chosen = std::get_if<ChosenDevice>(&choice)) return std::move(*chosen);
    const auto* refusal = std::get_if<Refusal>(&choice);
    obstacle = refusal != nullptr ? refusal->reason : "";
    if (refusal != nullptr && looks == 0) return *refusal;
  }
  return Refusal{"stopped, and nothing was felt", {}};
}

/// How a simulated hand moves.
std::variant<Motion, Refusal> motion_of(const std::string& hand, const SimulatedPerson& person) {
  if (hand == "lateral") return person.lateral;
  if (hand == "circular") return person.circular;
  if (hand == "rest") return Rest{};
  auto trace = load_trace(hand);
  if (auto* refusal = std::get_if<Refusal>(&trace)) return std::move(*refusal);
  return std::get<Trace>(std::move(trace));
}

}  // namespace

std::variant<DeviceToFeel, Refusal> device_to_feel(const DeviceWanted& wanted, const Say& say,
                                                   const std::atomic<bool>& stop) {
  const OpenedFile file = open_file(wanted.file);  // what is wrong with it is said when it is built
  const std::vector<DeclaredDevice> known = file.module ? devices_known(*file.module) : devices_here();
  const DeviceRequest request{.spelling = wanted.spelling.empty() ? "auto" : wanted.spelling,
                              .built_for = file.program ? file.program->description().device.name : wanted.built_for,
                              .only_simulated = wanted.virtual_time || wanted.hand};
  DeviceToFeel device;
  if (wanted.hand) device.hand = *wanted.hand;
  std::vector<PluggedIn> plugged;
  if (!request.only_simulated && !request.spelling.starts_with("simulated")) {
    device.connections = Connections::open();
    plugged = plugged_in(device.connections, request.spelling);
  }
  Choice choice = choose_device(request, known, plugged);
  if (const auto* absent = std::get_if<Absent>(&choice)) {
    if (!device.connections.usb)
      return Refusal{fmt::format("{}: USB cannot be looked at: {}", absent->what, device.connections.without_usb), {}};
    say(fmt::format("{} (`wale devices` lists what is): waiting for it; Ctrl-C ends that, {} needs none", absent->what,
                    absent->instead));
    auto come = wait_for(*absent, device.connections, request, known, wanted.seconds, stop);
    if (auto* refusal = std::get_if<Refusal>(&come)) return std::move(*refusal);
    choice = std::get<ChosenDevice>(std::move(come));
  }
  if (auto* refusal = std::get_if<Refusal>(&choice)) return std::move(*refusal);
  device.chosen = std::get<ChosenDevice>(std::move(choice));
  if (!device.chosen.said.empty() && (!wanted.spelling.empty() || device.chosen.is_worth_saying))
    say(device.chosen.said);
  return device;
}

std::variant<std::unique_ptr<Device>, Refusal> open_to_feel(const DeviceToFeel& device, const PatchProgram& program,
                                                            const Say& say, const std::atomic<bool>& stop) {
  const DeviceProfile& profile = program.device;
  if (device.chosen.plugged) {
    auto opened = open_device(device.connections, device.chosen, profile, say, &stop);
    if (auto* refusal = std::get_if<Refusal>(&opened)) return std::move(*refusal);
    return std::get<std::unique_ptr<HotPluggedDevice>>(std::move(opened));
  }
  if (!device.chosen.profile.empty() && profile.name != device.chosen.profile)
    return Refusal{fmt::format("`{}` is built for `{}`; feel it there, or build it for `{}`", program.material,
                               profile.name, device.chosen.profile),
                   {}};
  const auto person = std::get<SimulatedPerson>(Library().person());
  auto motion = motion_of(device.hand, person);
  if (auto* refusal = std::get_if<Refusal>(&motion)) return std::move(*refusal);
  if (program.vibrates()) return std::make_unique<SimulatedPad>(profile, std::get<Motion>(std::move(motion)));
  return std::make_unique<SimulatedJoystick>(profile, person.hand, std::get<Motion>(std::move(motion)));
}

}  // namespace wale
