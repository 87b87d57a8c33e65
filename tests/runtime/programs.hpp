#pragma once

#include <cmath>
#include <stdexcept>
#include <string>

#include "tests/runtime/figures.hpp"
#include "wale/program.hpp"

namespace wale {

/// Writes small patch programs. All constants, parameters and states are declared before the first operation, since
/// temporaries follow them. An operation with several results returns the register of the first.
class Assembly {
 public:
  explicit Assembly(std::vector<float> constants, std::vector<Parameter> parameters = {}) {
    program.material = "by hand";
    program.constants = std::move(constants);
    program.parameters = std::move(parameters);
    program.patch_width = program.patch_height = 0.16f;
    program.patch_rim = 0.005f;
    program.device = sandpaper();
  }

  static RegisterNumber input(Input input) { return static_cast<RegisterNumber>(input); }
  RegisterNumber constant(unsigned i) const { return static_cast<RegisterNumber>(first_constant + i); }
  RegisterNumber parameter(unsigned i) const { return static_cast<RegisterNumber>(program.first_parameter() + i); }

  /// Declares a state, before the first operation.
  RegisterNumber state(std::string name, float low, float high) {
    program.states.push_back({std::move(name), low, high});
    return static_cast<RegisterNumber>(program.first_state() + program.states.size() - 1);
  }
  /// Sets the registers of a state's initial and next value.
  void evolve(RegisterNumber state, RegisterNumber initial, RegisterNumber next) {
    State& evolving = program.states.at(state - program.first_state());
    evolving.initial = initial;
    evolving.next = next;
  }

  /// Appends an operation to `code` and returns the temporary that it writes first.
  RegisterNumber operator()(std::vector<Instruction>& code, Operation operation, RegisterNumber a, RegisterNumber b = 0,
                            RegisterNumber c = 0) {
    const auto result = static_cast<RegisterNumber>(program.first_temporary() + program.temporaries);
    program.temporaries = static_cast<std::uint16_t>(program.temporaries + facts(operation).results);
    code.push_back({static_cast<std::uint8_t>(operation), result, a, b, c});
    return result;
  }
  RegisterNumber enter(Operation operation, RegisterNumber a, RegisterNumber b = 0, RegisterNumber c = 0) {
    return (*this)(program.enter, operation, a, b, c);
  }
  RegisterNumber tick(Operation operation, RegisterNumber a, RegisterNumber b = 0, RegisterNumber c = 0) {
    return (*this)(program.tick, operation, a, b, c);
  }

  void push(std::uint8_t axis, RegisterNumber force, RegisterNumber ceiling) {
    program.outputs.push_back({OutputQuantity::force, axis, tick(Operation::limit, force, ceiling), ceiling});
  }

  Program load() const {
    auto loaded = Program::load(program);
    if (!loaded) throw std::runtime_error(in_words(loaded.error()));
    return *loaded;
  }

