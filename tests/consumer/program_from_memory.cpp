// A patch program from memory, with the runtime alone; damaged bytes are an error with a code.
#include <array>
#include <wale/runtime.hpp>

#include "corduroy.hpp"
#include "expect.hpp"

int main() {
  const auto bytes = std::as_bytes(std::span(corduroy_wpp));
  const auto program = wale::Program::load(bytes);
  EXPECT(program);
  const auto damaged = wale::Program::load(bytes.first(bytes.size() / 2));
  EXPECT(!damaged && damaged.error().code == wale::Code::damaged_file);

  wale::OpenOptions options;
  options.hand = {.mass = 0.2, .damping = 4, .stiffness = 400};
  options.motion = wale::Lateral{.amplitude = 0.03, .frequency = 1};
  auto device = wale::open_device("simulated", options);
  EXPECT(device);
  wale::Stage stage(*std::move(device));
  EXPECT(stage.add(*program));
  const auto run = stage.run({.seconds = 1, .virtual_time = true});
  EXPECT(run && run->ticks_run == 900);
}
