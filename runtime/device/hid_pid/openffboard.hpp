#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>

#include "runtime/device/hid_pid/pid_packets.hpp"
#include "runtime/device/hid_pid/report_descriptor.hpp"

namespace wale::hid {

// OpenFFBoard's own report, which asks its firmware about its axes: 25 bytes each way. Source: its repository,
// Firmware/FFBoard/Inc/HidCommandInterface.h, Axis.h (Axis_commands) and UserExtensions/Inc/usb_hid_ffb_desc.h.

namespace openffboard {

constexpr std::uint8_t report_id = 0xa1;
constexpr std::size_t report_bytes = 25;

enum class Type : std::uint8_t {
  write = 0,
  request = 1,  ///< a request, and also its answer
  info = 2,
  write_address = 3,
  request_address = 4,
  acknowledged = 10,
  not_found = 13,
  notification = 14,
  error = 15
};

constexpr std::uint16_t axis_class = 0xa01;  ///< its instances are the axes, x first
constexpr std::uint32_t torque_command = 0x0d, position_command = 0x0e;

struct Message {
  Type type = Type::request;
  std::uint16_t class_id = axis_class;
  std::uint8_t instance = 0;
  std::uint32_t command = 0;
  std::int64_t data = 0, address = 0;

  friend bool operator==(const Message&, const Message&) = default;
};

/// Whether a device's descriptor has this report in both directions, with its numbers at the expected places.
bool has_reports(const ReportDescriptor& descriptor);

/// Real-time, as the other packets are.
Packet encode(const Message& message) noexcept;
/// Empty for a packet that is too short or of another report.
std::optional<Message> decode(std::span<const std::uint8_t> bytes) noexcept;

}  // namespace openffboard

/// What a device's firmware reports about its own axes x and y.
struct Telemetry {
  std::array<std::optional<std::int32_t>, 2> torque;    ///< the newest, in 32767ths of its full torque
  std::array<std::optional<std::int32_t>, 2> position;  ///< the newest, in 32767ths of half its range
  std::array<std::int32_t, 2> most_torque{};            ///< the largest size of any reported torque
  long asked = 0, answered = 0;
  long refused = 0;  ///< answers that the firmware does not know the request
};

}  // namespace wale::hid
