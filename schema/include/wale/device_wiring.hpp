#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

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

  friend bool operator==(const DeviceWiring&, const DeviceWiring&) = default;
};

}  // namespace wale
