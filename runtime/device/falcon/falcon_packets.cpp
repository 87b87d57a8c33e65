#include "runtime/device/falcon/falcon_packets.hpp"

#include <algorithm>

namespace wale::falcon {
namespace {

constexpr std::uint8_t first = '<', last = '>', zero = 0x41;
constexpr std::size_t status_at = 13, filler_at = 14;

/// Whether a byte is possible at index `at` of an answer. `first` is possible only at index 0, so it always begins an
/// answer.
bool may_stand(std::uint8_t byte, std::size_t at) noexcept {
  if (at == 0) return byte == first;
  if (at < status_at) return byte >= zero && byte < zero + 16;
  if (at == status_at) return byte >= zero && byte < zero + 128;
  return at == filler_at ? byte != first : byte == last;
}

}  // namespace

Packet encode(const Command& command) noexcept {
  Packet packet{};
  packet.front() = first;
  for (std::size_t i = 0; i < command.torques.size(); ++i) {
    const int torque = std::clamp<int>(command.torques[i], -most_torque, most_torque);
    for (std::size_t nibble = 0; nibble < 4; ++nibble) {
      packet[1 + 4 * i + nibble] = static_cast<std::uint8_t>(zero + (torque >> (4 * nibble) & 15));
    }
  }
  packet[status_at] = static_cast<std::uint8_t>(zero + (static_cast<int>(command.light) | int{command.keeps_homing}));
  packet[filler_at] = zero;
  packet.back() = last;
  return packet;
}

std::optional<Answer> AnswerReader::take(std::uint8_t byte) noexcept {
  if (!may_stand(byte, size_)) {
    skipped_ += static_cast<long>(size_) + (byte == first ? 0 : 1);
    size_ = 0;
    if (byte != first) return std::nullopt;
  }
  bytes_[size_++] = byte;
  if (size_ < packet_bytes) return std::nullopt;
  size_ = 0;
  Answer answer;
  for (std::size_t i = 0; i < answer.encoders.size(); ++i) {
    unsigned bits = 0;
    for (std::size_t nibble = 0; nibble < 4; ++nibble) {
      bits |= static_cast<unsigned>(bytes_[1 + 4 * i + nibble] - zero) << (4 * nibble);
    }
    answer.encoders[i] = static_cast<std::int16_t>(static_cast<std::uint16_t>(bits));
  }
  const auto status = static_cast<std::uint8_t>(bytes_[status_at] - zero);
  answer.buttons = status & 15;
  answer.homed = static_cast<std::uint8_t>(status >> 4 & 7);
  return answer;
}

std::span<const std::uint8_t> payload(std::span<const std::uint8_t> usb_packet) noexcept {
  return usb_packet.subspan(std::min<std::size_t>(2, usb_packet.size()));
}

}  // namespace wale::falcon
