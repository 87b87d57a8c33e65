#pragma once

#include <atomic>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "library/device_kinds.hpp"
#include "runtime/device/hot_plugged_device.hpp"
#include "wale/library.hpp"

namespace wale {

/// The declared device that something plugged in is: of those that name its numbers the first, else the generic one.
struct MatchedProfile {
  const DeclaredDevice* device = nullptr;  ///< null: none
  bool is_generic = false;                  ///< no declaration is about it; its figures are assumed
};
MatchedProfile matched_profile(const PluggedIn& plugged, const std::vector<DeclaredDevice>& known);

/// All that is plugged in and of some kind, in the order in which `auto` looks at it. Of a kind that `auto` does not
/// choose, as the pointer, which is always there, only when that kind is `asked` for by its name.
std::vector<PluggedIn> plugged_in(const Connections& connections, std::string_view asked = {});

/// What is asked for by `--device`.
struct DeviceRequest {
  /// `simulated`, `simulated:NAME`, `auto`, `usb`, a kind of device, a declared device, "1209:ffb0", or a port,
  /// "1-2.3".
  std::string spelling = "auto";
  std::string built_for;        ///< the device that the program is for, where that is settled; else empty
  bool only_simulated = false;  ///< virtual time or a simulated hand's motion is asked for too
};

/// A real device is asked for, and nothing of its sort is plugged in.
struct Absent {
  std::string what;     ///< "no device 1209:ffb0 is plugged in"
  std::string instead;  ///< what to ask for instead: "`--device simulated`"
};

/// What it comes to.
struct ChosenDevice {
  std::string profile;               ///< the declared device to build for; empty: the program's own, simulated
  std::optional<PluggedIn> plugged;  ///< none: it is simulated
  DeviceWiring wiring;               ///< of what is plugged in
  bool is_generic = false;
  std::string said;              ///< which one and why, for the person
  bool is_worth_saying = false;  ///< also to a person who asked for nothing
};

/// Chooses among what is plugged in and what is declared; the first of `known` go before the others. A device that is
/// named is meant really, unless its declaration is about none that could be plugged in. `auto` takes the best real
/// one, or the simulated one. Refused, with what to do: what nothing is called, what cannot be used, and what the
/// program was not built for.
std::variant<ChosenDevice, Absent, Refusal> choose_device(const DeviceRequest& request,
                                                          const std::vector<DeclaredDevice>& known,
                                                          const std::vector<PluggedIn>& plugged);

/// Opens a chosen device that is plugged in, by the profile of the program, with threads just below the real-time
/// loop's priority where that is permitted. It is found again when it comes back after it was unplugged: at its port,
/// or at another one where none like it was. `ask` is told what the person is to do meanwhile, from whatever thread;
/// `stop`, once true, ends whatever waits for a person, and outlives the device.
std::variant<std::unique_ptr<HotPluggedDevice>, Refusal> open_device(const Connections& connections,
                                                                     const ChosenDevice& chosen,
                                                                     const DeviceProfile& profile,
                                                                     std::function<void(const std::string&)> ask = {},
                                                                     const std::atomic<bool>* stop = nullptr);

}  // namespace wale
