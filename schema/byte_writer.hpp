#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

#include "schema/patch_program_format.hpp"
#include "wale/instruction.hpp"

namespace wale::patch_program_format {

/// Appends little-endian values, whatever the machine's own order.
class ByteWriter {
 public:
  template <typename Unsigned>
  void number(Unsigned value) {
    for (std::size_t i = 0; i < sizeof(Unsigned); ++i) bytes_.push_back(static_cast<std::byte>(value >> 8 * i & 0xff));
  }
  void u8(std::uint8_t value) { number(value); }
  void u16(std::uint16_t value) { number(value); }
  void u32(std::size_t value) { number(static_cast<std::uint32_t>(value)); }
  void u64(std::uint64_t value) { number(value); }
  void f32(float value) { number(std::bit_cast<std::uint32_t>(value)); }
  void f64(double value) { number(std::bit_cast<std::uint64_t>(value)); }

  void text(std::string_view text) {
    u32(text.size());
    for (const char c : text) bytes_.push_back(static_cast<std::byte>(c));
  }

  void code(std::span<const Instruction> code) {
    u32(code.size());
    for (const Instruction& instruction : code) u64(encode(instruction));
  }

  void bytes(std::span<const std::byte> bytes) {
    for (const std::byte each : bytes) bytes_.push_back(each);
  }
  void pad() { bytes_.resize(align(bytes_.size())); }

  /// The same in a row: `out << x << y`.
  ByteWriter& operator<<(std::uint8_t value) { return number(value), *this; }
  ByteWriter& operator<<(std::uint32_t value) { return number(value), *this; }
  ByteWriter& operator<<(std::uint64_t value) { return number(value), *this; }
  ByteWriter& operator<<(float value) { return f32(value), *this; }
  ByteWriter& operator<<(double value) { return f64(value), *this; }
  ByteWriter& operator<<(std::string_view value) { return text(value), *this; }
  ByteWriter& operator<<(std::span<const std::byte> value) { return bytes(value), *this; }

  std::vector<std::byte>& result() { return bytes_; }
  const std::vector<std::byte>& result() const { return bytes_; }

 private:
  std::vector<std::byte> bytes_;
};

}  // namespace wale::patch_program_format

namespace wale {
using patch_program_format::ByteWriter;
}
