#pragma once

#include <optional>
#include <span>
#include <string>

#include "runtime/device/driver.hpp"
#include "runtime/device/trusted_device.hpp"
#include "schema/declared_device.hpp"
#include "schema/result.hpp"

namespace wale {

/// The device that is asked for, as by `--device`.
struct DeviceRequest {
  /// `simulated`, `simulated:NAME`, `auto`, `usb`, a driver's name, a declared device, "1209:ffb0", or a port, "1-2.3".
  std::string spelling = "auto";
  std::string built_for;        ///< the device that the program is for, where that is settled; else empty
  bool only_simulated = false;  ///< virtual time or a simulated hand's motion is asked for too
};

/// The device that was chosen.
struct ChosenDevice {
  std::optional<DeclaredDevice> declared;  ///< to build for; none: the program's own, simulated
  std::optional<PluggedIn> plugged;        ///< none: it is simulated
  std::optional<TrustedDevice> trusted;    ///< to drive it by: there where `plugged` is, and the same as `declared`
  bool is_generic = false;                 ///< no declaration is about what is plugged in
  std::string said;                        ///< which one and why, for the person; may have several lines
  bool is_worth_saying = false;            ///< also to a person who asked for nothing
};

/// Chooses among what is plugged in, by the declarations that are `trusted`, and what can be simulated, which is also
/// what is only `known`; of two declarations of one device the first counts. A device that is named is the real one,
/// unless its declaration is about none that can be plugged in. `auto` takes the best real one, or the simulated one.
/// Where a declaration that is only known is about the chosen device, `said` names it, and what to do. Errors, each
/// with what to do: `absent_device` a real device is asked for, and is not plugged in; `unusable_device` it is plugged
/// in and cannot be used; `other_device` the program is built for another one; `unknown_device` nothing has that name,
/// and no declaration is about what has; `untrusted_device` a real device is asked for by the name of a declaration
/// that is not trusted; `malformed_value` a real device is asked for together with virtual time or a simulated hand.
Result<ChosenDevice> choose_device(const DeviceRequest& request, std::span<const DeclaredDevice> known,
                                   std::span<const TrustedDevice> trusted, std::span<const PluggedIn> plugged,
                                   Drivers drivers = wale::drivers());

}  // namespace wale
