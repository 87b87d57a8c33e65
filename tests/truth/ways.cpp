// What opposes a hand on one way only, in a part of the patch, or along several axes.

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "tests/truth/families.hpp"

namespace wale::truth {
namespace {

/// A mass that is another one, or none, for a hand that speeds up the other way along an axis.
Composition masses_one_way(Chance& chance) {
  Composition made = any_patch(chance);
  const double mass = rounded(chance.octaves(0.02, 0.5), 3);
  const double back = chance.happens(0.6) ? 0 : rounded(mass * chance.between(0.1, 0.3), 2);
  const int axis = chance.happens(0.5) ? 0 : 1;
  const double sign = chance.happens(0.5) ? 1 : -1;
  const char* of = axis == 0 ? "acceleration.x" : "acceleration.y";
  const std::string along = fmt::format("(if {0} * {1} > 0 m/s^2 then -{2} kg * {1} else -{3} kg * {1})", number(sign),
                                        of, number(mass), number(back));
  made.push(axis == 0 ? fmt::format("vector({}, 0 N)", along) : fmt::format("vector(0 N, {})", along),
            [=](const Sample& hand) {
              glm::dvec2 force{0};
              const double speeding = hand.acceleration[axis];
              force[axis] = -(sign * speeding > 0 ? mass : back) * speeding;
              return force;
            });
  made.truth[Cue::one_way_mass] = valued(mass - back);
  return made;
}

/// A mass in a part of the patch only, beyond a straight line.
Composition masses_in_a_part(Chance& chance) {
  Composition made = any_patch(chance);
  const double mass = rounded(chance.octaves(0.02, 0.5), 3);
  const double other = chance.happens(0.6) ? 0 : rounded(mass * chance.between(0.1, 0.4), 2);
  const int axis = chance.happens(0.5) ? 0 : 1;
  const double line = rounded(made.half()[axis] * chance.between(-0.5, 0.5), 2);
  const char* of = axis == 0 ? "x" : "y";
  made.push(fmt::format("if {} > {} then -{} kg * acceleration else -{} kg * acceleration", of, millimetres(line),
                        number(mass), number(other)),
            [=](const Sample& hand) { return -(hand.position[axis] > line ? mass : other) * hand.acceleration; });
  made.truth[Cue::uneven_mass] = valued(mass - other);
  return made;
}

/// A viscosity along one axis, and a friction along another.
Composition two_axes(Chance& chance) {
  Composition made = any_patch(chance);
  const double viscosity = rounded(chance.octaves(1, 12), 3), friction = rounded(chance.octaves(0.2, 2), 3);
  const double other = chance.happens(0.5) ? 0 : rounded(viscosity * chance.between(0.2, 0.7), 2);
  const double angle = rounded(chance.between(0.15, 1.4), 3);
  const glm::dvec2 way{std::cos(angle), std::sin(angle)};
  const bool along_y = chance.happens(0.5);
  const glm::dvec2 by_axis = along_y ? glm::dvec2{other, viscosity} : glm::dvec2{viscosity, other};
  made.push(fmt::format("vector(-{} N s/m * velocity.x, -{} N s/m * velocity.y)", number(by_axis.x), number(by_axis.y)),
            [=](const Sample& hand) { return -by_axis * hand.velocity; });
  made.push(fmt::format("-{} N * clamp(({} * velocity.x + {} * velocity.y) / 4 mm/s, -1, 1) * {}", number(friction),
                        number(way.x), number(way.y), unit_vector(angle)),
            [=](const Sample& hand) {
              return -friction * std::clamp(glm::dot(way, hand.velocity) / 4e-3, -1.0, 1.0) * way;
            });
  made.truth[Cue::viscosity] = valued(viscosity), made.truth[Cue::viscosity_across] = valued(other);
  made.truth[Cue::friction] = valued(friction), made.truth[Cue::friction_across] = valued(0);
  made.truth[Cue::breakaway] = open;
  made.truth[Cue::axis] = valued(angle);  // of the friction
  return made;
}

}  // namespace

std::vector<Family> way_families() {
  return {{"mass one way", masses_one_way}, {"mass in a part", masses_in_a_part}, {"friction across a viscosity", two_axes}};
}

}  // namespace wale::truth
