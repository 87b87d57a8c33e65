#include "wale/device_wiring.hpp"

#include <array>
#include <cstdio>

namespace wale {
namespace {

std::optional<std::uint16_t> four_digits(std::string_view text) {
  std::uint16_t number = 0;
  for (const char digit : text) {
    int value = 0;
    if (digit >= '0' && digit <= '9')
      value = digit - '0';
    else if (digit >= 'a' && digit <= 'f')
      value = digit - 'a' + 10;
    else if (digit >= 'A' && digit <= 'F')
      value = digit - 'A' + 10;
    else
      return std::nullopt;
    number = static_cast<std::uint16_t>(number << 4 | value);
  }
  return number;
}

}  // namespace

std::optional<UsbNumbers> read_usb_numbers(std::string_view text) {
  if (text.size() != 9 || text[4] != ':') return std::nullopt;
  const auto vendor = four_digits(text.substr(0, 4)), product = four_digits(text.substr(5));
  if (!vendor || !product) return std::nullopt;
  return UsbNumbers{*vendor, *product};
}

std::string in_words(const UsbNumbers& numbers) {
  std::array<char, 16> text;
  std::snprintf(text.data(), text.size(), "%04x:%04x", numbers.vendor, numbers.product);
  return text.data();
}

std::string in_words(const SignedAxis& axis) {
  return std::string(axis.sign < 0 ? "-" : "") + (axis.axis == 0 ? "x" : "y");
}

AxisResponse DeviceWiring::response_of(std::size_t axis, double peak) const {
  return {gain[axis], response[2 * axis], response[2 * axis + 1], offset[axis], peak};
}

DeviceWiring DeviceWiring::with_motors(const std::array<SignedAxis, 2>& turned) const {
  DeviceWiring other = *this;
  other.motors = turned;
  for (std::size_t to = 0; to < 2; ++to) {
    const std::size_t from = motors[0].axis == turned[to].axis ? 0 : 1;
    const bool is_reversed = motors[from].sign != turned[to].sign;
    other.gain[to] = gain[from];
    other.offset[to] = is_reversed ? -offset[from] : offset[from];
    other.response[2 * to] = response[2 * from + (is_reversed ? 1 : 0)];
    other.response[2 * to + 1] = response[2 * from + (is_reversed ? 0 : 1)];
  }
  return other;
}

}  // namespace wale
