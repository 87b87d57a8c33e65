// A libFuzzer target for pictures: whatever stands in one, its decoder ends in time, keeps within its memory, and gives
// heights or a reason, and colours with their areas or a reason.
//
// The input is a list of changes to a picture in one of ten formats: a byte that chooses the format, then two bytes of
// place and one of value for each change. The picture is decoded as always, by a process of its own.

#include <sys/resource.h>

#include <cstdlib>

#include "compiler/areas/colour_areas.hpp"
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
  const auto is_reason = [](const wale::Error& error) {
    return !error.sentence.empty() &&
           (error.code == wale::Code::unreadable_image || error.code == wale::Code::image_size);
  };
  const auto image = wale::read_height_image(bytes, name, 0);
  demand(image || is_reason(image.error()));
  const auto colours = wale::read_colour_image(bytes, name);
  demand(colours || is_reason(colours.error()));
  if (colours) {
    // Whatever is in it, each pixel has one of the colours or none, and slivers are found in time.
    const auto areas = wale::colour_areas(*colours, {0xc04020, 0x2060c0, 0xffffff}, 0.15);
    demand(areas.areas.size() == colours->pixels.size());
    for (const wale::AreaId each : areas.areas) demand(each < 3 || each == wale::nobody);
    const auto sliver = wale::find_sliver(areas, 2, 1 + data[1] % 16);
    demand(!sliver || (sliver->area < 2 && sliver->place.x < areas.width && sliver->place.y < areas.height));
  }
  rusage usage{};
  getrusage(RUSAGE_CHILDREN, &usage);
  demand(1024ull * static_cast<unsigned long long>(usage.ru_maxrss) < wale::decoder::most_memory);
  return 0;
}
