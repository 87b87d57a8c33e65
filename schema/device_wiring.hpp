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

/// Reads "1209:ffb0", four hexadecimal digits each; nothing for any other text.
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

/// Which hardware a declaration is about, and how it lies on the desk. A device's own axes are those that its driver
/// reports: x to the right and y away from the user, as its standard says. A declaration turns them where a device was
/// built or stands differently. No program depends on any of it.
struct DeviceWiring {
  static constexpr double least_gain = 0.1, most_gain = 10;

  std::vector<UsbNumbers> usb;
  bool is_generic = false;                       ///< stands for every USB device that no other declaration is about
  std::array<SignedAxis, 2> axes{{{0}, {1}}};    ///< of its positions: those that grow to the right, and away
  std::array<SignedAxis, 2> motors{{{0}, {1}}};  ///< of its forces: those that push to the right, and away
  /// N at the handle for each N that is commanded, to the right and away; least_gain .. most_gain.
  std::array<double, 2> gain{1, 1};

  friend bool operator==(const DeviceWiring&, const DeviceWiring&) = default;
};

}  // namespace wale
