#include "compiler/measure/measure.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <glm/geometric.hpp>
#include <span>
#include <vector>

namespace wale {

namespace {

constexpr std::size_t hands = 8192;         ///< at rest: a percentile needs many
constexpr std::size_t moving_hands = 4096;  ///< for the largest force, which is at an extreme or a corner
constexpr std::size_t corners = 16;         ///< of the patch, each at the four corners of velocity

/// The i-th point of the four-dimensional Kronecker lattice, each coordinate in [-1, 1): the powers of the root of
/// g^5 = g + 1 that fill four dimensions most evenly.
std::array<float, 4> lattice_point(std::size_t i) {
  constexpr double g = 1.1673039782614187;
  std::array<float, 4> point;
  double step = 1;
  for (auto& coordinate : point) {
    step /= g;
    const double whole = static_cast<double>(i) * step + 0.5;
    coordinate = static_cast<float>(2 * (whole - static_cast<double>(static_cast<std::int64_t>(whole))) - 1);
  }
  return point;
}

/// Whether the force depends on more than place: on motion, on time, on the button.
bool depends_on_the_moment(const PatchProgram& program) {
  const auto of_the_moment = [](RegisterNumber number) {
    return number < first_constant && number != static_cast<RegisterNumber>(Input::x) &&
           number != static_cast<RegisterNumber>(Input::y) &&
           (number < static_cast<RegisterNumber>(Input::patch_half_width) ||
            number > static_cast<RegisterNumber>(Input::probe));
  };
  return std::ranges::any_of(program.tick, [&](const Instruction& instruction) {
    const auto fields = facts(static_cast<Operation>(instruction.operation)).fields;
    const RegisterNumber operands[] = {instruction.a, instruction.b, instruction.c};
    for (std::size_t i = 0; i < 3; ++i)
      if (fields[i] == 'r' && of_the_moment(operands[i])) return true;
    return false;
  });
}

/// Fills in what a moving hand has besides place and velocity: accelerations of either sign, moments over a minute, the
/// button down for every other one.
void give_a_moment(Hand& hand, std::size_t i) {
  constexpr double minute = 60, golden = 0.61803398874989485;
  const double share = static_cast<double>(i) * golden;
  hand.time = minute * (share - std::floor(share));
  hand.acceleration = hand.velocity * static_cast<float>(hand.time > minute / 2 ? 10.0 : -10.0);  // 1/s: a brisk hand
  hand.raw_velocity = hand.velocity;
  hand.raw_acceleration = hand.acceleration;
  hand.workspace = hand.position;
  hand.button = i % 2 == 1;
}

}  // namespace

Measured measure(const Bank& bank) {
  const PatchProgram& program = bank.program().description();
  const PatchSize size = bank.size();
  const glm::vec2 extent{size.width / 2 - size.rim, size.height / 2 - size.rim};
  const float speed = static_cast<float>(program.device.speed_limit);

  std::vector<Hand> at_rest(hands), moving(moving_hands);
  for (std::size_t i = 0; i < hands; ++i) {
    const auto [u, v, vx, vy] = lattice_point(i);
    at_rest[i].position = extent * glm::vec2(u, v);
    if (i < moving_hands) moving[i] = {at_rest[i].position, speed * glm::vec2(vx, vy)};
  }
  // Corners are where fields that grow outward are strongest, and full speed where those of motion are.
  for (std::size_t i = 0; i < corners; ++i) {
    const auto sign = [&](unsigned bit) { return i >> bit & 1u ? 1.0f : -1.0f; };
    moving[i] = {glm::vec2(sign(0), sign(1)) * glm::vec2(size.width, size.height) / 2.0f,
                 speed * glm::vec2(sign(2), sign(3))};
  }

  std::vector<Force> forces(hands);
  Measured measured;
  for (std::size_t i = 0; i < moving_hands; ++i) give_a_moment(moving[i], i);
  // Where the force depends on place alone, only the corners differ from the hands at rest.
  const std::size_t different = depends_on_the_moment(program) ? moving_hands : corners;
  tick_all(bank, std::span(moving).first(different), forces);
  for (const auto& force : std::span(forces).first(different))
    measured.max_newton = std::max(measured.max_newton, glm::length(force));
  tick_all(bank, at_rest, forces);
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

}  // namespace wale
