#pragma once

#include <atomic>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <variant>

#include "compiler/open_file.hpp"
#include "library/open_device.hpp"
#include "wale/device.hpp"

namespace wale {

/// What a run asks of its device.
struct DeviceWanted {
  FileRequest file;                 ///< what is felt: it may declare devices, or be built for one
  std::string spelling;             ///< as `DeviceRequest` has it; empty: nothing is asked for, which is `auto`
  std::string built_for;            ///< the device that it is to be built for, where that is asked for; else empty
  std::optional<std::string> hand;  ///< the simulated one's motion: lateral, circular, rest, or a trace's file
  bool virtual_time = false;
  std::optional<double> seconds;  ///< a device that is not plugged in is waited for no longer; nothing: for ever
};

/// The device that is to be felt on, and the one to build for.
struct DeviceToFeel {
  Connections connections;  ///< open while something plugged in is used
  ChosenDevice chosen;
  std::string hand = "lateral";  ///< of a simulated one
};

/// What is to be told to the person, in a line or more.
using Say = std::function<void(const std::string&)>;

/// Chooses among what is plugged in and what is declared, and says so. A real device that is asked for and not there is
/// waited for until it is plugged in, as long as `stop` is false; what it is refused for is as `choose_device` has it.
std::variant<DeviceToFeel, Refusal> device_to_feel(const DeviceWanted& wanted, const Say& say,
                                                   const std::atomic<bool>& stop);

/// What was chosen, opened, or simulated in a hand that moves as asked, for a program. The connections and `stop`
/// outlive it.
std::variant<std::unique_ptr<Device>, Refusal> open_to_feel(const DeviceToFeel& device, const PatchProgram& program,
                                                            const Say& say, const std::atomic<bool>& stop);

}  // namespace wale
