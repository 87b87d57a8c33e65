#pragma once

#include <bit>
#include <cstdint>

#if defined(__SSE__)
#include <xmmintrin.h>
#endif

/// The operations on floats that a processor may carry out in its own way, as the machine does them: under
/// `FloatingPointMode` the processor itself flushes subnormal results to zero. Headers that `wale build --emit cpp`
/// writes have compiler/cpp/operations.hpp in its place, which gives the same bits in any mode.
namespace wale::arithmetic {

inline std::uint32_t bits_of(float a) { return std::bit_cast<std::uint32_t>(a); }
inline float float_of(std::uint32_t bits) { return std::bit_cast<float>(bits); }

inline float sum(float a, float b) { return a + b; }
inline float difference(float a, float b) { return a - b; }
inline float product(float a, float b) { return a * b; }
inline float quotient(float a, float b) { return a / b; }

/// Correctly rounded; not-a-number below zero.
inline float root(float a) {
#if defined(__SSE__)
  return _mm_cvtss_f32(_mm_sqrt_ss(_mm_set_ss(a)));  // __builtin_sqrtf would call sqrtf for errno
#else
  return __builtin_sqrtf(a);
#endif
}

}  // namespace wale::arithmetic
