// A level of roughness that a slider changes while it is felt.
#include <chrono>
#include <thread>
#include <wale/wale.hpp>

#include "expect.hpp"

int main() {
  const wale::Library library;
  EXPECT(!library.level("roughness", "2"));
  const auto coarse = library.level("roughness", "coarse");
  EXPECT(coarse);
  const auto corduroy = library.find("corduroy");
  EXPECT(corduroy);
  auto device = library.open_device("simulated");
  EXPECT(device);
  wale::Stage stage(*std::move(device));
  auto patch = stage.add(corduroy->program);
  EXPECT(patch && stage.start());
  for (int i = 0; i <= 10; ++i) {
    EXPECT(patch->set("wale", 0.002f + 0.0002f * static_cast<float>(i)));
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  }
  EXPECT(!patch->set("whale", 0.002f));
  EXPECT(patch->replace(coarse->program));
  EXPECT(stage.stop());
}
