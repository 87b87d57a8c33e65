#pragma once

#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "schema/patch_program_format.hpp"
#include "schema/sentence.hpp"
#include "wale/instruction.hpp"

namespace wale::patch_program_format {

/// Reads little-endian values from one part of a file. Never reads past its end. Every function fails with
/// `damaged_file`, thrown as `Error`; its place is the part and the byte in it.
class ByteReader {
 public:
  ByteReader(std::string name, std::span<const std::byte> bytes) : name_(std::move(name)), bytes_(bytes) {}

  std::uint8_t u8() { return number<std::uint8_t>(); }
  std::uint16_t u16() { return number<std::uint16_t>(); }
  std::uint32_t u32() { return number<std::uint32_t>(); }
  std::uint64_t u64() { return number<std::uint64_t>(); }
  float f32() { return std::bit_cast<float>(u32()); }
  double f64() { return std::bit_cast<double>(u64()); }

  /// A figure that must be finite; `what` names it in the error.
  float finite_f32(std::string_view what) { return finite(f32(), what); }
  double finite_f64(std::string_view what) { return finite(f64(), what); }

  bool boolean(std::string_view what) {
    const std::uint8_t value = u8();
    if (value > 1) damaged(" holds ", int{value}, " for ", what, ", expected 0 or 1");
    return value == 1;
  }

  std::string text(std::string_view what) {
    const std::uint32_t length = u32();
    if (length > longest_text) {
      damaged(" claims ", length, " bytes for ", what, "; texts have at most ", longest_text);
    }
    need(length);
    const auto* first = reinterpret_cast<const char*>(bytes_.data() + position_);
    position_ += length;
    std::string text(first, length);
    if (text.find('\0') != std::string::npos) damaged(" has a NUL byte inside ", what);
    return text;
  }

  /// A number of things, each at least `least_bytes` long. Fails if the rest of the part is too short for them.
  std::uint32_t count(std::size_t least_bytes, std::string_view what) {
    const std::uint32_t count = u32();
    if (count > remaining() / least_bytes) {
      damaged(" claims ", count, " ", what, " but has only ", remaining(), " bytes for them");
    }
    return count;
  }

  std::vector<Instruction> code() {
    std::vector<Instruction> code(count(8, "instructions"));
    for (Instruction& instruction : code) instruction = decode(u64());
    return code;
  }

  /// The next bytes as they are.
  std::span<const std::byte> bytes(std::size_t size) {
    need(size);
    position_ += size;
    return bytes_.subspan(position_ - size, size);
  }

  std::size_t remaining() const { return bytes_.size() - position_; }

  /// Fails at the present byte. The sentence is the part's name, then `parts`.
  template <typename... Parts>
  [[noreturn]] void damaged(const Parts&... parts) const {
    throw Error{.code = Code::damaged_file,
                .sentence = sentence(name_, parts...),
                .place = {.name = name_, .number = position_}};
  }

  void finish() const {
    if (remaining() != 0) damaged(" has ", remaining(), " bytes after its end");
  }

 private:
  void need(std::size_t size) const {
    if (size > remaining()) damaged(" ends early: it needs ", size, " more bytes and has ", remaining());
  }

  template <typename Unsigned>
  Unsigned number() {
    need(sizeof(Unsigned));
    Unsigned value = 0;
    for (std::size_t i = 0; i < sizeof(Unsigned); ++i) {
      value = static_cast<Unsigned>(value | std::to_integer<Unsigned>(bytes_[position_ + i]) << 8 * i);
    }
    position_ += sizeof(Unsigned);
    return value;
  }

  template <typename Float>
  Float finite(Float value, std::string_view what) const {
    if (!std::isfinite(value)) damaged(" holds ", value, " for ", what, ", expected a finite number");
    return value;
  }

  std::string name_;
  std::span<const std::byte> bytes_;
  std::size_t position_ = 0;
};

}  // namespace wale::patch_program_format
