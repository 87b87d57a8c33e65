#pragma once

#include <cstdint>
#include <type_traits>

namespace wale {

/// The hash FNV-1a of bytes that are taken one after another (Fowler, Noll, Vo; RFC 9923), of 32 or 64 bits. It tells
/// contents apart that differ by accident; it is no protection against somebody who wants two to be alike.
template <class Bits>
class Fnv1a {
  static_assert(std::is_same_v<Bits, std::uint32_t> || std::is_same_v<Bits, std::uint64_t>);

 public:
  constexpr void take(std::uint8_t byte) noexcept { hash_ = (hash_ ^ byte) * prime; }
  template <class Bytes>
  constexpr Fnv1a& take_all(const Bytes& bytes) noexcept {
    for (const auto byte : bytes) take(static_cast<std::uint8_t>(byte));
    return *this;
  }
  constexpr Bits hash() const noexcept { return hash_; }

 private:
  static constexpr bool is_wide = sizeof(Bits) == 8;
  static constexpr Bits prime = is_wide ? static_cast<Bits>(0x100000001b3u) : 0x01000193u;
  Bits hash_ = is_wide ? static_cast<Bits>(0xcbf29ce484222325u) : 0x811c9dc5u;
};

}  // namespace wale
