// A libFuzzer target for the reports of a terminal. Any bytes, split in any way, are reports or are skipped. Each
// report is in range, is the same when the bytes are repeated, and has a place that can be drawn.

#include <cmath>
#include <cstdlib>

#include "runtime/device/pointer/pointer_picture.hpp"
#include "runtime/device/pointer/terminal_reports.hpp"

namespace {

void demand(bool holds) {
  if (!holds) std::abort();
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const unsigned char* data, std::size_t size) {
  using namespace wale::pointer;
  TerminalReader reader, again;
  for (const unsigned char byte : {0x1b, 0x5b, 0x3c, 0x31}) again.take(byte);  // in the middle of another report
  again.take(0x18);                                                            // which is cancelled
  for (std::size_t i = 0; i < size; ++i) {
    const auto report = reader.take(data[i]);
    demand(report == again.take(data[i]));
    if (!report) continue;
    if (const auto* mouse = std::get_if<MouseReport>(&*report)) {
      demand(mouse->x >= 1 && mouse->y >= 1 && mouse->x <= 1'000'000 && mouse->y <= 1'000'000);
      const WorkspaceView view(0.2, mouse->x % 300, mouse->y % 100, 2);
      const glm::dvec2 place = view.place({mouse->x - 0.5, mouse->y - 0.5});
      demand(std::isfinite(place.x) && std::isfinite(place.y));
      if (i + 1 == size) demand(!draw({0.2, {0.1, 0.1}, place, {1, 2}, 10}, view).empty());
    } else if (const auto* extent = std::get_if<SizeReport>(&*report)) {
      demand(extent->width > 0 && extent->height > 0);
    }
  }
  return 0;
}
