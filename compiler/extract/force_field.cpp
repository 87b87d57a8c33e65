#include "compiler/extract/force_field.hpp"

#include <algorithm>
#include <cmath>
#include <span>

#include "compiler/measure/coarseness.hpp"
#include "runtime/machine/parallel.hpp"

namespace wale {
namespace {

constexpr std::size_t hands_at_once = 2048;  // so many stay in the cache
/// Work above this, in units of cost over all hands, is worth another thread: about a millisecond.
constexpr double worth_another_thread = 2e6;

}  // namespace

ForceField sample_force_field(const Bank& bank, glm::dvec2 centre, glm::dvec2 size, std::size_t side) {
  ForceField field{side, centre, size / static_cast<double>(side), std::vector<Force>(side * side)};
  const std::size_t lines = std::clamp<std::size_t>(hands_at_once / side, 1, side);
  // Each line writes only its own forces, so the division among threads does not change the result.
  const auto sample = [&](std::size_t begin, std::size_t end) {
    std::vector<Hand> hands(std::min(lines, end - begin) * side);
    for (std::size_t first = begin; first < end; first += lines) {
      const std::size_t count = std::min(lines, end - first);
      for (std::size_t row = 0; row < count; ++row)
        for (std::size_t column = 0; column < side; ++column) {
          Hand& hand = hands[row * side + column];
          hand.position = hand.workspace = glm::vec2(field.place(column, first + row));
        }
      tick_coarsely(bank, std::span(hands).first(count * side),
                    std::span(field.forces).subspan(first * side, count * side));
    }
  };
  const PatchProgram& program = bank.program().description();
  const auto cost = static_cast<double>(cost_of(program.enter) + cost_of(program.tick));
  if (static_cast<double>(side * side) * cost < worth_another_thread)
    sample(0, side);
  else
    in_parallel(side, sample);
  return field;
}

LinearField linear_part(const ForceField& field) {
  LinearField part;
  const auto count = static_cast<double>(field.side * field.side);
  const double middle = 0.5 * (static_cast<double>(field.side) - 1);
  double squares = 0;  // of the distances from the middle, the same for columns and rows
  for (std::size_t row = 0; row < field.side; ++row) {
    glm::dvec2 sum{0};
    for (std::size_t column = 0; column < field.side; ++column) {
      const glm::dvec2 force(field.forces[row * field.side + column]);
      sum += force;
      part.by_x += (static_cast<double>(column) - middle) * force;
    }
    part.mean += sum;
    part.by_y += (static_cast<double>(row) - middle) * sum;
    squares += (static_cast<double>(row) - middle) * (static_cast<double>(row) - middle);
  }
  part.mean /= count;
  part.by_x /= squares * static_cast<double>(field.side) * field.spacing.x;
  part.by_y /= squares * static_cast<double>(field.side) * field.spacing.y;
  return part;
}

ForceField part_of(const ForceField& field, std::size_t first_column, std::size_t first_row, std::size_t side) {
  const double off = 0.5 * (static_cast<double>(side) - 1);
  const glm::dvec2 centre = field.place(first_column, first_row) + off * field.spacing;
  ForceField part{side, centre, field.spacing, {}};
  part.forces.reserve(side * side);
  for (std::size_t row = first_row; row < first_row + side; ++row) {
    const auto line = field.forces.begin() + static_cast<std::ptrdiff_t>(row * field.side + first_column);
    part.forces.insert(part.forces.end(), line, line + static_cast<std::ptrdiff_t>(side));
  }
  return part;
}

ForceField without(ForceField field, const LinearField& part) {
  const double middle = 0.5 * (static_cast<double>(field.side) - 1);
  const glm::vec2 step(field.spacing.x * part.by_x);
  for (std::size_t row = 0; row < field.side; ++row) {
    const double down = (static_cast<double>(row) - middle) * field.spacing.y;
    const glm::vec2 at(part.mean + down * part.by_y);
    for (std::size_t column = 0; column < field.side; ++column)
      field.forces[row * field.side + column] -= at + (static_cast<float>(column) - static_cast<float>(middle)) * step;
  }
  return field;
}

std::vector<std::complex<float>> as_complex(const std::vector<Force>& forces) {
  std::vector<std::complex<float>> values;
  values.reserve(forces.size());
  for (const Force& force : forces) values.emplace_back(force.x, force.y);
  return values;
}

double quantile(std::vector<float> values, double share) {
  if (values.empty()) return 0;
  const auto rank = std::min(values.size() - 1, static_cast<std::size_t>(share * static_cast<double>(values.size())));
  const auto at = values.begin() + static_cast<std::ptrdiff_t>(rank);
  std::ranges::nth_element(values, at);
  return *at;
}

}  // namespace wale
