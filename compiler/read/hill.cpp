#include "compiler/read/hill.hpp"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <numbers>
#include <vector>

namespace wale {
namespace {

constexpr double least_curve = 1e-3;                          // N: of a second difference
constexpr double of_the_largest = 1e-2;                       // of a large second difference
constexpr double of_the_noise = 6;                            // times a small one
constexpr double large = 0.95, small = 0.15;                  // quantiles of them
constexpr std::size_t fewest_curved = 16;                     // cells
constexpr double most_curved = 0.75;                          // of the cells
constexpr double curved_inside = 0.55, curved_outside = 0.3;  // of the cells, at least and at most
constexpr double least_outside = 0.2;                         // of the cells
constexpr double wider = 1.2;  // times the radius of what is curved: the foot of a hill is nearly even
constexpr std::size_t values = 32;

double quantile(std::vector<double> all, double share) {
  const auto at = all.begin() + static_cast<std::ptrdiff_t>(share * static_cast<double>(all.size() - 1));
  std::ranges::nth_element(all, at);
  return *at;
}

/// The cells of a lattice with their forces moved to the cells' middles: a mean is that of places as if by chance.
class Cells {
 public:
  Cells(std::span<const glm::dvec2> places, std::span<const glm::dvec2> forces)
      : side_(static_cast<std::size_t>(std::lround(std::sqrt(static_cast<double>(places.size()))))) {
    glm::dvec2 low(HUGE_VAL), high(-HUGE_VAL);
    for (const glm::dvec2& place : places) low = glm::min(low, place), high = glm::max(high, place);
    const auto apart = static_cast<double>(side_ - 1);
    cell_ = (high - low) / apart;
    even_.assign(forces.begin(), forces.end());
    for (std::size_t i = 0; i < places.size(); ++i) {
      const std::size_t column = std::clamp<std::size_t>(i % side_, 1, side_ - 2),
                        row = std::clamp<std::size_t>(i / side_, 1, side_ - 2), at = row * side_ + column;
      middles_.push_back(low + cell_ * glm::dvec2(i % side_, i / side_));
      const glm::dvec2 off = middles_.back() - places[i];
      even_[i] += off.x * (forces[at + 1] - forces[at - 1]) / (places[at + 1].x - places[at - 1].x) +
                  off.y * (forces[at + side_] - forces[at - side_]) / (places[at + side_].y - places[at - side_].y);
    }
  }

  /// N: how much a force is curved there.
  double curve(std::size_t i) const {
    return glm::length(even_[i - 1] + even_[i + 1] + even_[i - side_] + even_[i + side_] - 4.0 * even_[i]);
  }
  /// Whether it has neighbours on all sides.
  bool is_inner(std::size_t i) const {
    return i % side_ > 0 && i % side_ + 1 < side_ && i >= side_ && i + side_ < even_.size();
  }
  std::size_t size() const { return even_.size(); }
  glm::dvec2 middle(std::size_t i) const { return middles_[i]; }

 private:
  std::size_t side_;
  glm::dvec2 cell_{0};
  std::vector<glm::dvec2> even_, middles_;
};

}  // namespace

std::optional<Hill> likely_hill(std::span<const glm::dvec2> places, std::span<const glm::dvec2> forces) {
  if (places.size() < 100) return std::nullopt;
  const Cells cells(places, forces);
  std::vector<glm::dvec2> inner, curved;
  std::vector<double> curves;
  for (std::size_t i = 0; i < cells.size(); ++i)
    if (cells.is_inner(i)) inner.push_back(cells.middle(i)), curves.push_back(cells.curve(i));
  const double least =
      std::max({least_curve, of_the_largest * quantile(curves, large), of_the_noise * quantile(curves, small)});
  for (std::size_t i = 0; i < inner.size(); ++i)
    if (curves[i] > least) curved.push_back(inner[i]);
  const auto all = static_cast<double>(inner.size());
  if (curved.size() < fewest_curved || static_cast<double>(curved.size()) > most_curved * all) return std::nullopt;
  // Lines across the patch have fewer cells than a hill: the middle of all is in the hill.
  const auto middle_of = [&](auto coordinate) {
    std::vector<double> along;
    for (const glm::dvec2& place : curved) along.push_back(coordinate(place));
    return quantile(std::move(along), 0.5);
  };
  glm::dvec2 top(middle_of([](glm::dvec2 place) { return place.x; }),
                 middle_of([](glm::dvec2 place) { return place.y; }));
  double radius = 0;
  for (int turn = 0; turn < 12; ++turn) {
    std::vector<double> far;
    for (const glm::dvec2& place : curved)
      if (radius == 0 || glm::distance(place, top) < 1.3 * radius) far.push_back(glm::distance(place, top));
    if (far.size() < fewest_curved) return std::nullopt;
    // Half of a disc lies within 0.707 of its radius.
    radius = std::numbers::sqrt2 * quantile(std::move(far), 0.5);
    glm::dvec2 sum{0};
    double count = 0;
    for (const glm::dvec2& place : curved)
      if (glm::distance(place, top) < radius) sum += place, count += 1;
    if (count > 0) top = sum / count;
  }
  double inside = 0, inside_curved = 0;
  for (std::size_t i = 0; i < inner.size(); ++i)
    if (glm::distance(inner[i], top) < radius) inside += 1, inside_curved += curves[i] > least ? 1 : 0;
  const double outside_curved = static_cast<double>(curved.size()) - inside_curved;
  if (inside_curved < curved_inside * inside || outside_curved > curved_outside * (all - inside)) return std::nullopt;
  double reach = wider * radius;
  const auto outside = [&] {
    return static_cast<double>(
        std::ranges::count_if(inner, [&](glm::dvec2 place) { return glm::distance(place, top) > reach; }));
  };
  while (reach > radius && outside() < least_outside * all) reach *= 0.97;
  if (outside() < least_outside * all) return std::nullopt;
  return Hill{top, reach, std::vector<double>(values, 0)};
}

}  // namespace wale
