#pragma once

#include <atomic>
#include <functional>
#include <string>
#include <string_view>
#include <variant>

#include "library/device_kinds.hpp"
#include "runtime/device/identification.hpp"
#include "wale/library.hpp"

namespace wale {

/// Pushes a device gently and watches how it answers, in real time on the calling thread, ten to thirty seconds;
/// `Identification` says how. `say` is told what the person should do, each time that changes. The device is without
/// force afterwards. Refused when `stop` became true, and when the device was lost.
std::variant<Identified, Refusal> identify_device(Device& device, const IdentifyOptions& options,
                                                  const std::function<void(std::string_view)>& say,
                                                  const std::atomic<bool>& stop);

/// What was found out, for a person: what each motor moves, at what force, and what the person showed.
std::string identified_text(const Identified& found);

/// The same device with its axes and motors as they were found, which are settled: a gain is its motor's, wherever that
/// pushes.
DeviceWiring rewired(DeviceWiring wiring, const Identified& found);

/// A file that declares a device like `device`, with another name and wiring, for whoever builds for it:
/// figures that were assumed still are. The comments are lines without `//`.
std::string device_declaration(const DeclaredDevice& device, const std::string& name, const DeviceWiring& wiring,
                               const std::vector<std::string>& comments);

}  // namespace wale
