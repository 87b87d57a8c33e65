#pragma once

#include <functional>
#include <memory>
#include <sstream>
#include <stdexcept>
#include <string>
#include <utility>

#include "compiler/compile.hpp"
#include "compiler/diagnostics/render.hpp"
#include "wale/felt.hpp"
#include "wale/library.hpp"
#include "wale/stage.hpp"

/// Compiles a material, rubs it with the simulated hand, and measures the run.
namespace wale::promises {

/// The program of a file's text for the default device. Throws std::runtime_error with the diagnostics.
inline Program compiled(std::string text) {
  SourceSet sources;
  Diagnostics diagnostics;
  const auto resolver = file_resolver({});
  auto program =
      compile(sources, sources.add("test.wale", std::move(text)), "", default_device, *resolver, diagnostics);
  if (program) return *program;
  std::string reasons;
  for (const auto& diagnostic : diagnostics.all()) reasons += render_text(diagnostic, sources, false);
  throw std::runtime_error(reasons);
}

/// The simulated Sandpaper joystick in the normal hand, with the given motion; by default it rubs to and fro.
inline std::unique_ptr<SimulatedJoystick> joystick(std::optional<Motion> motion = std::nullopt) {
  const Library library;
  const auto person = *library.person();
  for (const auto& device : library.devices())
    if (device.profile.name == default_device)
      return std::make_unique<SimulatedJoystick>(device.profile, person.hand, motion.value_or(Motion(person.lateral)));
  throw std::runtime_error("no such device");
}

/// The figures of a record without its first `settling` seconds.
inline Felt measured(const Program& program, const Record& record, double settling) {
  const auto& device = program.description().device;
  return measure(record, {.position_step = device.workspace_diameter / device.position_counts,
                          .predicted_amplitude = predicted_amplitude(Bank(program)),
                          .settling = settling});
}

/// The record of five and a half seconds of rubbing.
inline Record record_of(const Program& program) {
  auto stick = joystick();
  Stage stage(*stick);
  Patch patch = *stage.add(program);
  const auto result = stage.run({.seconds = 5.5, .virtual_time = true});
  if (!result) throw std::runtime_error(in_words(result.error()));
  return result->record;
}

/// The figures of five seconds of rubbing after half a second of settling. `prepare` may set parameters first.
inline Felt rubbed(const Program& program, const std::function<void(Patch&)>& prepare = {}) {
  auto stick = joystick();
  Stage stage(*stick);
  Patch patch = *stage.add(program);
  if (prepare) prepare(patch);
  const auto result = stage.run({.seconds = 5.5, .virtual_time = true});
  if (!result) throw std::runtime_error(in_words(result.error()));
  return measured(program, result->record, 0.5);
}

}  // namespace wale::promises
