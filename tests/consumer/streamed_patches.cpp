// Many patches come and go while the hand feels them.
#include <chrono>
#include <deque>
#include <thread>
#include <wale/wale.hpp>

#include "expect.hpp"

int main() {
  const wale::Library library;
  const auto one = library.level("roughness", "0.8");
  const auto other = library.level("roughness", "0.3");
  auto device = library.open_device("simulated");
  EXPECT(one && other && device);
  wale::Stage stage(*std::move(device));
  std::deque<wale::Patch> patches;
  const auto add = [&](int number) {
    const glm::vec2 at{0.001f * static_cast<float>(number % 100 - 50),
                       0.001f * static_cast<float>(number / 100 % 10 - 5)};
    auto patch = stage.add((number % 2 ? one : other)->program, {.at = at, .size = wale::PatchSize{0.002f, 0.002f, 0}});
    if (patch) patches.push_back(*patch);
    return static_cast<bool>(patch);
  };
  for (int i = 0; i < 1000; ++i) EXPECT(add(i));
  EXPECT(stage.start());
  for (int i = 1000; i < 3000; ++i) {
    EXPECT(patches.front().remove());
    patches.pop_front();
    EXPECT(add(i));
    if (i % 100 == 0) std::this_thread::sleep_for(std::chrono::milliseconds(10));
  }
  EXPECT(stage.size() == 1000);
  const auto run = stage.stop();
  EXPECT(run && run->ticks_run > 0);
}
