#pragma once

#include <memory>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "schema/patch_program.hpp"
#include "wale/device.hpp"

namespace wale {

/// A device of hardware, set up and running. Its axes are its own: x to the right and y away from the user as far as
/// its kind's standard says; whoever uses it turns them as its `DeviceWiring` says. One that is gone reads
/// `Contact::lost` from then on and for good: another is opened in its place. What it does at once when it is let go,
/// as when it is lost, is to push no more.
class PluggedDevice : public Device {
 public:
  /// Why it was lost; empty otherwise. Not real-time; may be called while another thread uses the device.
  virtual std::string reason() const = 0;

  /// What it has done since it was opened, for the report: {"forces_sent_x", 4210}. Not real-time; as `reason`.
  virtual std::vector<std::pair<std::string, long>> tally() const = 0;

  /// In a line, how it is driven: "an effect for each axis, by direction".
  virtual std::string manner() const = 0;
};

using OpenedDevice = std::variant<std::unique_ptr<PluggedDevice>, Refusal>;

}  // namespace wale
