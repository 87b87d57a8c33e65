#pragma once

#include <array>
#include <cstdint>

#include "runtime/device/hid_pid/report_descriptor.hpp"

namespace wale::hid {

/// The place of a number in a packet, little-endian, and the values that it may have.
struct Number {
  std::uint16_t bit = 0;  ///< from the packet's first bit; an id byte counts
  std::uint8_t bits = 0;  ///< 1 .. 32; 0: the report has no such number
  std::int64_t minimum = 0, maximum = 0;

  explicit operator bool() const { return bits != 0; }
  friend bool operator==(const Number&, const Number&) = default;
};

/// An order, such as "start": a bit of its own, or one of the values of a field for several orders.
struct Order {
  Number number;
  std::int64_t value = 0;

  explicit operator bool() const { return bool(number); }
  friend bool operator==(const Order&, const Order&) = default;
};

/// A report as a packet.
struct PacketShape {
  std::uint8_t id = 0;     ///< its first byte; 0: it has no id byte
  std::uint8_t bytes = 0;  ///< with the id; 0: the device has no such report

  explicit operator bool() const { return bytes != 0; }
  friend bool operator==(const PacketShape&, const PacketShape&) = default;
};

/// A packet of a full-speed interrupt endpoint holds no more (USB 2.0, section 5.7.3).
constexpr std::size_t most_packet_bytes = 64;

/// The reports of a device of USB's PID class, and the places of their numbers, by its descriptor. Every field exists
/// unless it is marked "may be missing".
struct PidLayout {
  struct Input : PacketShape {
    Number x, y;
    Number button;  ///< the first; may be missing
  };
  struct SetEffect : PacketShape {
    Number block_index;
    Order constant_force;  ///< the effect's type
    Number duration;
    double duration_step = 0;         ///< s per count of `duration`
    Number gain;                      ///< may be missing
    Number enable_x, enable_y;        ///< may be missing, both together
    Number direction_enable;          ///< may be missing
    std::array<Number, 2> direction;  ///< polar, the first one counts; may be missing, unless `enable_x` is
    double direction_step = 0;        ///< degrees per count of `direction`
  };
  struct SetConstantForce : PacketShape {
    Number block_index, magnitude;  ///< magnitude has both signs
    /// The counts of full force: the smaller side of the range, so that both signs are equally strong.
    std::int64_t full() const {
      return magnitude.maximum < -magnitude.minimum ? magnitude.maximum : -magnitude.minimum;
    }
  };
  struct EffectOperation : PacketShape {
    Number block_index;
    Order start, stop;
    Number loop_count;  ///< may be missing
  };
  struct DeviceControl : PacketShape {  ///< may be missing, and so may each of its orders
    Order enable_actuators, disable_actuators, stop_all, reset;
  };
  struct DeviceGain : PacketShape {  ///< may be missing
    Number gain;
  };
  struct CreateNewEffect : PacketShape {
    Order constant_force;
  };
  struct BlockLoad : PacketShape {
    Number block_index;
    Order success;
    Order full;  ///< may be missing
  };
  struct BlockFree : PacketShape {  ///< may be missing
    Number block_index;
  };
  struct Pool : PacketShape {  ///< may be missing
    Number simultaneous_effects;
  };

  struct State : PacketShape {  ///< may be missing, and so may each of its numbers
    Number block_index;
    Order effect_plays, actuators_enabled;
  };

  Input input;
  SetEffect set_effect;
  SetConstantForce set_constant_force;
  EffectOperation effect_operation;
  DeviceControl device_control;
  DeviceGain device_gain;
  CreateNewEffect create_new_effect;
  BlockLoad block_load;
  BlockFree block_free;
  Pool pool;
  State state;

  bool has_direction() const { return bool(set_effect.direction_enable) && bool(set_effect.direction[0]); }
  bool has_axes() const { return bool(set_effect.enable_x); }
};

/// Finds the reports of a force-feedback joystick by their usages. Errors: `no_force_device` if no report is of the PID
/// class; `unlike_device` if a needed field is missing, a declared range does not fit in its bits, or a packet exceeds
/// `most_packet_bytes`: "it has no Set Constant Force report (usage 0F:73)".
Result<PidLayout> find_pid_layout(const ReportDescriptor& descriptor);

}  // namespace wale::hid
