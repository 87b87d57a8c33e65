#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>

#include "runtime/device/hid_pid/force_gate.hpp"
#include "runtime/device/hid_pid/pid_layout.hpp"

namespace wale::hid {

// Reports of a force-feedback joystick as bytes and back. All of it is real-time: allocates nothing, takes no lock,
// makes no system call, does not throw.

struct Packet {
  std::array<std::uint8_t, most_packet_bytes> bytes{};
  std::uint8_t size = 0;

  std::span<const std::uint8_t> view() const noexcept { return {bytes.data(), size}; }
};

/// The duration of an effect that plays until it is stopped.
constexpr double endless = 0;

/// An effect of the type constant force, without its force.
struct ConstantEffect {
  std::uint8_t block_index = 0;
  /// s, or `endless`; starting it again begins the time anew. Clamped between one count and the field's largest value.
  double duration = endless;
  /// Degrees from the direction away from the user, clockwise; a force of magnitude m is m sin along x and -m cos along
  /// y (HID PID 1.0, section 3.1.2.2.1: y points to the user). Ignored unless `by_direction`.
  double direction = 0;
  bool by_direction = true;
  bool on_x = false, on_y = false;  ///< the axes that it pushes, unless `by_direction`
};

Packet encode_set_effect(const PidLayout& layout, const ConstantEffect& effect) noexcept;

/// The only packet that says how hard an effect pushes.
Packet encode_constant_force(const PidLayout& layout, std::uint8_t block_index, Magnitude magnitude) noexcept;

/// What a device makes of an effect's direction: the nearest that its field can say, in degrees.
double told_direction(const PidLayout& layout, double direction) noexcept;

/// Starts an effect: once, or repeated without end (`endlessly`).
Packet encode_start(const PidLayout& layout, std::uint8_t block_index, bool endlessly) noexcept;
Packet encode_stop(const PidLayout& layout, std::uint8_t block_index) noexcept;

/// One of `layout.device_control`'s orders.
Packet encode_device_control(const PidLayout& layout, const Order& order) noexcept;
/// Sets the device's gain to its maximum.
Packet encode_full_gain(const PidLayout& layout) noexcept;
Packet encode_create_constant_force(const PidLayout& layout) noexcept;
Packet encode_block_free(const PidLayout& layout, std::uint8_t block_index) noexcept;

/// The content of an input report. Decoding gives nothing for a packet that is too short or of another report.
struct InputState {
  std::int64_t x = 0, y = 0;  ///< clamped to the ranges of `layout.input`: some devices go a count beyond
  bool button = false;
};
std::optional<InputState> decode_input(const PidLayout& layout, std::span<const std::uint8_t> bytes) noexcept;

struct BlockLoadAnswer {
  enum class Status { pending, loaded, full, failed } status = Status::pending;
  std::uint8_t block_index = 0;  ///< 1 .. 255 if it was loaded
};
/// `pending`: the status is 0, because the device has not finished yet.
std::optional<BlockLoadAnswer> decode_block_load(const PidLayout& layout, std::span<const std::uint8_t> bytes) noexcept;

/// The content of a PID State report, which a device sends unasked. Fields that its report lacks are empty.
struct DeviceState {
  std::optional<std::uint8_t> block_index;  ///< of the effect that it is about
  std::optional<bool> effect_plays;
  std::optional<bool> actuators_enabled;
};
std::optional<DeviceState> decode_state(const PidLayout& layout, std::span<const std::uint8_t> bytes) noexcept;

/// How many effects can play at once, from the pool report.
std::optional<std::int64_t> decode_pool(const PidLayout& layout, std::span<const std::uint8_t> bytes) noexcept;

}  // namespace wale::hid
