#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

#include "compiler/read/obstacles.hpp"

namespace wale {
namespace {

constexpr std::size_t profile_values = 1024;

Feature feature_of(const Wall& wall, std::span<const glm::dvec2> places) {
  Feature feature{.radial = wall.round(), .origin = wall.centre, .direction = wall.inward};
  double low = HUGE_VAL, high = -HUGE_VAL;
  for (const glm::dvec2& place : places) {
    const double at = feature.coordinate(place);
    low = std::min(low, at), high = std::max(high, at);
  }
  feature.step = (high - low) / static_cast<double>(profile_values);
  // One of the profile's places is where the wall begins; a jump is in the middle between two.
  const auto before = static_cast<std::size_t>(std::max(1.0, std::ceil((wall.offset - low) / feature.step)));
  const double begins = static_cast<double>(before) + (wall.preload != 0 ? 0.5 : 0);
  if (wall.preload != 0) feature.jump = wall.offset;
  feature.low = wall.offset - begins * feature.step;
  for (std::size_t i = 0; feature.low + feature.step * (static_cast<double>(i) - 1) < high || i < before + 2; ++i) {
    const double beyond = feature.step * (static_cast<double>(i) - begins);
    const double deep = wall.fills ? -beyond : beyond;
    const double push = deep > 0 ? wall.preload + wall.stiffness * deep : 0;
    // Outward from a round wall's centre.
    feature.profile.push_back(wall.round() ? glm::dvec2(wall.fills ? push : -push, 0) : -push * wall.inward);
  }
  for (const glm::dvec2& force : feature.profile) feature.range = std::max(feature.range, glm::length(force));
  feature.monotone = true;
  return feature;
}

Feature feature_of(const StaticStep& step, std::span<const glm::dvec2> places) {
  Feature feature{.direction = step.way};
  double low = HUGE_VAL, high = -HUGE_VAL;
  for (const glm::dvec2& place : places) {
    const double at = feature.coordinate(place);
    low = std::min(low, at), high = std::max(high, at);
  }
  feature.step = (high - low) / static_cast<double>(profile_values);
  // The jump is in the middle between two of the profile's places.
  const auto before = std::ceil((step.offset - low) / feature.step);
  feature.low = step.offset - (before + 0.5) * feature.step;
  for (double at = feature.low; at < high + feature.step; at += feature.step)
    feature.profile.push_back(StaticStep{{1, 0}, step.offset, step.width, step.change}.at({at, 0}));
  feature.range = glm::length(step.change);
  feature.monotone = true;
  return feature;
}

Feature feature_of(const Hill& hill, std::span<const glm::dvec2> places) {
  Feature feature{.radial = true, .origin = hill.top, .smooth = true};
  double farthest = hill.reach;
  for (const glm::dvec2& place : places) farthest = std::max(farthest, feature.coordinate(place));
  feature.step = hill.spacing();
  for (const double push : hill.push) feature.profile.emplace_back(push, 0);
  while (feature.step * static_cast<double>(feature.profile.size()) <= farthest) feature.profile.emplace_back(0);
  for (const glm::dvec2& force : feature.profile) feature.range = std::max(feature.range, glm::length(force));
  return feature;
}

}  // namespace

std::vector<Feature> features_of(const Obstacles& found, std::span<const glm::dvec2> places) {
  std::vector<Feature> features;
  for (const Wall& each : found.walls) features.push_back(feature_of(each, places));
  for (const StaticStep& each : found.steps) features.push_back(feature_of(each, places));
  if (found.hill) features.push_back(feature_of(*found.hill, places));
  return features;
}

}  // namespace wale
