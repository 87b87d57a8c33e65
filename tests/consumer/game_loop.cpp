// A loop of the game's own: `step` on its thread, at its rate.
#include <chrono>
#include <thread>
#include <wale/wale.hpp>

#include "expect.hpp"

int main() {
  const wale::Library library;
  const auto oak = library.find("oak");
  auto device = library.open_device("simulated");
  EXPECT(oak && device);
  wale::Stage stage((*device)->profile(), {.max_force = 1});
  EXPECT(stage.add(oak->program));
  auto loop = wale::Loop::begin(stage);
  EXPECT(loop);
  float most = 0;
  for (int tick = 0; tick < 900; ++tick) {
    (*device)->elapse(1);
    const wale::Force force = loop->step((*device)->sample());
    (*device)->command(force);
    most = std::max(most, std::abs(force.x));
    if (tick % 9 == 0) std::this_thread::sleep_for(std::chrono::milliseconds(10));
  }
  EXPECT(most > 0 && most <= 1);
  EXPECT(stage.now().ticks_run == 900);
}
