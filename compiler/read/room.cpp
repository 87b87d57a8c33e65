#include "compiler/read/room.hpp"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "compiler/read/dependence.hpp"
#include "compiler/read/still_forces.hpp"
#include "compiler/read/unlimited.hpp"

namespace wale {
namespace {

constexpr std::size_t cells_looked_at = 16, cells_a_side = 96;
constexpr double room_enough = 0.5;      // of the limit, on a resting hand
constexpr double hardly_better = 0.05;   // of the limit
constexpr std::size_t places_along = 9;  // of a stretch
constexpr double apart = 3e-3;           // m between two stretches

/// The part of the device's limit that a resting hand feels in the cells of a lattice, row by row.
std::vector<double> used_in_cells(const Bank& bank, glm::dvec2 half, std::size_t side) {
  std::vector<glm::dvec2> places;
  for (std::size_t row = 0; row < side; ++row)
    for (std::size_t column = 0; column < side; ++column)
      places.push_back(half * ((glm::dvec2(column, row) + 0.5) / (0.5 * static_cast<double>(side)) - 1.0));
  const ForceLimit limit = limit_of(bank);
  std::vector<double> used;
  for (const glm::dvec2& force : forces_at(bank, places))
    used.push_back(std::max(std::max(std::abs(force.x), std::abs(force.y)) / limit.along_axis,
                            glm::length(force) / limit.any_way));
  return used;
}

}  // namespace

Room::Room(const Bank& bank)
    : half_(0.5 * glm::dvec2(bank.size().width, bank.size().height) - static_cast<double>(bank.size().rim)) {
  if (!depends_on_place(bank.program().description())) return;
  const std::vector<double> some = used_in_cells(bank, half_, cells_looked_at);
  if (std::ranges::max(some) > hardly_room) used_ = used_in_cells(bank, half_, cells_a_side);
}

double Room::used_at(glm::dvec2 place) const {
  const glm::dvec2 cell = (place / half_ + 1.0) * (0.5 * cells_a_side);
  const auto index = [](double at) {
    return static_cast<std::size_t>(std::clamp(at, 0.0, static_cast<double>(cells_a_side - 1)));
  };
  return used_[index(cell.y) * cells_a_side + index(cell.x)];
}

double Room::used_along(const Stretch& stretch) const {
  double most = 0;
  for (std::size_t i = 0; i < places_along; ++i) {
    const double part = static_cast<double>(i) / (places_along - 1);
    most = std::max(most,
                    used_at(stretch.place + ((stretch.before + stretch.after) * part - stretch.before) * stretch.way));
  }
  return most;
}

glm::dvec2 Room::nearest(const Stretch& wanted, std::span<const glm::dvec2> taken) const {
  if (is_along(wanted)) return wanted.place;
  const double here = used_along(wanted);
  struct Candidate {
    glm::dvec2 place{0};
    double used = 0;
  };
  std::vector<Candidate> candidates;
  double least = HUGE_VAL;
  const auto look = [&](glm::dvec2 place) {
    const Stretch moved{place, wanted.way, wanted.before, wanted.after};
    const glm::dvec2 start = glm::abs(place - wanted.before * wanted.way),
                     end = glm::abs(place + wanted.after * wanted.way);
    if (std::max(start.x, end.x) > half_.x || std::max(start.y, end.y) > half_.y) return;
    if (std::ranges::any_of(taken, [&](glm::dvec2 other) { return glm::distance(other, place) < apart; })) return;
    candidates.push_back({place, std::max(used_along(moved), room_enough)});
    least = std::min(least, candidates.back().used);
  };
  for (std::size_t row = 0; row < cells_a_side; ++row)
    for (std::size_t column = 0; column < cells_a_side; ++column)
      look(half_ * ((glm::dvec2(column, row) + 0.5) / (0.5 * cells_a_side) - 1.0));
  if (!(least < here - hardly_better)) return taken.empty() ? wanted.place : nearest(wanted);
  glm::dvec2 best = wanted.place;
  double distance = HUGE_VAL;
  for (const Candidate& each : candidates)
    if (const double far = glm::distance(each.place, wanted.place); each.used < least + hardly_better && far < distance)
      distance = far, best = each.place;
  return best;
}

}  // namespace wale
