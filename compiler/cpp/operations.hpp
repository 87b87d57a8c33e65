#pragma once

#include <cstdint>
#include <cstring>
#include <limits>

#if defined(__SSE__)
#include <xmmintrin.h>
#endif

/// The operations of runtime/machine/operations.hpp for any processor in any mode, in C++17. `wale build --emit cpp`
/// copies this file; a program that defines WALE_MACHINE_MODE promises that its threads flush subnormal numbers as the
/// machine does.
namespace wale::arithmetic {

/// Copies an object. A freestanding compiler calls std::memcpy, but knows its own.
template <class To, class From>
inline To same_bits(const From& from) {
  static_assert(sizeof(To) == sizeof from, "objects of one size");
  To to = 0;
#if defined(__GNUC__)
  __builtin_memcpy(&to, &from, sizeof to);
#else
  std::memcpy(&to, &from, sizeof to);
#endif
  return to;
}

inline std::uint32_t bits_of(float a) { return same_bits<std::uint32_t>(a); }
inline float float_of(std::uint32_t bits) { return same_bits<float>(bits); }

#if defined(WALE_MACHINE_MODE)

inline float sum(float a, float b) { return a + b; }
inline float difference(float a, float b) { return a - b; }
inline float product(float a, float b) { return a * b; }
inline float quotient(float a, float b) { return a / b; }

#else

inline constexpr std::uint32_t least_normal_bits = 0x00800000u;
/// Whether `a` is at most the least normal number in size. Compares integers, whatever the mode.
inline bool is_tiny(float a) { return (bits_of(a) & 0x7fffffffu) <= least_normal_bits; }

/// `a` with 0 for a subnormal number. A sum of normal numbers that is subnormal is exact, so this is all it needs.
inline float without_subnormals(float a) {
  return (bits_of(a) & 0x7fffffffu) < least_normal_bits ? float_of(bits_of(a) & 0x80000000u) : a;
}

/// The machine's result near the least normal number: `scaled` is the same result times 2^64, rounded once. Below the
/// least normal number after that rounding it is zero, as on x86; a processor that flushes before rounding, or that
/// rounds subnormal numbers, finds another one of the two.
inline float near_zero(float scaled) {
  const std::uint32_t sign = bits_of(scaled) & 0x80000000u;
  return float_of((bits_of(scaled) & 0x7fffffffu) < 0x20800000u ? sign : sign | least_normal_bits);
}

#if defined(__GNUC__)
__attribute__((noinline, cold))
#endif
inline float
tiny_product(float a, float b) {
  const bool a_is_smaller = (bits_of(a) & 0x7fffffffu) < (bits_of(b) & 0x7fffffffu);
  return near_zero(a_is_smaller ? (a * 0x1p64f) * b : a * (b * 0x1p64f));
}

#if defined(__GNUC__)
__attribute__((noinline, cold))
#endif
inline float
tiny_quotient(float a, float b) {
  return near_zero((a * 0x1p64f) / b);
}

inline float sum(float a, float b) { return without_subnormals(a + b); }
inline float difference(float a, float b) { return without_subnormals(a - b); }
inline float product(float a, float b) {
  const float rounded = a * b;
  return is_tiny(rounded) ? tiny_product(a, b) : rounded;
}
inline float quotient(float a, float b) {
  const float rounded = a / b;
  return is_tiny(rounded) ? tiny_quotient(a, b) : rounded;
}

#endif

/// The root digit by digit, for processors without an instruction for it.
inline float root_by_digits(float a) {
  const std::uint32_t bits = bits_of(a);
  if ((bits & 0x7f800000u) == 0 || bits == 0x7f800000u || (bits & 0x7fffffffu) > 0x7f800000u) return a;
  if ((bits & 0x80000000u) != 0) return std::numeric_limits<float>::quiet_NaN();
  // The significand times 2 or 4 to an even exponent; 25 digits of its root, the last one for rounding.
  const std::int32_t exponent = static_cast<std::int32_t>(bits >> 23) - 127;
  const std::uint32_t odd = static_cast<std::uint32_t>(exponent) & 1u;
  std::uint64_t rest = std::uint64_t{(bits & 0x007fffffu) | 0x00800000u} << (25 + odd);
  std::uint64_t root = 0;
  for (std::uint64_t digit = std::uint64_t{1} << 48; digit != 0; digit >>= 2) {
    if (rest >= root + digit) {
      rest -= root + digit;
      root = (root >> 1) + digit;
    } else {
      root >>= 1;
    }
  }
  const auto rounded = static_cast<std::uint32_t>((root + 1) >> 1);  // never half way
  const std::int32_t half = (exponent - static_cast<std::int32_t>(odd)) / 2;
  return float_of(rounded + (static_cast<std::uint32_t>(half + 126) << 23));
}

/// Correctly rounded; not-a-number below zero. Instructions instead of sqrtf, which sets errno.
inline float root(float a) {
#if defined(__SSE__)
  return _mm_cvtss_f32(_mm_sqrt_ss(_mm_set_ss(a)));
#elif defined(__GNUC__) && defined(__aarch64__)
  float found;
  __asm__("fsqrt %s0, %s1" : "=w"(found) : "w"(a));
  return found;
#elif defined(__GNUC__) && defined(__ARM_FP) && (__ARM_FP & 4)
  float found;
  __asm__("vsqrt.f32 %0, %1" : "=t"(found) : "t"(a));
  return found;
#else
  return root_by_digits(a);
#endif
}

}  // namespace wale::arithmetic
