// Asks for a roughness by name, puts it under the hand, and reads back what came out of the handle.
#include <cstdio>
#include <wale/wale.hpp>

namespace {

/// Prints what is wrong, and gives the program's exit status.
int failed(const wale::Error& error) {
  std::fprintf(stderr, "%s\n", wale::in_words(error).c_str());
  for (const std::string& name : error.nearest) std::fprintf(stderr, "  near: %s\n", name.c_str());
  return 1;
}

}  // namespace

int main(int argc, char** argv) {
  const char* name = argc > 1 ? argv[1] : "coarse";

  const wale::Library library;
  const auto surface = library.level("roughness", name);
  if (!surface) return failed(surface.error());
  for (const wale::Error& warning : surface->warnings)
    std::fprintf(stderr, "warning: %s\n", wale::in_words(warning).c_str());

  auto joystick = library.open_device("simulated");
  if (!joystick) return failed(joystick.error());
  wale::Stage stage(*std::move(joystick));
  auto patch = stage.add(surface->program);
  if (!patch) return failed(patch.error());
  const auto run = stage.run({.seconds = 3, .virtual_time = true});
  if (!run) return failed(run.error());

  const auto felt = wale::measure(*run, *patch, {.settling = 0.5});
  if (!felt) return failed(felt.error());
  for (const auto& level : felt->levels)
    if (level.back)
      std::printf("%s %s: %.3f N at the handle, felt as level %.2f\n", name, level.name.c_str(), felt->felt.force_rubbing.p99,
                  level.back->level);
}
