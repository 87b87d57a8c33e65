#include "compiler/preview/exhibit.hpp"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

#include "compiler/measure/coarseness.hpp"
#include "compiler/measure/measure.hpp"
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

/// The force along the section; for a pad, the amplitude of its shaking as far as its actuator gives it.
double along_section(const Bank& bank, const Exhibit& exhibit, Force force) {
  if (const auto& shaker = bank.program().description().device.shaker) return given_by(*shaker, force).x;
  return force.x * exhibit.way.x + force.y * exhibit.way.y;
}

/// The force to the left of the section.
double across_section(const Exhibit& exhibit, Force force) {
  return force.y * exhibit.way.x - force.x * exhibit.way.y;
}

/// The distance along the section at point `i` of `count`, the ends among them.
double distance_at(const SectionRange& range, int i, int count) {
  return range.from + (i / (count - 1.0)) * (range.to - range.from);
}

/// Whether the patch outside a square around its centre has more to feel or to see than the square: a wall at the side,
/// a hill, a deeper relief. The rim, where textures fade, does not count.
bool is_more_outside(const Bank& bank, const Memory* memory, double side) {
  const PatchSize size = bank.size();
  const double rim = std::min({size.rim, 0.25f * size.width, 0.25f * size.height});
  std::vector<glm::vec2> inside, outside;
  constexpr int lattice = 96;
  for (int row = 0; row < lattice; ++row) {
    for (int column = 0; column < lattice; ++column) {
      const double wander = 0.37 * row + 0.61 * column;
      const double u = (column + wander - std::floor(wander)) / lattice - 0.5, v = (row + 0.5) / lattice - 0.5;
      inside.emplace_back(u * side, v * side);
      const glm::dvec2 place(u * (size.width - 2 * rim), v * (size.height - 2 * rim));
      if (std::max(std::abs(place.x), std::abs(place.y)) > side / 2) outside.emplace_back(place);
    }
  }
  if (outside.empty()) return false;
  const Look here = look_at(bank, memory, inside), there = look_at(bank, memory, outside);
  constexpr double more = 1.15;
  return there.force > more * here.force + no_force || there.relief > more * here.relief;
}

}  // namespace

SectionRange section_range(const Exhibit& exhibit) {
  const double middle = glm::dot(exhibit.centre, exhibit.way), foot = glm::dot(exhibit.through, exhibit.way);
  SectionRange range{middle - exhibit.side / 2, middle + exhibit.side / 2};
  constexpr double across = 1e-9;
  for (int axis = 0; axis < 2; ++axis) {
    const double way = exhibit.way[axis], half = exhibit.patch_half[axis];
    if (std::abs(way) < across) continue;
    const double one = (half - exhibit.through[axis]) / way + foot, other = (-half - exhibit.through[axis]) / way + foot;
    range.from = std::max(range.from, std::min(one, other)), range.to = std::min(range.to, std::max(one, other));
  }
  return range;
}

glm::dvec2 on_section(const Exhibit& exhibit, double distance) {
  return exhibit.through + exhibit.way * (distance - glm::dot(exhibit.through, exhibit.way));
}

static Exhibit chosen_exhibit(const Bank& bank, const Memory* memory, const SectionChoice& section) {
  const PatchSize size = bank.size();
  Exhibit exhibit;
  exhibit.patch_half = {size.width / 2, size.height / 2};
  exhibit.side = exhibit.patch_side = std::min(size.width, size.height);
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

  if (exhibit.has_relief || exhibit.pushes_at_rest) {
    Relief relief;
    if (!bank.program().description().vibrates()) relief = static_force(bank).relief;
    // A surface may be shown and not be felt.
    if (!relief.regular() && exhibit.has_relief) relief = picture_relief(bank, memory);
    if (relief.regular()) exhibit.period = relief.period;
    // The period is read from samples, so its last digits are random: 19.9973 mm is shown as 20.
    // With marks the whole patch is shown: they may be anywhere on it.
    const bool marked = !bank.program().description().picture.marks.empty();
    if (exhibit.period && !marked) {
      const double cropped = std::min(exhibit.side, in_three_digits(periods_shown * *exhibit.period));
      if (!is_more_outside(bank, memory, cropped)) {
        exhibit.side = cropped;
        if (cropped < exhibit.patch_side) exhibit.centre = section.at.value_or(glm::dvec2(0));
      }
    }
  }
  if (section.along || section.at) {
    exhibit.through = section.at.value_or(glm::dvec2(0));
    if (section.along) {
      exhibit.way = {std::cos(*section.along), std::sin(*section.along)};
      exhibit.way_name = section.name;
    }
  }
  if (section.along) return exhibit;

  // The section runs along x through the centre, unless nothing changes there: then along y, or between rows of bumps.
  constexpr int points = 997;
  const auto varies = [&](const Exhibit& tried) {
    std::vector<glm::vec2> line;
    const SectionRange range = section_range(tried);
    for (int i = 0; i < points; ++i)
      line.emplace_back(on_section(tried, range.from + (i + 0.5) / points * (range.to - range.from)));
    const Look look = look_at(bank, memory, line);
    return (tried.has_relief ? look.relief : look.force) > 0.1 * (tried.has_relief ? whole.relief : whole.force);
  };
  const double off_centre = section.at ? 0 : exhibit.period.value_or(exhibit.side / 8) / 4;
  for (const double aside : {0.0, off_centre}) {
    for (const bool along_y : {false, true}) {
      Exhibit tried = exhibit;
      tried.way = along_y ? glm::dvec2(0, 1) : glm::dvec2(1, 0);
      tried.way_name = along_y ? "y" : "x";
      tried.through += along_y ? glm::dvec2(aside, 0) : glm::dvec2(0, aside);
      if (varies(tried)) return tried;
    }
  }
  return exhibit;
}

