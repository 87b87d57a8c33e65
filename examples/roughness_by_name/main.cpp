// Asks for a roughness by name, puts it under the hand, and reads back what came out of the handle.
#include <cstdio>
#include <wale/felt.hpp>
#include <wale/library.hpp>
#include <wale/stage.hpp>

int main(int argc, char** argv) {
  const char* name = argc > 1 ? argv[1] : "coarse";

  const wale::Library library;
  const auto surface = library.level("roughness", name);
  if (!surface) {
    std::fprintf(stderr, "%s\n", wale::in_words(surface.error()).c_str());
    return 1;
  }

  const auto joystick = library.simulated_joystick();
  wale::Stage stage(*joystick);
  auto patch = stage.add(*surface);
  if (!patch) {
    std::fprintf(stderr, "%s\n", wale::in_words(patch.error()).c_str());
    return 1;
  }
  const auto run = stage.run({.seconds = 3, .virtual_time = true});
  if (!run) {
    std::fprintf(stderr, "%s\n", wale::in_words(run.error()).c_str());
    return 1;
  }

  const auto felt = wale::measure(run->record, {.position_step = joystick->profile().position_step(),
                                                .predicted_amplitude = wale::predicted_amplitude(*patch->bank()),
                                                .settling = 0.5});
  for (const auto& level : wale::levels_back(*patch->bank(), felt))
    if (level.back)
      std::printf("%s %s: %.3f N at the handle, felt as level %.2f\n", name, level.name.c_str(), felt.force_rubbing.p99,
                  level.back->level);
}
