#include "compiler/measure/measure.hpp"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <numbers>
#include <span>
#include <vector>

#include "compiler/measure/coarseness.hpp"
#include "compiler/measure/hands.hpp"

namespace wale {

namespace {

constexpr std::size_t hands = 8192;         ///< at rest: a percentile needs many
constexpr std::size_t moving_hands = 4096;  ///< for the largest force, which is at an extreme or a corner
constexpr std::size_t corners = 16;         ///< of the patch, each at the four corners of velocity

}  // namespace

Measured measure(const Bank& bank) {
  const PatchProgram& program = bank.program().description();
  const PatchSize size = bank.size();
  const glm::vec2 extent{size.width / 2 - size.rim, size.height / 2 - size.rim};
  const float speed = static_cast<float>(program.device.speed_limit);

  const std::vector<Hand> at_rest = hands_at_rest(hands, extent);
  // If the force depends on the place only, moving hands add nothing to the hands at rest except the corners.
  std::vector<Hand> moving = hands_in_motion(depends_on_the_moment(program) ? moving_hands : corners, extent, speed);
  // Forces that grow outward are strongest at the corners, and those of motion at full speed.
  for (std::size_t i = 0; i < corners; ++i) {
    const auto sign = [&](unsigned bit) { return i >> bit & 1u ? 1.0f : -1.0f; };
    moving[i] = {glm::vec2(sign(0), sign(1)) * glm::vec2(size.width, size.height) / 2.0f,
                 speed * glm::vec2(sign(2), sign(3))};
    give_a_moment(moving[i], i);
  }

  std::vector<Force> forces(hands);
  Measured measured;
  tick_coarsely(bank, moving, forces);
  for (const auto& force : std::span(forces).first(moving.size()))
    measured.max_newton = std::max(measured.max_newton, glm::length(force));
  tick_coarsely(bank, at_rest, forces);
  std::vector<float> sizes;
  double squares = 0;
  for (const auto& force : forces) {
    sizes.push_back(glm::length(force));
    squares += static_cast<double>(sizes.back()) * sizes.back();
  }
  const auto p99 = sizes.begin() + static_cast<std::ptrdiff_t>(hands * 99 / 100);
  std::ranges::nth_element(sizes, p99);
  measured.p99_newton = *p99;
  measured.rms_newton = static_cast<float>(std::sqrt(squares / hands));
  measured.max_newton = std::max(measured.max_newton, *std::ranges::max_element(sizes));
  for (const auto& instruction : program.setup)
    if (instruction.operation == static_cast<std::uint8_t>(Operation::peak) &&
        !(bank.registers()[instruction.destination] > 0))
      measured.flat = true;
  return measured;
}

Force given_by(const Shaker& shaker, Force drive) {
  drive.y = static_cast<float>(std::clamp<double>(drive.y, shaker.frequency_low, shaker.frequency_high));
  drive.x = std::min(drive.x, static_cast<float>(shaker.acceleration(1, drive.y)));
  return drive;
}

MeasuredShaking measure_shaking(const Bank& bank, const HandDeclaration* person) {
  constexpr std::size_t moments = 4096;
  const PatchSize size = bank.size();
  const double frequency = person ? person->lateral_frequency : 1;
  const double reach = std::min(person ? person->lateral_amplitude : 0.04, 0.5 * size.width - size.rim);
  std::vector<Hand> stroke(moments);
  for (std::size_t i = 0; i < moments; ++i) {
    const double phase = 2 * std::numbers::pi * static_cast<double>(i) / moments;
    Hand& hand = stroke[i];
    hand.position = hand.workspace = glm::vec2(static_cast<float>(reach * std::sin(phase)), 0);
    const double speed = 2 * std::numbers::pi * frequency * reach * std::cos(phase);
    hand.velocity = hand.raw_velocity = glm::vec2(static_cast<float>(speed), 0);
    hand.time = static_cast<double>(i) / moments / frequency;
  }
  std::vector<Force> drives(moments);
  tick_all(bank, stroke, drives);
  const Shaker& shaker = *bank.program().description().device.shaker;
  for (Force& drive : drives) drive = given_by(shaker, drive);
  MeasuredShaking measured;
  std::vector<float> amplitudes;
  double squares = 0;
  for (const Force& drive : drives) {
    amplitudes.push_back(std::max(drive.x, 0.0f));
    squares += static_cast<double>(amplitudes.back()) * amplitudes.back();
  }
  measured.rms = static_cast<float>(std::sqrt(squares / moments));
  const auto p99 = amplitudes.begin() + static_cast<std::ptrdiff_t>(moments * 99 / 100);
  std::ranges::nth_element(amplitudes, p99);
  measured.p99 = *p99;
  measured.max = *std::max_element(p99, amplitudes.end());
  for (const Force& drive : drives) {
    if (!(drive.x > 0) || drive.x < measured.p99 / 2) continue;
    measured.lowest = measured.highest > 0 ? std::min(measured.lowest, drive.y) : drive.y;
    measured.highest = std::max(measured.highest, drive.y);
  }
  return measured;
}

}  // namespace wale
