#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "wale/force_response.hpp"

namespace wale {

/// The vendor and product numbers of a USB device.
struct UsbNumbers {
  std::uint16_t vendor = 0, product = 0;

  friend bool operator==(const UsbNumbers&, const UsbNumbers&) = default;
};

/// Reads "1209:ffb0", four hexadecimal digits each; empty for any other text.
std::optional<UsbNumbers> read_usb_numbers(std::string_view text);
std::string in_words(const UsbNumbers& numbers);

/// One of a device's own two axes, as it is or reversed.
struct SignedAxis {
  int axis = 0;  ///< 0: its x, 1: its y
  int sign = 1;  ///< or -1

  friend bool operator==(const SignedAxis&, const SignedAxis&) = default;
};

/// "x", "-y"
std::string in_words(const SignedAxis& axis);

/// The hardware of a declaration, and how it stands on the desk. A device's own axes are those that its driver reports;
/// by its standard x is to the right and y away from the user. A declaration turns them if a device was built
/// differently or stands differently. No program depends on any of this.
struct DeviceWiring {
  static constexpr double least_gain = 0.1, most_gain = 10;

  std::vector<UsbNumbers> usb;
  bool is_generic = false;                       ///< stands for every USB device that no other declaration names
  std::array<SignedAxis, 2> axes{{{0}, {1}}};    ///< of its positions: those that grow to the right, and away
  std::array<SignedAxis, 2> motors{{{0}, {1}}};  ///< of its forces: those that push to the right, and away
  /// N at the handle for each commanded N, to the right and away; least_gain .. most_gain.
  std::array<double, 2> gain{1, 1};
  /// How the force departs from that gain, by `Way`; and N without a command, to the right and away. Only a declaration
  /// of one single device has these: files of devices that others share cannot hold them.
  std::array<ForceResponse, 4> response{};
  std::array<double, 2> offset{};

  /// Whether a force is commanded otherwise than by gains.
  bool is_corrected() const { return response != std::array<ForceResponse, 4>{} || offset != std::array<double, 2>{}; }
  /// The force of an axis, 0 or 1, of a device whose force is `peak` N, above zero.
  AxisResponse response_of(std::size_t axis, double peak) const;
  /// The same hardware whose motors push where `turned` says. Each motor keeps its gain and its response.
  DeviceWiring with_motors(const std::array<SignedAxis, 2>& turned) const;

  friend bool operator==(const DeviceWiring&, const DeviceWiring&) = default;
};

}  // namespace wale
