// Find a material by name and feel it; a misspelt name brings the nearest ones.
#include <algorithm>
#include <wale/wale.hpp>

#include "expect.hpp"

int main() {
  const wale::Library library;
  const auto misspelt = library.find("corduory");
  EXPECT(!misspelt && misspelt.error().code == wale::Code::unknown_name);
  EXPECT(std::ranges::find(misspelt.error().nearest, "corduroy") != misspelt.error().nearest.end());

  const auto corduroy = library.find("corduroy");
  EXPECT(corduroy);
  auto device = library.open_device("simulated");
  EXPECT(device);
  const double step = (*device)->profile().position_step();
  wale::Stage stage(*std::move(device));
  const auto patch = stage.add(corduroy->program);
  EXPECT(patch);
  const auto run = stage.run({.seconds = 3, .virtual_time = true});
  EXPECT(run);
  const auto felt = wale::measure(run->record, {.position_step = step, .settling = 0.5});
  EXPECT(felt.force_rubbing.p99 > 1.8f && felt.force_rubbing.p99 < 2.1f);  // 1.934 N

  // A material with a picture: its decoder is found where Wale is installed.
  const auto slate = library.find("slate");
  EXPECT(slate);
}
