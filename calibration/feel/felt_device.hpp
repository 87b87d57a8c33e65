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
#include "wale/device.hpp"
#include "wale/patch_program.hpp"
#include "wale/stage.hpp"

namespace wale {

/// Shows the person a message of one or more lines.
using Say = std::function<void(const std::string&)>;

/// A device that was chosen for a run, and the connections through which it is opened.
struct DeviceToFeel {
  std::optional<Connections> connections;  ///< none if only simulated devices were requested
  ChosenDevice chosen;
};

/// Chooses by `request` among plugged devices, which use the `trusted` declarations, and simulations of `known`
/// devices. Tells the choice if the person asked or it matters. Waits for a real device that is not plugged in, for at
/// most `seconds`, until `stop` is true. Errors: those of `choose_device` and `wait_for_device`.
Result<DeviceToFeel> device_to_feel(const DeviceRequest& request, std::span<const DeclaredDevice> known,
                                    std::span<const TrustedDevice> trusted, std::optional<double> seconds,
                                    const Say& say, const std::atomic<bool>& stop);

/// How a device is run.
struct FeltOptions {
  std::string hand = "lateral";  ///< of a simulated person: as `motion_of` reads it
  bool virtual_time = false;
  std::string transport;          ///< of a real device, as in `DeviceOptions`
  double most_newton = HUGE_VAL;  ///< what the user allows
};

/// An open device, real or simulated.
struct FeltDevice {
  std::unique_ptr<Device> device;
  const HotPluggedDevice* plugged = nullptr;  ///< the same device if it is a real one; else null
  std::string name, hand;  ///< "simulated", "lateral"; a device without a position has no hand, but an assumed speed
  bool virtual_time = false;

  /// The conditions of a run on it, for the report. Call it while no other thread uses the device.
  RunManner manner() const;
};

/// Opens the chosen device for `program`, or simulates it in a hand of `person` that moves as `FeltOptions::hand` says.
/// `stop` must outlive the device. Errors: those of `open_device` and `load_trace`; `other_device` if the program is
/// built for another device; `other_figures` if it is built for other figures than the declaration of the chosen one.
Result<FeltDevice> open_to_feel(const DeviceToFeel& device, const PatchProgram& program, const HandDeclaration& person,
                                const FeltOptions& options, const Say& say, const std::atomic<bool>& stop);

/// How `feel` runs a stage: as punctually as the system permits, since the process is its own.
StageOptions felt_stage_options(double most_newton);

}  // namespace wale
