#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace wale {

/// What a USB device says that it is: vendor and product.
struct UsbNumbers {
  std::uint16_t vendor = 0, product = 0;

  friend bool operator==(const UsbNumbers&, const UsbNumbers&) = default;
};

/// "1209:ffb0", four hexadecimal digits each; anything else is none.
std::optional<UsbNumbers> read_usb_numbers(std::string_view text);
std::string in_words(const UsbNumbers& numbers);

/// One of a device's own two axes, as it is or the other way round.
struct SignedAxis {
  int axis = 0;  ///< 0: its x, 1: its y
  int sign = 1;  ///< or -1

  friend bool operator==(const SignedAxis&, const SignedAxis&) = default;
};

/// "x", "-y"
std::string in_words(const SignedAxis& axis);

/// Which devices a declaration is about, and how one that is plugged in lies on the desk. Its own axes are those that
/// its driver tells of, x to the right and y away from the user as its kind's standard says; where it was built, or
/// stands, otherwise, the declaration says so. No program depends on any of it.
struct DeviceWiring {
  std::vector<UsbNumbers> usb;
  bool is_generic = false;                       ///< stands for all that no other declaration is about
  std::array<SignedAxis, 2> axes{{{0}, {1}}};    ///< of its positions: those that grow to the right, and away
  std::array<SignedAxis, 2> motors{{{0}, {1}}};  ///< of its forces: those that push to the right, and away
  std::array<double, 2> gain{1, 1};  ///< N at the handle for each N that is commanded, to the right and away

  friend bool operator==(const DeviceWiring&, const DeviceWiring&) = default;
};

}  // namespace wale
