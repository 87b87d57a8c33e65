#pragma once

#include <array>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "runtime/device/driver.hpp"
#include "runtime/device/trusted_device.hpp"
#include "wale/declared_device.hpp"
#include "wale/result.hpp"

namespace wale {

/// Words that mean another device where one is chosen, beside drivers' names. `simulated` also begins `simulated:NAME`.
inline constexpr std::array<std::string_view, 3> words_for_devices = {"auto", "simulated", "usb"};

/// The device that a person asks for, as by `--device`.
struct DeviceRequest {
  /// `simulated`, `simulated:NAME`, `auto`, `usb`, a driver's name, a declared device, "1209:ffb0", or a port, "1-2.3".
  std::string spelling = "auto";
  std::string built_for;        ///< the device that the program is built for; empty if that is still open
  std::string transport = {};   ///< the way to drive a real device; empty: its driver chooses
  bool only_simulated = false;  ///< virtual time or a simulated hand's motion was asked for as well
  /// A known device whose figures are only in the patch program, which does not say whether a real one exists.
  std::string only_in_program = {};
  bool by_call = false;  ///< a program's call asks, so errors name its arguments and not the command line's options
};

/// The device that was chosen.
struct ChosenDevice {
  std::optional<DeclaredDevice> declared;  ///< to build for; none: simulate the program's own device
  std::optional<PluggedIn> plugged;        ///< none: it is simulated
  std::optional<TrustedDevice> trusted;    ///< to drive a plugged device by, with the same content as `declared`
  bool is_generic = false;                 ///< no declaration names the plugged device
  std::string said;                        ///< which one and why, for the person; may have several lines
  bool is_worth_saying = false;            ///< tell it also a person who did not ask for a device
};

/// Chooses among plugged devices, which use the `trusted` declarations, and simulated ones, which may also be only
/// `known`; of two declarations of one device the first counts. A name means the real device, unless its declaration is
/// about one that cannot be plugged in. `auto` takes the best real device, or else the simulated one. If an untrusted
/// declaration is about the chosen device, `said` names it and says what to do. Errors, each with what to do:
/// `absent_device`: the requested real device is not plugged in; `unusable_device`: it is plugged in but cannot be
/// used; `other_device`: the program is built for another device; `unknown_device`: no device has that name, or none is
/// declared for the one that has it; `untrusted_device`: the name of a real device is only in an untrusted declaration,
/// or only in the patch program;
/// `malformed_value`: a real device was requested together with virtual time or a simulated hand, or with a transport
/// that its driver lacks, also where it is not plugged in.
Result<ChosenDevice> choose_device(const DeviceRequest& request, std::span<const DeclaredDevice> known,
                                   std::span<const TrustedDevice> trusted, std::span<const PluggedIn> plugged,
                                   Drivers drivers = wale::drivers());

}  // namespace wale
