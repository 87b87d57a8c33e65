// What resists along one axis, walls that the device's limit cuts off, and pushes that are the same everywhere.

#include <fmt/format.h>

#include "tests/truth/families.hpp"

namespace wale::truth {
namespace {

/// Two principal values, and the direction of the greater one. The smaller is often 0.
struct Axes {
  double along = 0, across = 0, angle = 0;
  glm::dvec2 way{1, 0}, aside{0, 1};
};

Axes any_axes(Chance& chance, double low, double high) {
  Axes axes;
  axes.along = rounded(chance.octaves(low, high), 3), axes.angle = any_orientation(chance);
  axes.across = chance.happens(0.6) ? 0 : rounded(axes.along * chance.between(0.2, 0.8), 3);
  axes.way = {std::cos(axes.angle), std::sin(axes.angle)}, axes.aside = {-axes.way.y, axes.way.x};
  return axes;
}

std::string dot_text(const char* of, glm::dvec2 way) {
  return fmt::format("({} * {}.x + {} * {}.y)", number(way.x), of, number(way.y), of);
}

/// What resists a vector of the hand in proportion to it.
Composition resisting(Chance& chance, const Axes& axes, const char* of, const char* unit,
                      glm::dvec2 (*vector)(const Sample&)) {
  Composition made = any_patch(chance);
  made.push(fmt::format("-{} {} * {} * {} - {} {} * {} * {}", number(axes.along), unit, dot_text(of, axes.way),
                        unit_vector(axes.angle), number(axes.across), unit, dot_text(of, axes.aside),
                        fmt::format("vector({}, {})", number(axes.aside.x), number(axes.aside.y))),
            [=](const Sample& hand) {
              const glm::dvec2 here = vector(hand);
              return -axes.along * glm::dot(axes.way, here) * axes.way -
                     axes.across * glm::dot(axes.aside, here) * axes.aside;
            });
  made.truth[Cue::axis] = valued(std::fmod(axes.angle, 3.14159265358979));
  return made;
}

Composition springs_by_axis(Chance& chance) {
  const Axes axes = any_axes(chance, 10, 80);
  Composition made = resisting(chance, axes, "hand", "N/m", [](const Sample& hand) { return hand.position; });
  made.truth[Cue::stiffness] = valued(axes.along), made.truth[Cue::stiffness_across] = valued(axes.across);
  return made;
}

Composition viscosities_by_axis(Chance& chance) {
  const Axes axes = any_axes(chance, 0.5, 10);
  Composition made = resisting(chance, axes, "velocity", "N s/m", [](const Sample& hand) { return hand.velocity; });
  made.truth[Cue::viscosity] = valued(axes.along), made.truth[Cue::viscosity_across] = valued(axes.across);
  return made;
}

Composition masses_by_axis(Chance& chance) {
  const Axes axes = any_axes(chance, 0.02, 0.6);
  Composition made =
      resisting(chance, axes, "acceleration", "kg", [](const Sample& hand) { return hand.acceleration; });
  made.truth[Cue::mass] = valued(axes.along), made.truth[Cue::mass_across] = valued(axes.across);
  return made;
}

Composition frictions_by_axis(Chance& chance) {
  Composition made = any_patch(chance);
  const double size = rounded(chance.octaves(0.1, 3), 3), angle = any_orientation(chance);
  const glm::dvec2 way{std::cos(angle), std::sin(angle)};
  // Full within 5 mm/s, or at once.
  if (chance.happens(0.5))
    made.push(fmt::format("-{} N * sign({}) * {}", number(size), dot_text("velocity", way), unit_vector(angle)));
  else
    made.push(
        fmt::format("-{} N * clamp({} / 5 mm/s, -1, 1) * {}", number(size), dot_text("velocity", way),
                    unit_vector(angle)),
        [=](const Sample& hand) { return -size * std::clamp(glm::dot(way, hand.velocity) / 5e-3, -1.0, 1.0) * way; });
  if (chance.happens(0.3)) {
    add_viscosity(made, chance, 4);
  }
  made.truth[Cue::friction] = valued(size), made.truth[Cue::friction_across] = valued(0);
  made.truth[Cue::breakaway] = open;
  made.truth[Cue::axis] = valued(std::fmod(angle, 3.14159265358979));
  return made;
}

/// The face is anywhere, and most walls reach the device's limit; a spring or a push beside it.
Composition walls_beside_forces(Chance& chance) {
  Composition made;
  add_wall(made, chance);
  made.truth[Cue::constant] = {};
  if (chance.happens(0.5)) add_spring(made, chance, 40);
  if (chance.happens(0.5)) add_constant(made, chance, 3);
  if (chance.happens(0.4)) add_viscosity(made, chance, 4);
  if (made.truth[Cue::stiffness].kind == Expected::Kind::value) made.truth[Cue::constant] = open;
  return made;
}

Composition walls_near_the_rim(Chance& chance) {
  Composition made;
  const double stiffness = rounded(chance.octaves(100, 2000), 3), face = rounded(chance.between(0.04, 0.07), 3);
  made.truth[Cue::wall_stiffness] = valued(stiffness), made.truth[Cue::face] = valued(face);
  made.push(fmt::format("firm({} N/m, face: {})", number(stiffness), millimetres(face)), [=](const Sample& hand) {
    return glm::dvec2{-stiffness * std::max(0.0, hand.position.x - face), 0};
  });
  return made;
}

Composition walls_with_a_preload(Chance& chance) {
  Composition made;
  const double stiffness = rounded(chance.octaves(200, 2000), 3), face = rounded(chance.between(-0.01, 0.04), 3);
  const double preload = rounded(chance.between(0.5, 4), 3);
  made.truth[Cue::wall_stiffness] = valued(stiffness), made.truth[Cue::face] = valued(face);
  made.push(fmt::format("if x > {0} then vector(-{1} N - {2} N/m * (x - {0}), 0 N) else vector(0 N, 0 N)",
                        millimetres(face), number(preload), number(stiffness)),
            [=](const Sample& hand) {
              const double depth = hand.position.x - face;
              return depth > 0 ? glm::dvec2{-preload - stiffness * depth, 0} : glm::dvec2{0};
            });
  return made;
}

/// It damps a hand that moves in it; drag outside of it is another thing.
Composition crisp_walls(Chance& chance) {
  Composition made;
  const double stiffness = rounded(chance.octaves(200, 1500), 3), damping = rounded(chance.octaves(0.5, 8), 3);
  made.truth[Cue::wall_stiffness] = valued(stiffness), made.truth[Cue::face] = valued(0.02);
  made.push(fmt::format("firm({} N/m)", number(stiffness)), [=](const Sample& hand) {
    return glm::dvec2{-stiffness * std::max(0.0, hand.position.x - 0.02), 0};
  });
  if (chance.happens(0.5)) {
    made.push(fmt::format("crisp({} N s/m)", number(damping)));
    made.truth[Cue::wall_damping] = valued(damping);
  }
  if (chance.happens(0.7)) add_viscosity(made, chance, 4);
  return made;
}

/// Its rest is far away, so the device's limit cuts it off in a part of the patch.
Composition displaced_springs(Chance& chance) {
  Composition made;
  const double stiffness = rounded(chance.octaves(60, 160), 3);
  const glm::dvec2 rest{rounded(chance.between(0.02, 0.06), 3), rounded(chance.between(-0.02, 0.02), 3)};
  made.push(
      fmt::format("spring({} N/m, rest: vector({}, {}))", number(stiffness), millimetres(rest.x), millimetres(rest.y)),
      [=](const Sample& hand) { return -stiffness * (hand.position - rest); });
  made.truth[Cue::stiffness] = valued(stiffness);
  made.truth[Cue::constant] = valued(stiffness * glm::length(rest));
  return made;
}

Composition pushes_beside(Chance& chance) {
  Composition made = any_patch(chance);
  switch (static_cast<int>(chance.between(0, 5))) {
    case 0: add_texture(made, chance, any_waveform(chance), 0.5e-3, std::min(made.longest_period(), 0.02), 1.5); break;
    case 1: add_viscosity(made, chance, 4); break;
    case 2: add_friction(made, chance, 1.5); break;
    case 3: add_vibration(made, chance, 1); break;
    default: add_mass(made, chance);
  }
  add_constant(made, chance, 4);
  return made;
}

}  // namespace

std::vector<Family> axis_families() {
  return {{"spring by axis", springs_by_axis},           {"viscosity by axis", viscosities_by_axis},
          {"friction by axis", frictions_by_axis},       {"mass by axis", masses_by_axis},
          {"wall beside forces", walls_beside_forces},   {"wall near the rim", walls_near_the_rim},
          {"wall with a preload", walls_with_a_preload}, {"crisp wall", crisp_walls},
          {"displaced spring", displaced_springs},       {"push beside", pushes_beside}};
}

}  // namespace wale::truth