  PatchProgram program;
};

/// The same program, built for another device.
inline Program built_for(const Program& program, const DeviceProfile& device) {
  PatchProgram other = program.description();
  other.device = device;
  auto loaded = Program::load(std::move(other));
  if (!loaded) throw std::runtime_error(in_words(loaded.error()));
  return *loaded;
}

/// force = -b v on both axes.
inline Program oil(float damping, float ceiling = 9) {
  Assembly a({-damping, ceiling});
  for (const std::uint8_t axis : {0, 1}) {
    const Input velocity = axis == 0 ? Input::velocity_x : Input::velocity_y;
    a.push(axis, a.tick(Operation::multiply, a.constant(0), a.input(velocity)), a.constant(1));
  }
  return a.load();
}

/// force = -k x on both axes; k is the parameter `stiffness` (N/m).
inline Program spring(float stiffness, float ceiling = 9) {
  Assembly a({ceiling}, {{"stiffness", "N/m", 1, stiffness, 0, 10000, 0, 10000, ""}});
  for (const std::uint8_t axis : {0, 1}) {
    const Input position = axis == 0 ? Input::x : Input::y;
    const RegisterNumber pull = a.tick(Operation::multiply, a.parameter(0), a.input(position));
    a.push(axis, a.tick(Operation::negate, pull), a.constant(0));
  }
  return a.load();
}

/// A constant force along x: the parameter `push` (N).
inline Program push(float force, float ceiling = 9) {
  Assembly a({ceiling, 0}, {{"push", "mN", 1e-3, force, -20, 20, -20, 20, ""}});
  a.push(0, a.parameter(0), a.constant(0));
  a.push(1, a.constant(1), a.constant(0));
  return a.load();
}

/// A bead of 1 kg on a spring to the hand, with the parameter `stiffness` (N/m). It starts at the hand's entry, at
/// rest, and moves along x by semi-implicit Euler. The force is that of the spring. The bead writes 1 into a track of 9
/// cells, each 2.5 mm wide, with the middle one at the patch's centre.
inline Program bead(float stiffness) {
  Assembly a({9, 1, 0, 400, 4}, {{"stiffness", "N/m", 1, stiffness, 0, 1e6f, 0, 1e6f, ""}});
  const RegisterNumber place = a.state("place", -1, 1), speed = a.state("speed", -10, 10);
  a.program.grids = {{"track", 9, 1, 0, 0, 1}};
  const RegisterNumber stretch = a.tick(Operation::subtract, a.input(Input::x), place);
  const RegisterNumber pull = a.tick(Operation::multiply, stretch, a.parameter(0));
  const RegisterNumber step = a.tick(Operation::multiply, pull, a.input(Input::seconds_per_tick));
  const RegisterNumber faster = a.tick(Operation::add, speed, step);
  const RegisterNumber moved = a.tick(Operation::multiply, faster, a.input(Input::seconds_per_tick));
  a.evolve(place, a.input(Input::x), a.tick(Operation::add, place, moved));
  a.evolve(speed, a.constant(2), faster);
  const RegisterNumber column =
      a.tick(Operation::add, a.tick(Operation::multiply, place, a.constant(3)), a.constant(4));
  a.program.writes = {{0, column, a.constant(2), a.constant(1)}};
  a.push(0, a.tick(Operation::negate, pull), a.constant(0));
  a.push(1, a.constant(2), a.constant(0));
  return a.load();
}

/// Corduroy by its gradient: Gaussian pulses of alternating sign every half wale, with a standard deviation of 24/256
/// of a wale (the flanks of a smoothed square wave) and a height of `amplitude` N. The exact RMS is 0.576 of that. Its
/// percept has the law of Minsky 1995, figure 19.
inline Program corduroy(float amplitude, float wale = 0.0025f) {
  const float width = 24.0f / 128.0f;  // standard deviation in half wales
  const float exponent = 0.759593f, reference = 194 * 10.0f / 512;
  Assembly a({2, 0.5f, 1, -std::log2(std::exp(1.0f)) / (2 * width * width), amplitude, 1 / reference, exponent, 0},
             {{"wale", "mm", 1e-3, wale, 0.001f, 0.005f, 0.001f, 0.005f, "distance between ribs"}});
  const RegisterNumber two = a.constant(0), half = a.constant(1), one = a.constant(2);
  const auto pulse = [&](RegisterNumber distance) {
    const RegisterNumber square = a.tick(Operation::multiply, distance, distance);
    return a.tick(Operation::exp2, a.tick(Operation::multiply, square, a.constant(3)));
  };
  const RegisterNumber half_wale = a.tick(Operation::multiply, a.parameter(0), half);
  const RegisterNumber place = a.tick(Operation::divide, a.input(Input::x), half_wale);
  const RegisterNumber flank = a.tick(Operation::floor, a.tick(Operation::add, place, half));
  const RegisterNumber near = a.tick(Operation::absolute, a.tick(Operation::subtract, place, flank));
  const RegisterNumber far = a.tick(Operation::subtract, one, near);
  const RegisterNumber size = a.tick(Operation::subtract, pulse(near), pulse(far));
  const RegisterNumber pair = a.tick(Operation::floor, a.tick(Operation::multiply, flank, half));
  const RegisterNumber odd = a.tick(Operation::subtract, flank, a.tick(Operation::multiply, pair, two));
  const RegisterNumber sign = a.tick(Operation::subtract, one, a.tick(Operation::multiply, odd, two));
  const RegisterNumber shape = a.tick(Operation::multiply, sign, size);
  a.push(0, a.tick(Operation::multiply, shape, a.constant(4)), a.constant(4));
  a.push(1, a.constant(7), a.constant(4));

  PerceptRecord percept;
  percept.name = "roughness";
  percept.carrier = "lateral amplitude";
  percept.amplitude = a.constant(4);
  percept.alone = true;
  auto& code = percept.prediction;
  const RegisterNumber ratio = a(code, Operation::multiply, a.input(Input::probe), a.constant(5));
  percept.magnitude = percept.level =
      a(code, Operation::exp2, a(code, Operation::multiply, a(code, Operation::log2, ratio), a.constant(6)));
  percept.valid_low = 0.1f;
  percept.valid_high = 4;
  percept.extractor = Extractor::lateral_force;
  a.program.percepts.push_back(std::move(percept));
  return a.load();
}

}  // namespace wale
