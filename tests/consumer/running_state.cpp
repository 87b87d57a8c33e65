// Read what is going on: the state, contacts, and a snapshot for a picture.
#include <chrono>
#include <thread>
#include <wale/wale.hpp>

#include "expect.hpp"

int main() {
  const wale::Library library;
  const auto dial = library.find("detent_dial");
  wale::OpenOptions options;
  options.hand = {.mass = 0.2, .damping = 4, .stiffness = 400};
  options.motion = wale::Lateral{.amplitude = 0.1, .frequency = 2};  // in and out of the patch
  auto device = library.open_device("simulated", options);
  EXPECT(dial && device);
  wale::Stage stage(*std::move(device));
  auto patch = stage.add(dial->program);
  EXPECT(patch);
  int entered = 0, left = 0;
  stage.on_contact([&](const wale::ContactEvent& event) {
    entered += event.kind == wale::ContactKind::enter;
    left += event.kind == wale::ContactKind::leave;
  });
  EXPECT(stage.start());
  std::size_t marks = 0;
  bool was_inside = false;
  for (int frame = 0; frame < 90; ++frame) {
    std::this_thread::sleep_for(std::chrono::milliseconds(16));
    stage.poll();
    const wale::Now now = stage.now();
    was_inside = was_inside || (now.inside && now.patch && *now.patch == *patch);
    const auto picture = patch->snapshot();
    EXPECT(picture);
    marks += wale::show(picture->bank, picture->memory, {.position = now.position}).size();
  }
  EXPECT(stage.stop());
  EXPECT(entered > 0 && left > 0 && was_inside && marks > 0);
  EXPECT(!patch->snapshot() || patch->exists());
}
