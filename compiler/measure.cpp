#include "compiler/measure.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <glm/geometric.hpp>
#include <vector>

namespace wale {

namespace {

constexpr std::size_t hands = 8192;

/// The i-th point of the four-dimensional Kronecker lattice, each coordinate in [-1, 1): the powers of the root of
/// g^5 = g + 1 that fill four dimensions most evenly.
std::array<float, 4> lattice_point(std::size_t i) {
  constexpr double g = 1.1673039782614187;
  std::array<float, 4> point;
  double step = 1;
  for (auto& coordinate : point) {
    step /= g;
    const double whole = static_cast<double>(i) * step + 0.5;
    coordinate = static_cast<float>(2 * (whole - std::floor(whole)) - 1);
  }
  return point;
}

}  // namespace

Measured measure(const Bank& bank) {
  const PatchProgram& program = bank.program().description();
  const PatchSize size = bank.size();
  const glm::vec2 extent{size.width / 2 - size.rim, size.height / 2 - size.rim};
  const float speed = static_cast<float>(program.device.speed_limit);

  std::vector<Hand> at_rest(hands), moving(hands);
  for (std::size_t i = 0; i < hands; ++i) {
    const auto [u, v, vx, vy] = lattice_point(i);
    at_rest[i].position = extent * glm::vec2(u, v);
    moving[i] = {at_rest[i].position, speed * glm::vec2(vx, vy)};
  }
  // Corners are where fields that grow outward are strongest, and full speed where those of motion are.
  for (std::size_t i = 0; i < 16; ++i) {
    const auto sign = [&](unsigned bit) { return i >> bit & 1u ? 1.0f : -1.0f; };
    moving[i] = {glm::vec2(sign(0), sign(1)) * glm::vec2(size.width, size.height) / 2.0f,
                 speed * glm::vec2(sign(2), sign(3))};
  }

  std::vector<Force> forces(hands);
  Measured measured;
  tick_all(bank, moving, forces);
  for (const auto& force : forces) measured.max_newton = std::max(measured.max_newton, glm::length(force));
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
