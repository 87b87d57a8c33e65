// A game's own loop: a thread of the game reads the stick, asks Wale for the force, and sends it, 900 times a second,
// while the game moves a surface at 60 Hz.
#include <algorithm>
#include <atomic>
#include <chrono>
#include <cstdio>
#include <thread>
#include <wale/wale.hpp>

int main() {
  const wale::Library library;
  auto stick = library.open_device("simulated");  // stands for the game's own driver
  const auto wood = library.find("oak");
  if (!stick || !wood) return 1;
  wale::Device& device = **stick;

  wale::Stage stage(device.profile());  // without a device: the game serves the ticks
  auto raft = stage.add(wood->program, {.size = wale::PatchSize{0.06f, 0.06f, 0.005f}});
  auto loop = wale::Loop::begin(stage);
  if (!raft || !loop) return 1;

  std::atomic<bool> plays = true;
  float greatest = 0;
  std::thread haptics([&] {
    const auto period = std::chrono::duration<double>(1 / device.profile().rate);
    auto next = std::chrono::steady_clock::now();
    while (plays) {
      device.elapse(1);
      const wale::Force force = loop->step(device.sample());  // all guards are in it
      device.command(force);
      greatest = std::max({greatest, std::abs(force.x), std::abs(force.y)});
      std::this_thread::sleep_until(next += std::chrono::duration_cast<std::chrono::steady_clock::duration>(period));
    }
    device.command(wale::Force(0));
  });
  for (int frame = 0; frame < 60; ++frame) {
    if (!raft->move({0.01f * static_cast<float>(frame) / 60, 0})) return 1;
    std::this_thread::sleep_for(std::chrono::milliseconds(16));
  }
  plays = false;
  haptics.join();
  std::printf("%ld ticks, at most %.2f N\n", stage.now().ticks_run, greatest);
  return greatest > 0 ? 0 : 1;
}
