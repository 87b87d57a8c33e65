#include "compiler/read/features.hpp"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <numbers>
#include <optional>

#include "compiler/read/still_forces.hpp"

namespace wale {
namespace {

constexpr std::size_t coarse_bins = 64, fine_bins = 96, finest_bins = 288;
constexpr std::size_t bins_of_means = 32;
constexpr std::size_t few_places = 2500;  // too few for fine bins: means over a lattice
constexpr std::size_t most_features = 2;
constexpr int directions_tried = 12;
constexpr double nearly_all = 0.9;       // of the mean square
constexpr double exactly = 0.015;        // of the mean square, left by features that are all there is
constexpr double worth_a_feature = 0.3;  // of what is left
constexpr double plainly = 0.06;         // of a profile's range: a turn that counts
constexpr double plain_jump = 0.2;       // of a profile's range, between the second next values
constexpr double hardly_bent = 0.01;     // of a profile's range: its deviation from a line is rounding
constexpr int most_turns = 4;            // of a profile; a texture has more

glm::dvec2 outward(glm::dvec2 place, glm::dvec2 origin) {
  const glm::dvec2 off = place - origin;
  const double far = glm::length(off);
  return far > 0 ? off / far : glm::dvec2(0);
}

/// A force by its part away from a point and its part around it.
glm::dvec2 about(glm::dvec2 force, glm::dvec2 out) {
  return {glm::dot(force, out), glm::dot(force, glm::dvec2(-out.y, out.x))};
}

/// Near its point a radial profile has parts without a place: these go on evenly from one neighbour to the next.
void fill_gaps(std::vector<glm::dvec2>& profile, const std::vector<double>& counts) {
  std::size_t before = 0;
  for (std::size_t i = 0; i < profile.size(); ++i) {
    if (!(counts[i] > 0)) continue;
    for (std::size_t gap = before + 1; gap < i; ++gap) {
      const double part = static_cast<double>(gap - before) / static_cast<double>(i - before);
      profile[gap] = (1 - part) * profile[before] + part * profile[i];
    }
    before = i;
  }
}

/// Fits a profile of so many values along a feature's coordinate, and returns what share of the mean square it
/// explains.
double fit_profile(Feature& feature, std::span<const glm::dvec2> places, std::span<const glm::dvec2> forces,
                   std::size_t bins) {
  if (places.size() < few_places) bins = std::min(bins, bins_of_means);
  std::vector<double> at(places.size());
  double low = HUGE_VAL, high = -HUGE_VAL;
  for (std::size_t i = 0; i < places.size(); ++i) at[i] = feature.coordinate(places[i]);
  for (const double each : at) low = std::min(low, each), high = std::max(high, each);
  if (!(high > low)) return 0;
  feature.step = (high - low) / static_cast<double>(bins);
  feature.low = low + 0.5 * feature.step;
  feature.profile.assign(bins, glm::dvec2(0));
  std::vector<double> counts(bins, 0);
  const double scale = static_cast<double>(bins) / (high - low);
  const int last = static_cast<int>(bins) - 1;
  double whole = 0, kept = 0;
  for (std::size_t i = 0; i < places.size(); ++i) {
    const int bin = std::min(static_cast<int>((at[i] - low) * scale), last);
    whole += glm::dot(forces[i], forces[i]);
    feature.profile[bin] += feature.radial ? about(forces[i], outward(places[i], feature.origin)) : forces[i];
    counts[bin] += 1;
  }
  double used = 0;
  for (std::size_t i = 0; i < bins; ++i) {
    if (!(counts[i] > 0)) continue;
    kept += glm::dot(feature.profile[i], feature.profile[i]) / counts[i];
    feature.profile[i] /= counts[i];
    used += 1;
  }
  const auto count = static_cast<double>(places.size());
  // Where a direction ends in a corner there are too few places for a mean.
  const double few = 0.15 * count / static_cast<double>(bins);
  for (std::size_t i = bins / 2; i < bins; ++i)
    if (counts[i] < few) feature.profile[i] = feature.profile[i - 1];
  for (std::size_t i = bins / 2; i-- > 0;)
    if (counts[i] < few && !feature.radial) feature.profile[i] = feature.profile[i + 1];
  if (feature.radial) fill_gaps(feature.profile, counts);
  return whole > 0 && count > used ? 1 - (whole - kept) / whole * count / (count - used) : 0;
}

/// How often a profile turns, where a turn is more than a small part of its range.
int turns_of(const Feature& feature) {
  // Along the component with the larger range.
  glm::dvec2 low(HUGE_VAL), high(-HUGE_VAL);
  for (const glm::dvec2& force : feature.profile) low = glm::min(low, force), high = glm::max(high, force);
  const int axis = high.x - low.x >= high.y - low.y ? 0 : 1;
  // A force that is nearly the same everywhere does not turn.
  const double least = plainly * std::max(high[axis] - low[axis], 0.5 * std::max(std::abs(low[axis]), high[axis]));
  double top = feature.profile.front()[axis], bottom = top;
  int turns = 0, going = 0;
  for (const glm::dvec2& force : feature.profile) {
    const double here = force[axis];
    if (going >= 0) top = std::max(top, here);
    if (going <= 0) bottom = std::min(bottom, here);
    if (going >= 0 && here < top - least) {
      turns += going > 0, going = -1, bottom = here;
    } else if (going <= 0 && here > bottom + least) {
      turns += going < 0, going = 1, top = here;
    }
  }
  return turns;
}

/// Whether a profile turns as often as a texture does, by itself or about its own straight line: so a slow wave on a
/// strong spring looks, which pushes ever more all the same.
bool turns_often(const Feature& feature) {
  if (turns_of(feature) > most_turns) return true;
  const auto count = static_cast<double>(feature.profile.size());
  const double middle = 0.5 * (count - 1);
  glm::dvec2 mean{0}, slope{0}, lowest(HUGE_VAL), highest(-HUGE_VAL);
  double squares = 0;
  for (std::size_t i = 0; i < feature.profile.size(); ++i) {
    const double off = static_cast<double>(i) - middle;
    mean += feature.profile[i] / count, slope += off * feature.profile[i], squares += off * off;
    lowest = glm::min(lowest, feature.profile[i]), highest = glm::max(highest, feature.profile[i]);
  }
  slope /= std::max(squares, 1.0);
  Feature bent = feature;
  glm::dvec2 low(HUGE_VAL), high(-HUGE_VAL);
  for (std::size_t i = 0; i < bent.profile.size(); ++i) {
    bent.profile[i] -= mean + (static_cast<double>(i) - middle) * slope;
    low = glm::min(low, bent.profile[i]), high = glm::max(high, bent.profile[i]);
  }
  return glm::length(high - low) > hardly_bent * glm::length(highest - lowest) && turns_of(bent) > most_turns;
}

/// The direction, or the origin, about the given one with which a profile explains most.
template <typename Vary>
double improve(Feature& feature, std::span<const glm::dvec2> places, std::span<const glm::dvec2> forces, double step,
               double finest, int ways, const Vary& vary) {
  double best = fit_profile(feature, places, forces, coarse_bins);
  while (step > finest) {
    bool better = false;
    for (int way = 0; way < ways; ++way) {
      Feature other = vary(feature, way, step);
      const double here = fit_profile(other, places, forces, coarse_bins);
      if (here > best) best = here, feature = other, better = true;
    }
    if (!better) step *= 0.5;
  }
  return best;
}

Feature along(double angle) { return {.direction = {std::cos(angle), std::sin(angle)}}; }

/// The feature that explains most; nothing if it explains too little.
std::optional<Feature> next_feature(std::span<const glm::dvec2> places, std::span<const glm::dvec2> forces) {
  Feature best;
  double explained = 0;
  for (int i = 0; i < directions_tried; ++i) {
    Feature planar = along(i * std::numbers::pi / directions_tried);
    const double here = fit_profile(planar, places, forces, coarse_bins);
    if (here > explained) explained = here, best = planar;
  }
  Feature radial{.radial = true};
  const double round = fit_profile(radial, places, forces, coarse_bins);
  // A round force about a place far away is a straight one, and ever more so the farther it goes.
  glm::dvec2 farthest{0};
  for (const glm::dvec2& place : places) farthest = glm::max(farthest, 2.0 * glm::abs(place));
  const auto moved = [farthest](Feature feature, int way, double step) {
    const glm::dvec2 there = feature.origin + step * glm::dvec2(way == 0   ? 1
                                                                : way == 1 ? -1
                                                                           : 0,
                                                                way == 2   ? 1
                                                                : way == 3 ? -1
                                                                           : 0);
    if (std::abs(there.x) <= farthest.x && std::abs(there.y) <= farthest.y) feature.origin = there;
    return feature;
  };
  const auto turned = [](const Feature& feature, int way, double step) {
    return along(std::atan2(feature.direction.y, feature.direction.x) + (way == 0 ? step : -step));
  };
  if (explained > 0.2 * worth_a_feature)
    explained = improve(best, places, forces, 0.5 * std::numbers::pi / directions_tried, 2e-3, 2, turned);
  if (explained < nearly_all) {
    // A radial force may be about any place: first where the forces are strongest.
    glm::dvec2 centre{0};
    double weight = 0;
    for (std::size_t i = 0; i < places.size(); ++i) {
      const double power = glm::dot(forces[i], forces[i]);
      centre += power * places[i], weight += power;
    }
    Feature aside{.radial = true, .origin = weight > 0 ? centre / weight : glm::dvec2(0)};
    if (fit_profile(aside, places, forces, coarse_bins) > round) radial = aside;
    const double about = improve(radial, places, forces, 8e-3, 0.2e-3, 4, moved);
    if (about > explained) explained = about, best = radial;
  }
  if (explained < worth_a_feature) return std::nullopt;
  return best;
}

/// Fits the profiles of all features in turn, and returns what they leave.
std::vector<glm::dvec2> fit_together(std::vector<Feature>& features, std::span<const glm::dvec2> places,
                                     std::span<const glm::dvec2> forces, std::size_t bins) {
  std::vector<glm::dvec2> rest(forces.begin(), forces.end());
  for (int turn = 0; turn < (features.size() > 1 ? 2 : 1); ++turn)
    for (Feature& each : features) {
      if (turn > 0) add_feature(each, 1, places, rest);
      fit_profile(each, places, rest, bins);
      add_feature(each, -1, places, rest);
    }
  return rest;
}

/// Turns the directions of two features to where they explain most together; alone, one leans towards the other.
double turn_together(std::vector<Feature>& features, std::span<const glm::dvec2> places,
                     std::span<const glm::dvec2> forces, double left) {
  for (double step = 0.1; step > 1e-3; step *= 0.5)
    for (std::size_t i = 0; i < features.size(); ++i)
      for (const double turn : {step, -step}) {
        if (features[i].radial) continue;
        std::vector<Feature> other = features;
        other[i] = along(std::atan2(other[i].direction.y, other[i].direction.x) + turn);
        const double here = mean_square(fit_together(other, places, forces, fine_bins));
        if (here < left) left = here, features = std::move(other);
      }
  return left;
}

/// Turns or moves a feature, whose profile is fitted, by one step of Gauss and Newton.
void place_better(Feature& feature, std::span<const glm::dvec2> places, std::span<const glm::dvec2> forces) {
  const auto slope_at = [&](glm::dvec2 place) {
    const double at = std::round((feature.coordinate(place) - feature.low) / feature.step);
    const auto last = static_cast<double>(feature.profile.size() - 2);
    const auto bin = static_cast<std::size_t>(std::clamp(at, 1.0, last));
    return (feature.profile[bin + 1] - feature.profile[bin - 1]) / (2 * feature.step);
  };
  double xx = 0, xy = 0, yy = 0;
  glm::dvec2 sums{0};
  const glm::dvec2 across(-feature.direction.y, feature.direction.x);
  for (std::size_t i = 0; i < places.size(); ++i) {
    const glm::dvec2 off = forces[i] - feature.at(places[i]), slope = slope_at(places[i]);
    if (!feature.radial) {
      const double aside = glm::dot(places[i], across);
      xx += glm::dot(slope, slope) * aside * aside, sums.x += glm::dot(slope, off) * aside;
      continue;
    }
    const double far = glm::length(places[i] - feature.origin);
    if (far < 2 * feature.step) continue;
    const glm::dvec2 out = outward(places[i], feature.origin), way(-out.y, out.x);
    // Moving the origin changes the distance, and the direction of the push.
    const double push = glm::dot(feature.at(places[i]), out) / far;
    const double around = glm::dot(feature.at(places[i]), way) / far;
    const glm::dvec2 by_x = -out.x * (slope.x * out + slope.y * way) - way.x * (push * way - around * out);
    const glm::dvec2 by_y = -out.y * (slope.x * out + slope.y * way) - way.y * (push * way - around * out);
    xx += glm::dot(by_x, by_x), xy += glm::dot(by_x, by_y), yy += glm::dot(by_y, by_y);
    sums += glm::dvec2(glm::dot(by_x, off), glm::dot(by_y, off));
  }
  const double area = xx * yy - xy * xy;
  if (!feature.radial && xx > 0) {
    feature.direction = glm::normalize(feature.direction + std::clamp(sums.x / xx, -0.05, 0.05) * across);
  } else if (feature.radial && area > 0) {
    feature.origin += glm::clamp(glm::dvec2(yy * sums.x - xy * sums.y, xx * sums.y - xy * sums.x) / area, -2e-3, 2e-3);
  }
}

}  // namespace

glm::dvec2 Feature::at(glm::dvec2 place) const {
  const double at = std::clamp((coordinate(place) - low) / step, 0.0, static_cast<double>(profile.size() - 1));
  const int first = std::min(static_cast<int>(at), static_cast<int>(profile.size()) - 2);
  const double part = at - first;
  const glm::dvec2 force = (1 - part) * profile[first] + part * profile[first + 1];
  if (!radial) return force;
  const glm::dvec2 out = outward(place, origin);
  return force.x * out + force.y * glm::dvec2(-out.y, out.x);
}

void add_feature(const Feature& feature, double times, std::span<const glm::dvec2> places,
                 std::span<glm::dvec2> forces) {
  for (std::size_t i = 0; i < places.size(); ++i) forces[i] += times * feature.at(places[i]);
}

bool Feature::jumps_at(glm::dvec2 place) const {
  if (smooth) return false;
  if (jump && std::abs(coordinate(place) - *jump) < step) return true;
  const double at = std::round((coordinate(place) - low) / step);
  const auto last = static_cast<double>(profile.size() - 1);
  const auto index = static_cast<std::size_t>(std::clamp(at, 0.0, last));
  const glm::dvec2 change = profile[std::min(index + 1, profile.size() - 1)] - profile[index == 0 ? 0 : index - 1];
  return glm::length(change) > plain_jump * range;
}

glm::dvec2 beside(const std::vector<Feature>& features, glm::dvec2 place, glm::dvec2 force) {
  for (const Feature& each : features) {
    if (each.jumps_at(place)) return glm::dvec2(0);
    force -= each.at(place);
  }
  return force;
}

std::vector<Feature> find_features(std::span<const glm::dvec2> places, std::span<const glm::dvec2> forces,
                                   bool may_turn) {
  const double all = mean_square(forces);
  if (!(all > 0)) return {};
  std::vector<Feature> found;
  std::vector<glm::dvec2> rest(forces.begin(), forces.end());
  double left = all;
  while (found.size() < most_features && left > exactly * all) {
    const auto next = next_feature(places, rest);
    if (!next) break;
    found.push_back(*next);
    rest = fit_together(found, places, forces, fine_bins);
    if (!may_turn && turns_often(found.back())) return {};
    left = mean_square(rest);
    if (found.size() > 1) left = turn_together(found, places, forces, left);
  }
  // A device limits each axis by itself, so what saturates is often the sum of a part along x and one along y.
  if (left > 1e-4 * all) {
    std::vector<Feature> axes = {along(0), along(0.5 * std::numbers::pi)};
    const double here = mean_square(fit_together(axes, places, forces, fine_bins));
    if (here < 0.5 * left) left = here, found = std::move(axes);
  }
  if (left > (1 - nearly_all) * all || (!may_turn && std::ranges::any_of(found, turns_often))) return {};
  return found;
}

void refine_features(std::vector<Feature>& features, std::span<const glm::dvec2> places,
                     std::span<const glm::dvec2> forces) {
  // Every fourth place is enough to turn a long face by; a hill may be small.
  const bool all_long = std::ranges::none_of(features, &Feature::radial);
  const std::size_t every = all_long ? 4 : 1;
  std::vector<glm::dvec2> some_places, some;
  for (std::size_t i = 0; i < places.size(); i += every) some_places.push_back(places[i]), some.push_back(forces[i]);
  for (int turn = 0; turn < 3; ++turn) {
    std::vector<glm::dvec2> rest = fit_together(features, some_places, some, all_long ? finest_bins / 2 : finest_bins);
    for (Feature& each : features) {
      add_feature(each, 1, some_places, rest);
      place_better(each, some_places, rest);
      add_feature(each, -1, some_places, rest);
    }
  }
  fit_together(features, places, forces, finest_bins);
  const auto turns_often_itself = [](const Feature& each) { return turns_of(each) > most_turns; };
  if (std::ranges::any_of(features, turns_often_itself)) {
    // A texture along the same direction shows in a fine profile; coarse parts are means over it. What turns often even
    // so is no feature.
    fit_together(features, places, forces, bins_of_means);
    if (std::erase_if(features, turns_often_itself) > 0) fit_together(features, places, forces, finest_bins);
  }
  for (Feature& each : features) {
    const int turns = turns_of(each);
    glm::dvec2 low(HUGE_VAL), high(-HUGE_VAL);
    for (const glm::dvec2& force : each.profile) low = glm::min(low, force), high = glm::max(high, force);
    each.range = glm::length(high - low);
    // In the very middle of a round feature the force is nothing: one that comes to an end further out has come back.
    const bool ends =
        each.radial && glm::length(each.profile.back()) < glm::length(each.profile.front()) - 0.5 * each.range;
    each.monotone = turns == 0 && !ends;
  }
}

}  // namespace wale
