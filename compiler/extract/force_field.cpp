#include "compiler/extract/force_field.hpp"

#include <algorithm>
#include <cmath>

namespace wale {

ForceField sample_force_field(const Bank& bank, glm::dvec2 centre, glm::dvec2 size, std::size_t side) {
  ForceField field{side, centre, size / static_cast<double>(side), {}};
  std::vector<Hand> hands(side * side);
  for (std::size_t row = 0; row < side; ++row)
    for (std::size_t column = 0; column < side; ++column) {
      Hand& hand = hands[row * side + column];
      hand.position = hand.workspace = glm::vec2(field.place(column, row));
    }
  field.forces.resize(hands.size());
  tick_all(bank, hands, field.forces);
  return field;
}

LinearField linear_part(const ForceField& field) {
  LinearField part;
  const double count = static_cast<double>(field.side * field.side);
  for (const Force& force : field.forces) part.mean += glm::dvec2(force) / count;
  glm::dvec2 squares{0};
  for (std::size_t row = 0; row < field.side; ++row)
    for (std::size_t column = 0; column < field.side; ++column) {
      const glm::dvec2 from = field.place(column, row) - field.centre;
      const glm::dvec2 force = glm::dvec2(field.forces[row * field.side + column]) - part.mean;
      part.by_x += from.x * force, part.by_y += from.y * force;
      squares += from * from;
    }
  part.by_x /= squares.x, part.by_y /= squares.y;
  return part;
}

ForceField middle_of(const ForceField& field) {
  ForceField middle{field.side / 2, field.centre, field.spacing, {}};
  const std::size_t first = field.side / 4;
  for (std::size_t row = first; row < first + middle.side; ++row)
    for (std::size_t column = first; column < first + middle.side; ++column)
      middle.forces.push_back(field.forces[row * field.side + column]);
  return middle;
}

ForceField without(const ForceField& field, const LinearField& part) {
  ForceField rest = field;
  for (std::size_t row = 0; row < field.side; ++row)
    for (std::size_t column = 0; column < field.side; ++column) {
      const glm::dvec2 from = field.place(column, row) - field.centre;
      rest.forces[row * field.side + column] -= glm::vec2(part.mean + from.x * part.by_x + from.y * part.by_y);
    }
  return rest;
}

double quantile(std::vector<float> values, double share) {
  if (values.empty()) return 0;
  const auto rank = std::min(values.size() - 1, static_cast<std::size_t>(share * static_cast<double>(values.size())));
  const auto at = values.begin() + static_cast<std::ptrdiff_t>(rank);
  std::ranges::nth_element(values, at);
  return *at;
}

}  // namespace wale
