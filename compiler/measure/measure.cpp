#include "compiler/measure/measure.hpp"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <span>
#include <vector>

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
  // Where the force depends on place alone, only the corners differ from the hands at rest.
  std::vector<Hand> moving = hands_in_motion(depends_on_the_moment(program) ? moving_hands : corners, extent, speed);
  // Corners are where fields that grow outward are strongest, and full speed where those of motion are.
  for (std::size_t i = 0; i < corners; ++i) {
    const auto sign = [&](unsigned bit) { return i >> bit & 1u ? 1.0f : -1.0f; };
    moving[i] = {glm::vec2(sign(0), sign(1)) * glm::vec2(size.width, size.height) / 2.0f,
                 speed * glm::vec2(sign(2), sign(3))};
    give_a_moment(moving[i], i);
  }

  std::vector<Force> forces(hands);
  Measured measured;
  tick_all(bank, moving, forces);
  for (const auto& force : std::span(forces).first(moving.size()))
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
