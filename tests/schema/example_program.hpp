#pragma once

#include "wale/patch_program.hpp"

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
  device.continuous_newton = 2;
  device.heating_seconds = 30;
  device.active_watt = 1.5;
  device.velocity_window = 15;
  device.velocity_noise_counts = 1;
  device.patch_width = 0.1;
  device.patch_height = 0.08;
  device.patch_rim = 0.005;
  device.mass = 0.3;
  device.damping = 1;
  device.friction = 0.15;
  device.delay_x = 0.0005;
  device.delay_y = 0.0006;
  device.bandwidth_x = 120;
  device.bandwidth_y = 90;
  device.damping_known = true;
  return device;
}

/// The record of the only percept that `program` realises.
inline PerceptRecord roughness() {
  using enum Operation;
  PerceptRecord percept;
  percept.name = "roughness";
  percept.carrier = "lateral amplitude";
  percept.parameter = 1;
  percept.amplitude = 40;
  percept.alone = true;
  percept.prediction = {instruction(multiply, 43, 7, 35), instruction(add, 44, 43, 35)};
  percept.magnitude = 43;
  percept.level = 44;
  percept.valid_low = 0.1f;
  percept.valid_high = 4.0f;
  percept.slope = Evidence::measured;
  percept.anchor = Evidence::published;
  percept.handle = Evidence::transferred;
  percept.map = "roughness from amplitude";
  percept.device = "sandpaper";
  percept.source = "Minsky 1995, figure 19";
  percept.unit = "N";
  percept.extractor = Extractor::lateral_force;
  percept.period_low = 0.0007f;
  percept.period_high = 0.01f;
  percept.one = 3.8f;
  percept.near_threshold = 0.1f;
  percept.uncertainty = {.scatter = 0.05f,
                         .slope_error = 0.03f,
                         .spread = 0.4f,
                         .noise = 0.2f,
                         .observers = 15,
                         .stimuli = 30,
                         .spread_assumed = true};
  percept.weber = 0.1f;
  percept.floor = 0.05f;
  percept.weber_evidence = Evidence::recalled;
  percept.weber_source = "Tan 1992";
  percept.realisation = "lateral(sin(x))";
  percept.basis = {.share = 0.75f,
                   .tolerance = 0.1f,
                   .summand = true,
                   .ranges = {{"period", 0.0007f, 0.01f, "mm", 1e-3, true}, {"rate", -1e30f, 350, "Hz", 1, false}},
                   .domain = {.stated = true,
                              .profiles = 5,
                              .dimensions = 1,
                              .alone = true,
                              .crest_low = 1.2f,
                              .crest_high = 2.2f,
                              .crest_assumed = true}};
  return percept;
}

