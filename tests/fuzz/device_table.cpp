// A libFuzzer target for tables of declared devices. Any bytes are refused with a reason, or are read and written back
// unchanged. Without a seed, it starts with the built-in table.

#include "schema/device_table.hpp"

#include <algorithm>
#include <cstdlib>
#include <span>
#include <vector>

#include "runtime/device/shipped_devices.hpp"

extern "C" std::size_t LLVMFuzzerMutate(std::uint8_t* data, std::size_t size, std::size_t most);

extern "C" std::size_t LLVMFuzzerCustomMutator(std::uint8_t* data, std::size_t size, std::size_t most, unsigned) {
  const auto shipped = wale::shipped_device_table();
  if (size < 16 && shipped.size() <= most) {
    std::ranges::copy(shipped, reinterpret_cast<std::byte*>(data));
    size = shipped.size();
  }
  return LLVMFuzzerMutate(data, size, most);
}

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const auto bytes = std::as_bytes(std::span(data, size));
  const auto read = wale::read_device_table(bytes);
  if (!read) {
    if (read.error().sentence.empty()) std::abort();
    return 0;
  }
  if (!std::ranges::equal(wale::write_device_table(*read), bytes)) std::abort();
  return 0;
}
