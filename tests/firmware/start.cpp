// The start of a Cortex-M4 that QEMU emulates, and its output, by semihosting.

#include <cstddef>
#include <cstdint>

extern "C" {

extern std::uint32_t stack_top, data_image, data_begin, data_end, bss_begin, bss_end;

int main();

void* memset(void* to, int value, std::size_t count) {
  auto* bytes = static_cast<volatile unsigned char*>(to);
  for (std::size_t i = 0; i < count; ++i) bytes[i] = static_cast<unsigned char>(value);
  return to;
}

void* memcpy(void* to, const void* from, std::size_t count) {
  auto* bytes = static_cast<volatile unsigned char*>(to);
  for (std::size_t i = 0; i < count; ++i) bytes[i] = static_cast<const unsigned char*>(from)[i];
  return to;
}

static void semihosting(std::uint32_t operation, const void* argument) {
  register std::uint32_t r0 __asm__("r0") = operation;
  register const void* r1 __asm__("r1") = argument;
  __asm__ volatile("bkpt 0xab" : "+r"(r0) : "r"(r1) : "memory");
}

/// Eight hexadecimal digits and a line break.
void write_number(std::uint32_t number) {
  char text[10];
  for (int i = 0; i < 8; ++i) text[i] = "0123456789abcdef"[number >> (28 - 4 * i) & 15u];
  text[8] = '\n';
  text[9] = 0;
  semihosting(0x04, text);
}

[[noreturn]] void stop() {
  semihosting(0x18, reinterpret_cast<const void*>(0x20026));
  for (;;) {
  }
}

[[noreturn]] void fault() {
  semihosting(0x04, "fault\n");
  stop();
}

[[noreturn]] void reset() {
  const std::uint32_t* from = &data_image;
  for (std::uint32_t* to = &data_begin; to < &data_end; ++to) *to = *from++;
  for (std::uint32_t* to = &bss_begin; to < &bss_end; ++to) *to = 0;
#if defined(__ARM_FP)
  auto* const access = reinterpret_cast<volatile std::uint32_t*>(0xe000ed88);
  *access = *access | 0x00f00000u;  // the coprocessor of floats
  __asm__ volatile("dsb\nisb");
#if defined(FLUSH_TO_ZERO)
  __asm__ volatile("vmsr fpscr, %0" ::"r"(0x01000000u));
#endif
#endif
  main();
  stop();
}

[[gnu::section(".vectors"), gnu::used]] void* const vectors[16] = {&stack_top,
                                                                   reinterpret_cast<void*>(reset),
                                                                   reinterpret_cast<void*>(fault),
                                                                   reinterpret_cast<void*>(fault),
                                                                   reinterpret_cast<void*>(fault),
                                                                   reinterpret_cast<void*>(fault),
                                                                   reinterpret_cast<void*>(fault)};
}
