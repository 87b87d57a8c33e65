// List and open devices; errors have a code, a place and the nearest names.
#include <algorithm>
#include <wale/wale.hpp>

#include "expect.hpp"

int main() {
  const auto all = wale::devices();
  EXPECT(std::ranges::any_of(all, [](const auto& each) { return each.spelling == "simulated:falcon"; }));
  const auto falcon = wale::open_device("simulated:falcon");
  EXPECT(falcon && (*falcon)->profile().name == "falcon");
  const auto unknown = wale::open_device("simulated:falkon");
  EXPECT(!unknown && unknown.error().code == wale::Code::unknown_device);

  const wale::Library library;
  const auto other = library.find("corduroy", {.device = "falcon"});
  EXPECT(other);
  auto sandpaper = library.open_device("simulated:sandpaper");
  EXPECT(sandpaper);
  wale::Stage stage(*std::move(sandpaper));
  const auto refused = stage.add(other->program);
  EXPECT(!refused && refused.error().code == wale::Code::other_device);
}
