#pragma once

#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "wale/device.hpp"
#include "wale/result.hpp"

namespace wale {

/// A hardware device, set up and running. Its axes are its own, by its standard x to the right and y away from the
/// user; `HotPluggedDevice` turns them by its `DeviceWiring`. Once it is lost it always reads `Contact::lost`; a new
/// object is opened in its place. It stops pushing when it is destroyed or lost.
class PluggedDevice : public Device {
 public:
  /// Why it was lost; empty if it was not. Not real-time; may be called while another thread uses the device.
  virtual std::string reason() const = 0;

  /// Counts since it was opened, for the report: {"forces_sent_x", 4210}. Not real-time; from any thread.
  virtual std::vector<std::pair<std::string, long>> tally() const = 0;

  /// How it is driven, in a line: "one effect for each axis, by direction".
  virtual std::string manner() const = 0;
};

using OpenedDevice = Result<std::unique_ptr<PluggedDevice>>;

}  // namespace wale
