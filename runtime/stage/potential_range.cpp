#include "runtime/stage/potential_range.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "runtime/machine/decoded_program.hpp"

namespace wale {
namespace {

constexpr std::size_t lines = 32, points = 512;

bool goes_by_place_alone(const Program& program) {
  const PatchProgram& description = program.description();
  return description.states.empty() && description.grids.empty() &&
         std::ranges::all_of(program.decoded().tick_inputs, [](Input input) {
           return input == Input::x || input == Input::y || input == Input::velocity_x || input == Input::velocity_y ||
                  input == Input::raw_velocity_x || input == Input::raw_velocity_y;
         });
}

/// The middle of part `index` of `count` equal parts of a length, relative to the middle of the whole.
float middle(std::size_t index, std::size_t count, float length) {
  return length * ((static_cast<float>(index) + 0.5f) / static_cast<float>(count) - 0.5f);
}

/// J, the largest range of the potential along any line of one direction.
double farthest_along(const Bank& bank, bool along_x) {
  const float length = along_x ? bank.size().width : bank.size().height;
  const float across = along_x ? bank.size().height : bank.size().width;
  std::vector<Hand> hands(lines * points);
  for (std::size_t line = 0; line < lines; ++line)
    for (std::size_t point = 0; point < points; ++point) {
      const float along = middle(point, points, length), beside = middle(line, lines, across);
      hands[line * points + point].position = along_x ? glm::vec2(along, beside) : glm::vec2(beside, along);
    }
  std::vector<Force> forces(hands.size());
  tick_all(bank, hands, forces);
  const auto component = [&](std::size_t index) -> double { return along_x ? forces[index].x : forces[index].y; };
  const double step = static_cast<double>(length) / points;
  double farthest = 0;
  for (std::size_t line = 0; line < lines; ++line) {
    double potential = 0, low = 0, high = 0;
    for (std::size_t point = 1; point < points; ++point) {
      const std::size_t here = line * points + point;
      potential -= 0.5 * (component(here - 1) + component(here)) * step;
      low = std::min(low, potential);
      high = std::max(high, potential);
    }
    farthest = std::max(farthest, high - low);
  }
  return farthest;
}

}  // namespace

double potential_range(const Bank& bank) {
  double most = 0;  // N along an axis
  for (const Output& output : bank.program().description().outputs)
    most = std::max(most, static_cast<double>(std::abs(bank.registers()[output.ceiling])));
  const double width = bank.size().width, height = bank.size().height;
  const double all_the_way = most * std::hypot(width, height);
  if (!goes_by_place_alone(bank.program())) return all_the_way;
  const double between_lines = most * 0.5 * (width + height) / lines;
  return std::min(all_the_way, farthest_along(bank, true) + farthest_along(bank, false) + between_lines);
}

}  // namespace wale
