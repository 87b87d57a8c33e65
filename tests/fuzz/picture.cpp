// A libFuzzer target for pictures: whatever stands in one, its decoder ends in time, keeps within its memory, and gives
// heights or a reason.
//
// The input is a list of changes to a picture in one of ten formats: a byte that chooses the format, then two bytes of
// place and one of value for each change. The picture is decoded as always, by a process of its own.

#include <sys/resource.h>

#include <cstdlib>

#include "compiler/image/decoder/sandbox.hpp"
#include "compiler/image/image.hpp"
#include "tests/image/encoding.hpp"

namespace {

void demand(bool holds) {
  if (!holds) std::abort();
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const unsigned char* data, std::size_t size) {
  static const auto pictures = wale::one_of_each();
  if (size < 4) return 0;
  auto [name, bytes] = pictures[data[0] % pictures.size()];
  for (std::size_t i = 1; i + 2 < size; i += 3)
    bytes[(data[i] | std::size_t{data[i + 1]} << 8) % bytes.size()] = std::byte{data[i + 2]};
  const auto image = wale::read_height_image(bytes, name, 0);
  if (!image) {
    demand(!image.error().sentence.empty());
    demand(image.error().code == wale::Code::unreadable_image || image.error().code == wale::Code::image_size);
  }
  rusage usage{};
  getrusage(RUSAGE_CHILDREN, &usage);
  demand(1024ull * static_cast<unsigned long long>(usage.ru_maxrss) < wale::decoder::most_memory);
  return 0;
}