/// A sinusoidal grating of a live period whose force has a live amplitude, with a table, a state, grids, marks, a
/// percept and layers. No part of the format is empty.
///
///   height = sine(2 pi x / period);  force x = -amplitude * slope / peak(|slope|), limited;  force y = 0, limited
inline PatchProgram program() {
  using enum Operation;
  PatchProgram p;
  p.material = "bench grating";
  // Registers: 32 2 pi, 33 device ceiling 5 N, 34 zero, 35 one half; 36 period, 37 amplitude;
  // setup 38 wave number, 39 peak, 40 ceiling, 41 gain; state 42; temporaries 43 ..
  p.constants = {6.2831853f, 5.0f, 0.0f, 0.5f};
  p.parameters = {{"period", "mm", 1e-3, 0.002f, 0.001f, 0.01f, 0.0015f, 0.005f, "distance between ribs", "m"},
                  {"amplitude", "N", 1, 2.0f, 0.0f, 4.0f, 0.0f, 4.0f, ""}};
  p.setup_registers = 4;
  p.temporaries = 6;
  p.setup = {instruction(divide, 38, 32, 36), instruction(peak, 39, 0), instruction(limit, 40, 37, 33),
             instruction(divide, 41, 40, 39)};
  Peak lattice;
  lattice.code = {instruction(multiply, 43, 0, 38), instruction(cosine, 44, 43), instruction(multiply, 45, 44, 38),
                  instruction(absolute, 46, 45)};
  lattice.value = 46;
  lattice.half_width = 4;
  lattice.half_height = 5;
  lattice.points = 4096;
  lattice.percentile = 0.99f;
  p.peaks = {lattice};
  p.tick = {instruction(multiply, 43, 0, 38),  instruction(cosine, 44, 43),       instruction(multiply, 45, 44, 38),
            instruction(multiply, 45, 45, 41), instruction(subtract, 45, 34, 45), instruction(limit, 47, 45, 40),
            instruction(limit, 48, 34, 33)};
  p.outputs = {{OutputQuantity::force, 0, 47, 40}, {OutputQuantity::force, 1, 48, 33}};
  p.picture.code = {instruction(multiply, 43, 0, 38), instruction(sine, 44, 43), instruction(sample, 45, 0, 1, 0),
                    instruction(add, 48, 44, 45)};
  p.picture.relief = 48;
  p.picture.relief_is_length = true;
  p.picture.colour = std::array<RegisterNumber, 3>{48, 42, 34};
  p.picture.frame = {instruction(add, 46, 16, 42), instruction(recall, 43, 0, 46, 0)};
  p.picture.marks = {{MarkKind::point, {0, 1, 46}, 0xff8000},
                     {MarkKind::spring, {0, 1, 34, 34, 35}, 0x102030},
                     {MarkKind::line, {0, 1, 34, 34}, 0}};
  p.states = {{"wear", -1.0f, 1.0f, 43, 44, "m"}};
  p.enter = {instruction(multiply, 43, 16, 35)};
  p.grids = {{"trace", 4, 3, 0.25f, 0.0f, 1.0f, "kg"}, {"dot", 1, 1, -1.0f, -2.0f, 2.0f}};
  p.writes = {{0, 43, 1, 44}, {1, 34, 34, 42}};
  p.tables = {{3, 2, {0, 65535, 100, 7, 8, 9}}};
  p.patch_width = 0.1f;
  p.patch_height = 0.08f;
  p.active_watt = 0.25f;
  p.patch_rim = 0.005f;
  p.active_watt = 0.25f;
  p.device = device();
  p.percepts = {roughness()};
  p.fates = {{"roughness", true, Fate::saturated, 0.75f, 0.5f, "`bench` gives no more"},
             {"force", false, Fate::kept, 0, 0, ""}};
  p.layers.representative = {{"title", {"Bench grating"}}, {"called", {"grating", "r\xc3\xa4ndel"}}, {"kind", {}}};
  p.layers.perceptual = "roughness 0.6";
  p.layers.physical = "force = lateral(sin(x))";
  p.claims = {{"roughness", Evidence::transferred}};
  p.layers.documentation = "A grating for the bench.";
  p.places.files = {"bench.wale", "std.grain"};
  p.places.sections = {{{4, 0, 7}}, {{4, 0, 8}}, {{1, 0, 9}}, {{5, 0, 8}, {2, 1, 70000}},
                       {{4, 0, 8}}, {{2, 0, 9}}, {{2, 0, 3}}};
  return p;
}

/// The smallest valid program. Its force is zero.
inline PatchProgram least() {
  PatchProgram p;
  p.material = "nothing";
  p.constants = {0.0f, 1.0f};
  p.temporaries = 1;
  p.tick = {instruction(Operation::limit, 34, 32, 33)};
  p.outputs = {{OutputQuantity::force, 0, 34, 33}, {OutputQuantity::force, 1, 34, 33}};
  p.picture.relief = 32;
  p.patch_width = 0.1f;
  p.patch_height = 0.08f;
  p.device = device();
  return p;
}

/// A pad with two frequencies in its response; amplitudes and frequencies up to 16 m/s^2 and 200 Hz.
inline DeviceProfile pad_device(PositionSource position = PositionSource::touch) {
  DeviceProfile device;
  device.name = "bench pad";
  device.rate = 1000;
  device.slew = 2000;
  device.patch_width = 0.1;
  device.patch_height = 0.08;
  device.patch_rim = 0.005;
  device.shaker = Shaker{.position = position,
                         .frequency_low = 40,
                         .frequency_high = 200,
                         .command_steps = 0,
                         .spin_up = 0.02,
                         .exploring_speed = 0.1,
                         .response = {{40, {{0.5, 4}, {1, 8}}}, {120, {{0.25, 6}, {1, 16}}}}};
  if (position == PositionSource::none) return device;
  device.workspace_diameter = 0.12;
  device.position_counts = 2400;
  device.speed_limit = 1;
  device.velocity_window = 15;
  device.velocity_noise_counts = 1;
  return device;
}

/// Ribs of 2.5 mm on a pad: amplitude 5 m/s^2, frequency |v_x| / 2.5 mm.
inline PatchProgram pad(PositionSource position = PositionSource::touch) {
  using enum Operation;
  PatchProgram p;
  p.material = "bench ribs";
  p.constants = {400.0f, 16.0f, 200.0f, 5.0f, 0.0f};  // 32 .. 36
  p.temporaries = 4;                                  // 37 .. 40
  p.tick = {instruction(absolute, 37, 2), instruction(multiply, 38, 37, 32), instruction(limit, 39, 35, 33),
            instruction(limit, 40, 38, 34)};
  p.outputs = {{OutputQuantity::amplitude, 0, 39, 33}, {OutputQuantity::frequency, 0, 40, 34}};
  p.picture.relief = 36;
  p.patch_width = 0.1f;
  p.patch_height = 0.08f;
  p.patch_rim = 0.005f;
  p.device = pad_device(position);
  p.fates = {{"place of features", false, Fate::lost, 0, 0, "no position"}};
  return p;
}

}  // namespace wale::example
