#pragma once

#include <cstdint>

#if defined(__SSE__)
#include <xmmintrin.h>
#endif

namespace wale {

/// During its lifetime the thread rounds to nearest, traps no exception and flushes denormals to zero, because an
/// operation on a denormal can cost a hundred times as much. The destructor restores the host's mode and sticky flags.
///
/// On processors other than x86 and 64-bit ARM it does nothing. Code that computes under it must be in a separate
/// function that is not inlined, because the compiler does not know that arithmetic depends on the mode.
class FloatingPointMode {
 public:
#if defined(__SSE__)
  FloatingPointMode() noexcept : host_(_mm_getcsr()) { _mm_setcsr(all_masked | flush_to_zero | denormals_are_zero); }
  ~FloatingPointMode() { _mm_setcsr(host_); }

 private:
  static constexpr unsigned all_masked = 0x1f80, flush_to_zero = 0x8000, denormals_are_zero = 0x0040;
  unsigned host_;
#elif defined(__aarch64__)
  FloatingPointMode() noexcept {
    asm volatile("mrs %0, fpcr" : "=r"(host_));
    asm volatile("msr fpcr, %0" ::"r"(flush_to_zero));
  }
  ~FloatingPointMode() { asm volatile("msr fpcr, %0" ::"r"(host_)); }

 private:
  static constexpr std::uint64_t flush_to_zero = std::uint64_t{1} << 24;
  std::uint64_t host_;
#else
  FloatingPointMode() noexcept {}
  ~FloatingPointMode() {}
#endif

 public:
  FloatingPointMode(const FloatingPointMode&) = delete;
  FloatingPointMode& operator=(const FloatingPointMode&) = delete;
};

}  // namespace wale
