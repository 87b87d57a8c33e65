#include "compiler/preview/exhibit.hpp"

#include <algorithm>
#include <cmath>

#include "compiler/measure/coarseness.hpp"
#include "compiler/read/relief.hpp"
#include "wale/picture.hpp"

namespace wale {
namespace {

/// N; smaller forces count as none: a hundredth of what the finest joystick commands
constexpr float no_force = 1e-4f;
/// m/s; a fast stroke of the hand over a surface
constexpr double brisk = 0.5;
constexpr int periods_shown = 8;

std::vector<float> reliefs(const Bank& bank, const Memory* memory, const std::vector<glm::vec2>& positions) {
  std::vector<float> heights(positions.size());
  surface_coarsely(bank, memory, positions, heights);
  for (float& height : heights) {
    if (!std::isfinite(height)) height = 0;
  }
  return heights;
}

std::vector<Force> forces_on(const Bank& bank, const std::vector<Hand>& hands) {
  std::vector<Force> forces(hands.size());
  tick_coarsely(bank, hands, forces);
  return forces;
}

double spread(const std::vector<float>& values) {
  const auto [least, most] = std::minmax_element(values.begin(), values.end());
  return static_cast<double>(*most) - *least;
}

double in_three_digits(double value) {
  const double unit = std::pow(10.0, std::floor(std::log10(value)) - 2);
  return std::round(value / unit) * unit;
}

struct Look {
  double relief = 0, force = 0;  // range of each
};

/// The variation of relief and of the force at rest over a set of positions.
Look look_at(const Bank& bank, const Memory* memory, const std::vector<glm::vec2>& positions,
             std::vector<Force>* at_rest = nullptr) {
  std::vector<Hand> hands;
  for (glm::vec2 position : positions) hands.push_back({position, {}});
  const auto forces = forces_on(bank, hands);
  Look look{spread(reliefs(bank, memory, positions)), 0};
  for (Force force : forces) look.force = std::max(look.force, std::hypot(double{force.x}, double{force.y}));
  if (at_rest) *at_rest = forces;
  return look;
}

/// The force along the axis; for a pad, the amplitude of its shaking.
int component_of(const Bank& bank, const Exhibit& exhibit) {
  return bank.program().description().vibrates() ? 0 : exhibit.axis;
}

}  // namespace

Exhibit exhibit_of(const Bank& bank, const Memory* memory) {
  const PatchSize size = bank.size();
  Exhibit exhibit;
  exhibit.side = std::min(size.width, size.height);
  const double limit = bank.program().description().device.speed_limit;
  exhibit.speed = limit > 0 ? std::min(limit, brisk) : brisk;

  // A lattice over the whole patch with an odd number of points, so that no regular texture is in step with it.
  constexpr int lattice = 61;
  std::vector<glm::vec2> positions;
  for (int row = 0; row < lattice; ++row) {
    for (int column = 0; column < lattice; ++column) {
      const double wander = 0.37 * row + 0.61 * column;
      const double u = (column + wander - std::floor(wander)) / lattice, v = (row + 0.5) / lattice;
      positions.emplace_back((u - 0.5) * size.width, (v - 0.5) * size.height);
    }
  }
  std::vector<Force> at_rest;
  const Look whole = look_at(bank, memory, positions, &at_rest);
  exhibit.has_relief = whole.relief > 0;
  exhibit.pushes_at_rest = whole.force > no_force;
  for (glm::vec2 way : {glm::vec2(1, 0), glm::vec2(0, -1)}) {
    std::vector<Hand> moving;
    for (glm::vec2 position : positions) moving.push_back({position, way * static_cast<float>(exhibit.speed)});
    const auto forces = forces_on(bank, moving);
    for (std::size_t i = 0; i < forces.size(); ++i) {
      const Force change = forces[i] - at_rest[i];
      exhibit.resists_motion = exhibit.resists_motion || std::hypot(change.x, change.y) > no_force;
    }
  }

  if (exhibit.has_relief) {
    Relief relief;
    if (!bank.program().description().vibrates()) relief = static_force(bank).relief;
    // A surface may be shown and not be felt.
    if (!relief.regular()) relief = picture_relief(bank, memory);
    if (relief.regular()) exhibit.period = relief.period;
    // The period is read from samples, so its last digits are random: 19.9973 mm is shown as 20.
    // With marks the whole patch is shown: they may be anywhere on it.
    const bool marked = !bank.program().description().picture.marks.empty();
    if (exhibit.period && !marked)
      exhibit.side = std::min(exhibit.side, in_three_digits(periods_shown * *exhibit.period));
  }

  // The section runs along x through the centre, unless nothing changes there: then along y, or between rows of bumps.
  constexpr int points = 997;
  const auto along = [&](int axis, double aside) {
    std::vector<glm::vec2> line(points, glm::vec2(static_cast<float>(aside)));
    for (int i = 0; i < points; ++i) {
      line[static_cast<std::size_t>(i)][axis] = static_cast<float>(((i + 0.5) / points - 0.5) * exhibit.side);
    }
    const Look look = look_at(bank, memory, line);
    return exhibit.has_relief ? look.relief : look.force;
  };
  const double enough = 0.1 * (exhibit.has_relief ? whole.relief : whole.force);
  const double off_centre = exhibit.period.value_or(exhibit.side / 8) / 4;
  for (double aside : {0.0, off_centre}) {
    for (int axis : {0, 1}) {
      if (along(axis, aside) <= enough) continue;
      exhibit.axis = axis;
      exhibit.aside = aside;
      return exhibit;
    }
  }
  return exhibit;
}

Profile height_along(const Bank& bank, const Memory* memory, const Exhibit& exhibit, int count) {
  std::vector<glm::vec2> line(static_cast<std::size_t>(count), glm::vec2(static_cast<float>(exhibit.aside)));
  Profile profile;
  for (int i = 0; i < count; ++i) {
    profile.at.push_back((i / (count - 1.0) - 0.5) * exhibit.side);
    line[static_cast<std::size_t>(i)][exhibit.axis] = static_cast<float>(profile.at.back());
  }
  const auto heights = reliefs(bank, memory, line);
  profile.values.assign(heights.begin(), heights.end());
  return profile;
}

Profile force_along(const Bank& bank, const Exhibit& exhibit, double speed, int count) {
  std::vector<Hand> hands(static_cast<std::size_t>(count));
  Profile profile;
  for (int i = 0; i < count; ++i) {
    profile.at.push_back((i / (count - 1.0) - 0.5) * exhibit.side);
    Hand& hand = hands[static_cast<std::size_t>(i)];
    hand.position = glm::vec2(static_cast<float>(exhibit.aside));
    hand.position[exhibit.axis] = static_cast<float>(profile.at.back());
    hand.velocity[exhibit.axis] = static_cast<float>(speed);
  }
  for (Force force : forces_on(bank, hands)) profile.values.push_back(force[component_of(bank, exhibit)]);
  return profile;
}

Profile force_against_speed(const Bank& bank, const Exhibit& exhibit, int count) {
  std::vector<Hand> hands(static_cast<std::size_t>(count));
  Profile profile;
  for (int i = 0; i < count; ++i) {
    profile.at.push_back((i / (count - 1.0) - 0.5) * 2 * exhibit.speed);
    hands[static_cast<std::size_t>(i)].velocity[exhibit.axis] = static_cast<float>(profile.at.back());
  }
  for (Force force : forces_on(bank, hands)) profile.values.push_back(force[component_of(bank, exhibit)]);
  return profile;
}

glm::vec2 pixel_position(const Exhibit& exhibit, int column, int row, int count) {
  const auto place = [&](int i) { return ((i + 0.5) / count - 0.5) * exhibit.side; };
  return {static_cast<float>(place(column)), static_cast<float>(-place(row))};
}

}  // namespace wale
