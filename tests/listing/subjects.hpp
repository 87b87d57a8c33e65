#pragma once

#include <stdexcept>
#include <string>
#include <vector>

#include "tests/listing/opening.hpp"
#include "tests/machine/random_program.hpp"
#include "wale/program.hpp"

namespace wale::listing {

/// A program; its C++ has a namespace of its own, such as `wale_patch_m12`.
struct Subject {
  std::string what;
  Program program;
};

/// Materials of the library (see `shipped_files`), a few of each file of library/sandpaper, and random programs.
inline std::vector<Subject> subjects() {
  constexpr unsigned random_programs = 50;
  std::vector<Subject> subjects;
  const auto add = [&](std::string what, PatchProgram program) {
    program.material = "m" + std::to_string(subjects.size());
    auto loaded = Program::load(std::move(program));
    if (!loaded) throw std::runtime_error(what + ": " + in_words(loaded.error()));
    subjects.push_back({std::move(what), *loaded});
  };
  const auto add_file = [&](const std::string& path, std::size_t most) {
    const File file(path);
    for (const auto& material : materials_of(file.opened))
      if (most-- > 0)
        add(path + " " + material, file.program(material).description());
      else
        break;
  };
  for (const auto& path : shipped_files()) add_file(path, 100);
  for (const char* stimuli :
       {"chapter4", "chapter5", "textures_version2", "perlin", "jitter", "fractal", "triangle_wave"})
    add_file((library / "sandpaper" / (std::string(stimuli) + ".wale")).string(), 2);
  for (const char* stimuli : {"dynamics", "prototypes"})
    add_file((library / "sandpaper" / (std::string(stimuli) + ".wale")).string(), 100);
  // A pad, which vibrates, with a position and without one.
  const File corduroy((library / "fabric" / "corduroy.wale").string(), "touch_pad");
  add("corduroy on a touch pad", corduroy.program("corduroy").description());
  const File oak((library / "wood" / "oak.wale").string(), "gamepad");
  add("oak on a gamepad", oak.program("oak").description());
  for (unsigned seed = 0; seed < random_programs; ++seed) {
    PatchProgram program = example::RandomProgram(seed).make();
    if (seed % 2 == 0) {  // subnormal constants and bounds
      for (std::size_t i = 7; i < program.constants.size(); i += 2) program.constants[i] *= 1e-42f;
      program.parameters[1].low = 1e-40f;
      program.states[0].high = program.grids[1].high = 1e-41f;
      program.states[3].high = -1e-41f;
      program.grids[1].low = program.grids[1].initial = -1e-42f;
    }
    add("random " + std::to_string(seed), std::move(program));
  }
  return subjects;
}

}  // namespace wale::listing