/// The place on the section where the force depends most on the velocity along it, if it is there at least half as
/// strong as anywhere, otherwise the strongest place of the patch; the section's own place where nothing is much
/// stronger. So a wall that damps is shown inside of it.
static glm::dvec2 moving_place(const Bank& bank, const Exhibit& exhibit, bool chosen) {
  if (chosen || !exhibit.resists_motion || bank.program().description().vibrates()) return exhibit.through;
  std::vector<glm::dvec2> places{exhibit.through};
  const SectionRange range = section_range(exhibit);
  constexpr int along = 41, lattice = 21;
  for (int i = 0; i < along; ++i) places.push_back(on_section(exhibit, distance_at(range, i, along)));
  for (int row = 1; row < lattice - 1; ++row)
    for (int column = 1; column < lattice - 1; ++column)
      places.emplace_back((2.0 * column / (lattice - 1) - 1) * exhibit.patch_half.x,
                          (2.0 * row / (lattice - 1) - 1) * exhibit.patch_half.y);
  std::vector<Hand> hands;
  for (const double speed : {0.0, exhibit.speed, -exhibit.speed})
    for (const glm::dvec2 place : places)
      hands.push_back({.position = glm::vec2(place), .velocity = glm::vec2(exhibit.way * speed)});
  const std::vector<Force> forces = forces_on(bank, hands);
  const auto changes = [&](std::size_t i) {
    const Force rest = forces[i], there = forces[places.size() + i] - rest, back = forces[2 * places.size() + i] - rest;
    return std::max(std::hypot(there.x, there.y), std::hypot(back.x, back.y));
  };
  const auto strongest_of = [&](std::size_t begin, std::size_t end) {
    std::size_t found = begin;
    constexpr float plainly = 1.05f;  // of places that are alike, the first
    for (std::size_t i = begin; i < end; ++i)
      if (changes(i) > plainly * changes(found)) found = i;
    return found;
  };
  const std::size_t anywhere = strongest_of(0, places.size()), here = strongest_of(0, 1 + along);
  constexpr float enough = 0.5f;
  if (changes(0) >= enough * changes(anywhere)) return places[0];
  return places[changes(here) >= enough * changes(anywhere) ? here : anywhere];
}

Exhibit exhibit_of(const Bank& bank, const Memory* memory, const SectionChoice& section) {
  Exhibit exhibit = chosen_exhibit(bank, memory, section);
  exhibit.moving_at = moving_place(bank, exhibit, section.at.has_value());
  return exhibit;
}

Profile height_along(const Bank& bank, const Memory* memory, const Exhibit& exhibit, int count) {
  std::vector<glm::vec2> line;
  Profile profile;
  const SectionRange range = section_range(exhibit);
  for (int i = 0; i < count; ++i) {
    profile.at.push_back(distance_at(range, i, count));
    line.emplace_back(on_section(exhibit, profile.at.back()));
  }
  const auto heights = reliefs(bank, memory, line);
  profile.values.assign(heights.begin(), heights.end());
  return profile;
}

Profile force_along(const Bank& bank, const Exhibit& exhibit, double speed, int count, bool across) {
  std::vector<Hand> hands(static_cast<std::size_t>(count));
  Profile profile;
  const SectionRange range = section_range(exhibit);
  for (int i = 0; i < count; ++i) {
    profile.at.push_back(distance_at(range, i, count));
    Hand& hand = hands[static_cast<std::size_t>(i)];
    hand.position = glm::vec2(on_section(exhibit, profile.at.back()));
    hand.velocity = glm::vec2(exhibit.way * speed);
  }
  for (Force force : forces_on(bank, hands))
    profile.values.push_back(across ? across_section(exhibit, force) : along_section(bank, exhibit, force));
  return profile;
}

Profile force_against_speed(const Bank& bank, const Exhibit& exhibit, int count, bool across) {
  std::vector<Hand> hands(static_cast<std::size_t>(count));
  Profile profile;
  for (int i = 0; i < count; ++i) {
    profile.at.push_back((i / (count - 1.0) - 0.5) * 2 * exhibit.speed);
    hands[static_cast<std::size_t>(i)].velocity = glm::vec2(exhibit.way * profile.at.back());
    hands[static_cast<std::size_t>(i)].position = glm::vec2(exhibit.moving_at);
  }
  for (Force force : forces_on(bank, hands))
    profile.values.push_back(across ? across_section(exhibit, force) : along_section(bank, exhibit, force));
  return profile;
}

glm::vec2 pixel_position(const Exhibit& exhibit, int column, int row, int count) {
  const auto place = [&](int i) { return ((i + 0.5) / count - 0.5) * exhibit.side; };
  return glm::vec2(exhibit.centre + glm::dvec2(place(column), -place(row)));
}

}  // namespace wale
