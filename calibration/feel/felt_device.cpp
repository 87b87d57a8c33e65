#include "calibration/feel/felt_device.hpp"

#include <fmt/format.h>

#include <utility>
#include <vector>

#include "calibration/feel/hand_motion.hpp"
#include "compiler/modules/load_modules.hpp"
#include "compiler/text/readable.hpp"
#include "runtime/device/wait_for_device.hpp"
#include "schema/built_for.hpp"
#include "wale/simulated.hpp"
#include "wale/simulated_pad.hpp"

namespace wale {
namespace {

Result<std::unique_ptr<Device>> simulated(const PatchProgram& program, const HandDeclaration& person,
                                          const std::string& hand) {
  auto motion = motion_of(hand, person, common_modules()->declarations);
  if (!motion) return std::move(motion.error());
  std::unique_ptr<Device> device;
  if (program.vibrates())
    device = std::make_unique<SimulatedPad>(program.device, *std::move(motion));
  else
    device = std::make_unique<SimulatedJoystick>(
        program.device, HandModel{person.mass, person.damping, person.stiffness}, *std::move(motion));
  return device;
}

}  // namespace

RunManner FeltDevice::manner() const {
  RunManner manner{name, hand, virtual_time, std::nullopt};
  if (plugged != nullptr) manner.plugged = plugged->report();
  return manner;
}

Result<DeviceToFeel> device_to_feel(const DeviceRequest& request, std::span<const DeclaredDevice> known,
                                    std::span<const TrustedDevice> trusted, std::optional<double> seconds,
                                    const Say& say, const std::atomic<bool>& stop) {
  DeviceToFeel device;
  std::vector<PluggedIn> plugged;
  if (!request.only_simulated && !request.spelling.starts_with("simulated")) {
    device.connections = Connections::open();
    plugged = plugged_in(*device.connections, request.spelling);
  }
  auto choice = choose_device(request, known, trusted, plugged);
  if (!choice && choice.error().code == Code::absent_device) {
    const Error& absent = choice.error();
    const auto& usb = device.connections->usb;
    say(fmt::format("{}{}: waiting for it; Ctrl-C ends that\n  = help: {}; `wale devices` lists what is plugged in",
                    absent.sentence, usb ? "" : ", and " + usb.error().sentence,
                    usb || usb.error().mend.empty() ? absent.mend : usb.error().mend));
    choice = wait_for_device(*device.connections, request, known, trusted, seconds, stop);
  }
  if (!choice) return std::move(choice.error());
  device.chosen = *std::move(choice);
  return device;
}

Result<FeltDevice> open_to_feel(const DeviceToFeel& device, const PatchProgram& program, const HandDeclaration& person,
                                const FeltOptions& options, const Say& say, const std::atomic<bool>& stop) {
  const ChosenDevice& chosen = device.chosen;
  // A real device is that of its trusted declaration, one that was named is that of its declaration, and any other is
  // that of the program.
  const DeviceProfile& declared = chosen.trusted    ? chosen.trusted->profile()
                                  : chosen.declared ? chosen.declared->profile
                                                    : program.device;
  if (auto built = is_built_for(program, declared); !built) {
    if (!chosen.plugged && built.error().code == Code::other_figures)
      built.error().mend += "; `--device simulated` simulates the device that it is built for";
    return std::move(built.error());
  }
  if (!chosen.plugged) {
    auto opened = simulated(program, person, options.hand);
    if (!opened) return std::move(opened.error());
    const DeviceProfile& profile = program.device;
    std::string hand =
        profile.has_position() ? options.hand : readable("at an assumed {:g} m/s", profile.shaker->exploring_speed);
    return FeltDevice{*std::move(opened), nullptr, "simulated", std::move(hand), options.virtual_time};
  }
  auto opened = open_device(*device.connections, chosen,
                            {.priority = usual_priority - 1,
                             .ask = say,
                             .stop = &stop,
                             .transport = options.transport,
                             .most_newton = options.most_newton});
  if (!opened) return std::move(opened.error());
  const HotPluggedDevice* plugged = opened->get();
  return FeltDevice{*std::move(opened), plugged, in_words(*chosen.plugged), "yours", false};
}

StageOptions felt_stage_options(double most_newton) {
  return {.priority = usual_priority, .lock_memory = true, .low_latency = true, .max_force = most_newton};
}

}  // namespace wale
