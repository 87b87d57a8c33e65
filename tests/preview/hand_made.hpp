#pragma once

#include <gtest/gtest.h>

#include <variant>

#include "wale/program.hpp"

namespace wale {

/// Writes patch programs instruction by instruction, so that previews are tested without the compiler.
class HandMade {
 public:
  HandMade() {
    program.material = "hand_made";
    program.constants.assign(constant_count, 0.0f);
    program.patch_width = program.patch_height = 0.08f;
    program.patch_rim = 0.002f;
    program.device = {.name = "sandpaper",
                      .workspace_diameter = 0.2286,
                      .position_counts = 4096,
                      .force_newton = 10,
                      .force_counts = 2048,
                      .rate = 900,
                      .speed_limit = 2,
                      .slew = 1000,
                      .velocity_window = 15,
                      .velocity_noise_counts = 1,
                      .patch_width = 0.08,
                      .patch_height = 0.08,
                      .patch_rim = 0.002,
                      .mass = 0.3,
                      .damping = 1,
                      .friction = 0.15};
  }

  RegisterNumber input(Input which) const { return static_cast<RegisterNumber>(which); }
  RegisterNumber constant(float value) {
    program.constants.at(used_constants_) = value;
    return static_cast<RegisterNumber>(first_constant + used_constants_++);
  }
  RegisterNumber add(std::vector<Instruction>& code, Operation operation, RegisterNumber a, RegisterNumber b = 0,
                     RegisterNumber c = 0) {
    const auto result = static_cast<RegisterNumber>(program.first_temporary() + program.temporaries++);
    code.push_back({static_cast<std::uint8_t>(operation), result, a, b, c});
    return result;
  }
  /// Adds a state. Call it before the first `add`, since temporaries follow the states.
  RegisterNumber add_state(const State& state) {
    program.states.push_back(state);
    return static_cast<RegisterNumber>(program.first_temporary() - 1);
  }
  void push(RegisterNumber x, RegisterNumber y, float most) {
    const RegisterNumber ceiling = constant(most);
    program.outputs = {{OutputQuantity::force, 0, add(program.tick, Operation::limit, x, ceiling), ceiling},
                       {OutputQuantity::force, 1, add(program.tick, Operation::limit, y, ceiling), ceiling}};
  }
  Bank bank() const {
    auto loaded = Program::load(program);
    if (!loaded) throw std::runtime_error(in_words(loaded.error()));
    return Bank(*loaded);
  }

  PatchProgram program;

 private:
  static constexpr std::size_t constant_count = 32;
  std::size_t used_constants_ = 0;
};

inline constexpr double pi = 3.14159265358979323846;

/// The height (1 + sin(2 pi x / period)) / 2 and its lateral force with an amplitude in N. The period is in m.
inline Bank sine_grating(float period, float newton) {
  HandMade made;
  using enum Operation;
  const auto turns = made.constant(static_cast<float>(2 * pi / period)), half = made.constant(0.5f);
  auto& picture = made.program.picture.code;
  const auto wave = made.add(picture, sine, made.add(picture, multiply, made.input(Input::x), turns));
  made.program.picture.relief = made.add(picture, add, made.add(picture, multiply, wave, half), half);
  auto& tick = made.program.tick;
  const auto slope = made.add(tick, cosine, made.add(tick, multiply, made.input(Input::x), turns));
  made.push(made.add(tick, multiply, slope, made.constant(-newton)), made.constant(0), newton);
  made.program.layers.representative = {{"title", {"A sine grating"}}, {"called", {"grating", "washboard"}}};
  return made.bank();
}

/// The force -stiffness * hand - viscosity * velocity, in N/m and N s/m; either may be 0.
inline Bank spring_and_oil(float stiffness, float viscosity) {
  HandMade made;
  using enum Operation;
  const auto k = made.constant(-stiffness), b = made.constant(-viscosity);
  made.program.picture.relief = made.constant(0);
  auto& tick = made.program.tick;
  const auto along = [&](Input place, Input velocity) {
    return made.add(tick, add, made.add(tick, multiply, made.input(place), k),
                    made.add(tick, multiply, made.input(velocity), b));
  };
  const auto x = along(Input::x, Input::velocity_x);
  const auto y = along(Input::y, Input::velocity_y);
  made.push(x, y, 10);
  return made.bank();
}

}  // namespace wale
