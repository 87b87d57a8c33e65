#include "compiler/read/bent_wall.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <vector>

#include "compiler/read/tolerances.hpp"

namespace wale {
namespace {

/// The mean square of what is left beside a law and a line, N^2.
template <class Law>
double left_beside(const std::vector<glm::dvec2>& places, std::vector<glm::dvec2> forces, const Law& law) {
  for (std::size_t i = 0; i < forces.size(); ++i) forces[i] -= law.at(places[i]);
  const LinearForce line = linear_force(places, forces);
  for (std::size_t i = 0; i < forces.size(); ++i) forces[i] -= line.at(places[i]);
  return mean_square(forces);
}

struct PushAt {
  double along = 0, push = 0;  ///< m into the wall, N against a hand that goes in
};

/// The push as exp(scale) * (along - onset)^power: how much its logarithm is off, for the best power.
struct PowerLaw {
  double onset = 0, power = 0, scale = 0, off = HUGE_VAL;

  double at(double depth) const { return std::exp(scale) * std::pow(depth, power); }
  double depth_of(double push) const { return std::pow(push * std::exp(-scale), 1 / power); }
};
PowerLaw power_from(const std::vector<PushAt>& points, double onset) {
  double n = 0, x = 0, y = 0, xx = 0, xy = 0, yy = 0;
  for (const PushAt& each : points) {
    const double depth = std::log(each.along - onset), push = std::log(each.push);
    n += 1, x += depth, y += push, xx += depth * depth, xy += depth * push, yy += push * push;
  }
  const double spread = xx - x * x / n, power = spread > 0 ? (xy - x * y / n) / spread : 0;
  return {onset, power, (y - power * x) / n, std::sqrt(std::max(0.0, yy - y * y / n - power * (xy - x * y / n)) / n)};
}

/// The power law that fits best, of those that begin between `earliest` and the first point.
PowerLaw best_power(const std::vector<PushAt>& points, double earliest) {
  constexpr int tries = 200;
  PowerLaw best;
  for (int i = 0; i < tries; ++i) {
    const PowerLaw law = power_from(points, earliest + (points.front().along - earliest) * i / tries);
    if (law.off < best.off) best = law;
  }
  return best;
}

/// The one feature along a straight wall's direction that explains the forces much better than the wall, if any.
std::optional<Feature> bent_push(const StillForces& whole, const std::vector<glm::dvec2>& forces,
                                 const Wall& straight) {
  constexpr double much_better = 0.2;  // of what a straight wall leaves
  constexpr double along_it = 0.99;    // cosine
  const std::vector<glm::dvec2> places = cell_means(whole.side, whole.places),
                                means = cell_means(whole.side, forces);
  const double left = left_beside(places, means, straight);
  if (left < least_force * least_force) return std::nullopt;
  std::vector<Feature> features = find_features(places, means, false);
  if (features.empty()) return std::nullopt;
  refine_features(features, whole.places, forces);
  if (features.size() != 1 || features.front().radial || !features.front().monotone) return std::nullopt;
  if (std::abs(glm::dot(features.front().direction, straight.inward)) < along_it) return std::nullopt;
  if (left_beside(places, means, features.front()) > much_better * left) return std::nullopt;
  return std::move(features.front());
}

/// A feature's push against a hand that goes along `inward`, from the flat side in, less what is pushed there.
std::vector<PushAt> pushes_into(const Feature& feature, glm::dvec2 inward) {
  constexpr std::size_t flat_part = 40;  // of the profile: before the face
  const bool turned = glm::dot(feature.direction, inward) < 0;
  std::vector<PushAt> all;
  for (std::size_t i = 0; i < feature.profile.size(); ++i) {
    const std::size_t from = turned ? feature.profile.size() - 1 - i : i;
    const double along = (turned ? -1 : 1) * (feature.low + feature.step * static_cast<double>(from));
    all.push_back({along, -glm::dot(feature.profile[from], inward)});
  }
  const double flat = all[all.size() / flat_part].push;
  for (PushAt& each : all) each.push -= flat;
  return all;
}

}  // namespace

std::optional<BentWall> bent_wall(const StillForces& whole, const std::vector<glm::dvec2>& forces, const Wall& straight,
                                  double limit) {
  constexpr double least_part = 0.03, most_part = 0.97;  // of the largest push: where the power shows
  constexpr double touched = 2e-3;                       // of the largest push: the hand is inside
  constexpr double before_touched = 0.15;                // of the depth: it begins so much earlier at most
  constexpr double least_power = 0.3, most_power = 8, straight_enough = 0.03;
  constexpr std::size_t fewest = 8;
  constexpr std::size_t before_face = 20;  // part of the profile: what has grown from the patch's edge on has no face
  if (straight.round() || straight.preload > 0) return std::nullopt;
  const std::optional<Feature> push = bent_push(whole, forces, straight);
  if (!push) return std::nullopt;
  const double sense = glm::dot(push->direction, straight.inward) > 0 ? 1 : -1;
  const std::vector<PushAt> all = pushes_into(*push, sense * push->direction);
  const double most = std::min(std::ranges::max(all, {}, &PushAt::push).push, limit);
  const auto first = [&](double part) {
    return std::ranges::find_if(all, [&](const PushAt& each) { return each.push >= part * most; });
  };
  const auto inside = first(touched), deepest = first(most_part);
  if (inside == all.begin() || inside == all.end() || deepest == all.end()) return std::nullopt;
  if (inside - all.begin() < static_cast<std::ptrdiff_t>(all.size() / before_face)) return std::nullopt;
  std::vector<PushAt> points;
  std::copy_if(first(least_part), deepest, std::back_inserter(points),
               [](const PushAt& each) { return each.push > 0; });
  if (points.size() < fewest) return std::nullopt;
  const PowerLaw law = best_power(points, inside->along - before_touched * (deepest->along - inside->along));
  const bool has_power = law.power > least_power && law.power < most_power && law.off < straight_enough;
  BentWall bent{.wall = {.inward = sense * push->direction}, .push = *push};
  if (!has_power) {
    bent.wall.offset = inside->along, bent.wall.power = 0;
    bent.wall.stiffness = deepest->push / (deepest->along - inside->along);
    return bent;
  }
  const double end = glm::dot(glm::abs(bent.wall.inward), 0.5 * whole.size) + glm::dot(bent.wall.inward, whole.centre);
  const double depth = std::min(end - law.onset, law.depth_of(limit));
  bent.wall.offset = law.onset, bent.wall.power = law.power, bent.wall.stiffness = law.at(depth) / depth;
  return bent;
}

}  // namespace wale
