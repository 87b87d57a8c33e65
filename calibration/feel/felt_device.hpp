#pragma once

#include <atomic>
#include <cmath>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>

#include "calibration/feel/felt_report.hpp"
#include "compiler/declarations/declarations.hpp"
#include "runtime/device/open_device.hpp"
#include "schema/patch_program.hpp"
#include "wale/device.hpp"

namespace wale {

/// Tells the person something, in a line or more.
using Say = std::function<void(const std::string&)>;

/// A device that was chosen for a run, and the connections that it is opened by.
struct DeviceToFeel {
  std::optional<Connections> connections;  ///< none where only simulated devices were asked for
  ChosenDevice chosen;
};

/// Chooses by `request` among what is plugged in, by the declarations that are `trusted`, and what is `known`, and says
/// so, where the person asked or it matters. A real device that is not plugged in is waited for, `seconds` at most,
/// until `stop` is true. Errors: as `choose_device` and `wait_for_device` give them.
Result<DeviceToFeel> device_to_feel(const DeviceRequest& request, std::span<const DeclaredDevice> known,
                                    std::span<const TrustedDevice> trusted, std::optional<double> seconds,
                                    const Say& say, const std::atomic<bool>& stop);

/// How a device is run.
struct FeltOptions {
  std::string hand = "lateral";  ///< of a simulated person: lateral, circular, rest, or a trace's file
  bool virtual_time = false;
  std::string transport;          ///< of a real device, as in `DeviceOptions`
  double most_newton = HUGE_VAL;  ///< likewise: what the user allows
};

/// An open device, real or simulated.
struct FeltDevice {
  std::unique_ptr<Device> device;
  const HotPluggedDevice* plugged = nullptr;  ///< the same device, where it is a real one
  std::string name, hand;                     ///< "simulated", "lateral"
  bool virtual_time = false;

  /// How a run on it was made, for the report. While nobody else uses the device.
  RunManner manner() const;
};

/// Opens the chosen device for `program`, or simulates it in a hand of `person` that moves as asked. `stop` outlives
/// the device. Errors: as `open_device` and `load_trace` give them; `other_device` where the program is built for
/// another device, and `other_figures` where it is built for other figures of a real one than its trusted declaration
/// has.
Result<FeltDevice> open_to_feel(const DeviceToFeel& device, const PatchProgram& program, const HandDeclaration& person,
                                const FeltOptions& options, const Say& say, const std::atomic<bool>& stop);

}  // namespace wale
