#include "compiler/measure/hands.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>

namespace wale {

namespace {

/// The i-th point of a four-dimensional Kronecker lattice, with coordinates in [-1, 1). Its steps are the powers of 1 /
/// g, where g is the real root of g^5 = g + 1, which spread points evenly in four dimensions.
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

}  // namespace

bool depends_on_the_moment(const PatchProgram& program) {
  // The picture depends on places only.
  const auto of_the_moment = [](RegisterNumber number) {
    return number < first_constant && input_table[number].changes && !input_table[number].picture;
  };
  return std::ranges::any_of(program.tick, [&](const Instruction& instruction) {
    const auto fields = facts(static_cast<Operation>(instruction.operation)).fields;
    const RegisterNumber operands[] = {instruction.a, instruction.b, instruction.c};
    for (std::size_t i = 0; i < 3; ++i)
      if (fields[i] == 'r' && of_the_moment(operands[i])) return true;
    return false;
  });
}

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

std::vector<Hand> hands_at_rest(std::size_t count, glm::vec2 extent) {
  std::vector<Hand> hands(count);
  for (std::size_t i = 0; i < count; ++i) {
    const auto [u, v, vx, vy] = lattice_point(i);
    hands[i].position = hands[i].workspace = extent * glm::vec2(u, v);
  }
  return hands;
}

std::vector<Hand> hands_in_motion(std::size_t count, glm::vec2 extent, float speed) {
  std::vector<Hand> hands(count);
  for (std::size_t i = 0; i < count; ++i) {
    const auto [u, v, vx, vy] = lattice_point(i);
    hands[i].position = extent * glm::vec2(u, v);
    hands[i].velocity = speed * glm::vec2(vx, vy);
    give_a_moment(hands[i], i);
  }
  return hands;
}

}  // namespace wale
