#pragma once

#include <gtest/gtest.h>

#include <cmath>
#include <glm/glm.hpp>
#include <map>
#include <random>
#include <stdexcept>
#include <string>
#include <vector>

#include "compiler/compile.hpp"
#include "compiler/diagnostics/render.hpp"
#include "wale/memory.hpp"
#include "wale/picture.hpp"
#include "wale/program.hpp"

/// Compiles materials of the standard modules in library/std, and runs them.
namespace wale::standard {

constexpr double pi = 3.14159265358979323846;
constexpr double seconds_per_tick = 1.0 / 900;  // of the default device

/// The material `name` of declarations that may import modules of library/. Throws std::runtime_error with the
/// diagnostics.
inline Program material(const std::string& declarations, const std::string& name) {
  SourceSet sources;
  Diagnostics diagnostics;
  const auto resolver = file_resolver({WALE_SOURCE_DIR "/library"});
  const SourceId source = sources.add("test.wale", "wale 1\n" + declarations);
  const CheckedModule module = check_source(sources, source, *resolver, diagnostics);
  if (!diagnostics.has_errors())
    if (const auto program = compile_material(module, name, default_device, sources, source, *resolver, diagnostics))
      return *program;
  std::string reasons;
  for (const auto& diagnostic : diagnostics.all()) reasons += render_text(diagnostic, sources, false);
  throw std::runtime_error(reasons);
}

/// The material `name` of a module, with other parameters where given: made("std.wall", "wall", "damping: 0 N s/m").
inline Program made(const std::string& module, const std::string& name, const std::string& parameters = "") {
  if (parameters.empty()) return material("import " + module + "\nmaterial m = " + name + "()", "m");
  return material("import " + module + "\nmaterial m = " + name + "(" + parameters + ")", "m");
}

/// A material with the force expression `force`, which may use the exports of `module`.
inline Program pushing(const std::string& module, const std::string& force) {
  return material("import " + module + "\nmaterial m { physical {\n patch 200 mm, 200 mm\n force = " + force + "\n} }",
                  "m");
}

/// A hand that moves tick by tick over a program with a memory.
class Stroke {
 public:
  /// Sets the hand down at `start` (m from the patch's centre), at rest.
  explicit Stroke(const Program& program, glm::dvec2 start = {0, 0}) : bank_(program), memory_(program), place_(start) {
    hand_.position = start;
    memory_.enter(bank_, hand_);
    force_ = tick(bank_, memory_, hand_);
  }

  /// One tick at `to` (m), with the velocity of the step.
  glm::dvec2 move(glm::dvec2 to) { return tick_at(to, (to - place_) / seconds_per_tick); }

  /// One tick at `to` with any velocity.
  glm::dvec2 tick_at(glm::dvec2 to, glm::dvec2 velocity) {
    hand_.position = to;
    hand_.velocity = hand_.raw_velocity = velocity;
    hand_.time += seconds_per_tick;
    const glm::dvec2 before = force_;
    force_ = tick(bank_, memory_, hand_);
    work_ -= glm::dot((before + force_) / 2.0, to - place_);
    place_ = to;
    return force_;
  }

  /// Straight to `to` at about `speed` (m/s), in equal steps.
  glm::dvec2 line(glm::dvec2 to, double speed) {
    const glm::dvec2 from = place_;
    const int steps = std::max(1, static_cast<int>(std::lround(glm::distance(from, to) / speed / seconds_per_tick)));
    for (int i = 1; i <= steps; ++i) move(from + (to - from) * (static_cast<double>(i) / steps));
    return force_;
  }

  glm::dvec2 force() const { return force_; }
  glm::dvec2 place() const { return place_; }
  /// The work of the hand so far, in J.
  double work() const { return work_; }
  const Memory& memory() const { return memory_; }

 private:
  Bank bank_;
  Memory memory_;
  Hand hand_;
  glm::dvec2 place_, force_{0};
  double work_ = 0;
};

/// The force of a program without memory.
class Field {
 public:
  explicit Field(const Program& program) : bank_(program) {}
  glm::dvec2 operator()(glm::dvec2 position, glm::dvec2 velocity = {0, 0}) {
    Hand hand;
    hand.position = position;
    hand.velocity = velocity;
    return tick(bank_, hand);
  }

 private:
  Bank bank_;
};

/// A height that `module` exports, as an expression of `hand`.
class Height {
 public:
  Height(const std::string& module, const std::string& height)
      : bank_(material("import " + module + "\nmaterial m { physical {\n height h = " + height +
                           "\n force = lateral(h, amplitude: 1 N)\n} }",
                       "m")) {}
  double operator()(glm::dvec2 place) const {
    const glm::vec2 position = place;
    float height = 0;
    relief_all(bank_, {&position, 1}, {&height, 1});
    return height;
  }
  std::vector<float> operator()(const std::vector<glm::vec2>& places) const {
    std::vector<float> heights(places.size());
    relief_all(bank_, places, heights);
    return heights;
  }

 private:
  Bank bank_;
};

/// Random numbers; the same for the same seed.
class Chance {
 public:
  explicit Chance(std::uint32_t seed) : random_(seed) {}
  double between(double low, double high) { return low + (high - low) * (random_() / 4294967296.0); }
  glm::dvec2 place(double half) { return {between(-half, half), between(-half, half)}; }
  glm::dvec2 direction() {
    const double angle = between(0, 2 * pi);
    return {std::cos(angle), std::sin(angle)};
  }

 private:
  std::mt19937 random_;
};

/// A smooth path (m) within 60 mm, with speeds of a few 0.1 m/s and rests.
inline glm::dvec2 wandering(double seconds, double phase) {
  const double t = seconds + 0.3 * std::sin(2 * seconds + phase);
  return {0.035 * std::sin(3.1 * t + phase) + 0.02 * std::sin(8.3 * t),
          0.03 * std::sin(4.7 * t) + 0.02 * std::sin(7.1 * t + phase)};
}

}  // namespace wale::standard
