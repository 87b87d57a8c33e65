#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>

#include "runtime/device/falcon/falcon_kinematics.hpp"

namespace wale::falcon {

// The packets to and from a Falcon with Novint's firmware: 16 characters each way, namely `<`, four nibbles for each of
// three numbers, least significant first, a status, a filler and `>`. Nibbles and status have 0x41 added. libnifalcon,
// include/falcon/firmware/FalconFirmwareNovintSDK.h and src/firmware/FalconFirmwareNovintSDK.cpp.
//
// All of it is real-time: allocates nothing, takes no lock, makes no system call, does not throw.

constexpr std::size_t packet_bytes = 16;
using Packet = std::array<std::uint8_t, packet_bytes>;

/// Steps of a motor's torque, each within `-most_torque .. most_torque`; positive ones fold the arms in.
using Torques = std::array<std::int16_t, 3>;
constexpr std::int16_t most_torque = 4096;

enum class Light : std::uint8_t { none = 0, red = 2, green = 4, blue = 8 };

struct Command {
  Torques torques{};         ///< clamped to +-most_torque
  bool keeps_homing = true;  ///< the encoders search their zeros, and report them
  Light light = Light::none;
};
Packet encode(const Command& command) noexcept;

struct Answer {
  Encoders encoders{};
  std::uint8_t buttons = 0;  ///< bits: right, forward, middle, left
  std::uint8_t homed = 0;    ///< bits: top, right, left encoder has found its zero

  bool is_homed() const noexcept { return homed == 7; }
  friend bool operator==(const Answer&, const Answer&) = default;
};

/// Finds answers in a stream of bytes, which may arrive in pieces of any length. Skips and counts bytes that belong to
/// no answer.
class AnswerReader {
 public:
  /// The answer that `byte` completes; nothing while none is complete.
  std::optional<Answer> take(std::uint8_t byte) noexcept;

  long skipped() const noexcept { return skipped_; }  ///< bytes

 private:
  Packet bytes_{};
  std::size_t size_ = 0;
  long skipped_ = 0;
};

/// The bytes of the serial line in a packet of the USB chip, without its two bytes of line status.
std::span<const std::uint8_t> payload(std::span<const std::uint8_t> usb_packet) noexcept;

}  // namespace wale::falcon
