#pragma once

#include "schema/patch_program.hpp"

namespace wale::example {

inline Instruction instruction(Operation operation, unsigned destination, unsigned a = 0, unsigned b = 0,
                               unsigned c = 0) {
  return {static_cast<std::uint8_t>(operation), static_cast<RegisterNumber>(destination),
          static_cast<RegisterNumber>(a), static_cast<RegisterNumber>(b), static_cast<RegisterNumber>(c)};
}

inline DeviceProfile device() {
  DeviceProfile device;
  device.name = "bench";
  device.workspace_diameter = 0.2286;
  device.position_counts = 4096;
  device.force_newton = 10;
  device.force_counts = 2048;
  device.rate = 900;
  device.speed_limit = 2;
  device.slew = 500;
  device.velocity_window = 15;
  device.velocity_noise_counts = 1;
  device.patch_width = 0.1;
  device.patch_height = 0.08;
  device.patch_rim = 0.005;
  device.mass = 0.3;
  device.damping = 1;
  device.friction = 0.15;
  return device;
}

/// A sinusoidal grating of a live period whose force has a live amplitude, with a table, a percept and layers: a
/// program in which no part of the format is empty.
///
///   height = sine(2 pi x / period);  force x = -amplitude * slope / peak(|slope|), limited;  force y = 0, limited
inline PatchProgram program() {
  using enum Operation;
  PatchProgram p;
  p.material = "bench grating";
  // Registers: 16 2 pi, 17 device ceiling 5 N, 18 zero, 19 one half; 20 period, 21 amplitude;
  // setup 22 wave number, 23 peak, 24 ceiling, 25 gain; temporaries 26 ..
  p.constants = {6.2831853f, 5.0f, 0.0f, 0.5f};
  p.parameters = {{"period", "mm", 1e-3, 0.002f, 0.001f, 0.01f, "distance between ribs", "m"},
                  {"amplitude", "N", 1, 2.0f, 0.0f, 4.0f, ""}};
  p.setup_registers = 4;
  p.temporaries = 6;
  p.setup = {instruction(divide, 22, 16, 20), instruction(peak, 23, 0), instruction(limit, 24, 21, 17),
             instruction(divide, 25, 24, 23)};
  Peak lattice;
  lattice.code = {instruction(multiply, 26, 0, 22), instruction(cosine, 27, 26), instruction(multiply, 28, 27, 22),
                  instruction(absolute, 29, 28)};
  lattice.value = 29;
  lattice.half_width = 4;
  lattice.half_height = 5;
  lattice.points = 4096;
  lattice.percentile = 0.99f;
  p.peaks = {lattice};
  p.tick = {instruction(multiply, 26, 0, 22),  instruction(cosine, 27, 26),       instruction(multiply, 28, 27, 22),
            instruction(multiply, 28, 28, 25), instruction(subtract, 28, 18, 28), instruction(limit, 30, 28, 24),
            instruction(limit, 31, 18, 17)};
  p.outputs = {{OutputQuantity::force, 0, 30, 24}, {OutputQuantity::force, 1, 31, 17}};
  p.picture.code = {instruction(multiply, 26, 0, 22), instruction(sine, 27, 26), instruction(sample, 28, 0, 1, 0),
                    instruction(add, 31, 27, 28)};
  p.picture.relief = 31;
  p.tables = {{3, 2, {0, 65535, 100, 7, 8, 9}}};
  p.patch_width = 0.1f;
  p.patch_height = 0.08f;
  p.patch_rim = 0.005f;
  p.device = device();
  PerceptRecord percept;
  percept.name = "roughness";
  percept.carrier = "lateral amplitude";
  percept.parameter = 1;
  percept.amplitude = 24;
  percept.alone = true;
  percept.prediction = {instruction(multiply, 26, 7, 19), instruction(add, 27, 26, 19)};
  percept.magnitude = 26;
  percept.level = 27;
  percept.valid_low = 0.1f;
  percept.valid_high = 4.0f;
  percept.scatter = 0.05f;
  percept.slope = Evidence::measured;
  percept.anchor = Evidence::published;
  percept.handle = Evidence::transferred;
  percept.map = "roughness from amplitude";
  percept.device = "sandpaper";
  percept.source = "Minsky 1995, figure 19";
  p.percepts = {percept};
  p.layers.representative = {{"title", {"Bench grating"}}, {"called", {"grating", "r\xc3\xa4ndel"}}, {"kind", {}}};
  p.layers.perceptual = "roughness 0.6";
  p.layers.physical = "force = lateral(sin(x))";
  return p;
}

/// The least that is a program: no force.
inline PatchProgram least() {
  PatchProgram p;
  p.material = "nothing";
  p.constants = {0.0f, 1.0f};
  p.temporaries = 1;
  p.tick = {instruction(Operation::limit, 18, 16, 17)};
  p.outputs = {{OutputQuantity::force, 0, 18, 17}, {OutputQuantity::force, 1, 18, 17}};
  p.picture.relief = 16;
  p.patch_width = 0.1f;
  p.patch_height = 0.08f;
  p.device = device();
  return p;
}

}  // namespace wale::example
