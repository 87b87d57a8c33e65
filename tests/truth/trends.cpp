// Forces by place that are no texture.

#include <fmt/format.h>

#include "tests/truth/families.hpp"

namespace wale::truth {
namespace {

constexpr double nothing = 0;

Composition springs(Chance& chance) {
  Composition made = any_patch(chance);
  add_spring(made, chance, 80);
  return made;
}

/// It saturates: it has no single stiffness, and is no wall.
Composition saturated_springs(Chance& chance) {
  Composition made = any_patch(chance);
  const double most = rounded(chance.octaves(0.3, 5), 3);
  const double stiffness = rounded(chance.octaves(10 * most / made.half().x / 3, 50000), 3);
  made.push(chance.happens(0.5) ? fmt::format("hold(-{} N/m * hand, {} N)", number(stiffness), number(most))
                                : fmt::format("spring({} N/m) limit {} N", number(stiffness), number(most)),
            [=](const Sample& hand) {
              const double pull = stiffness * glm::length(hand.position);
              return pull <= most ? -stiffness * hand.position : -most * glm::normalize(hand.position);
            });
  made.truth[Cue::stiffness] = open;
  made.truth[Cue::constant] = open;
  return made;
}

/// A pull towards a line instead of a place.
Composition grooves(Chance& chance) {
  Composition made = any_patch(chance);
  const double stiffness = rounded(chance.octaves(5, 80), 3), angle = any_orientation(chance);
  const glm::dvec2 way{std::cos(angle), std::sin(angle)};
  made.push(fmt::format("-{} N/m * ({} * x + {} * y) * {}", number(stiffness), number(way.x), number(way.y),
                        unit_vector(angle)),
            [=](const Sample& hand) { return -stiffness * glm::dot(way, hand.position) * way; });
  made.truth[Cue::stiffness] = valued(stiffness), made.truth[Cue::stiffness_across] = valued(0);
  made.truth[Cue::axis] = valued(std::fmod(angle, 3.14159265358979));
  return made;
}

Composition constants(Chance& chance) {
  Composition made = any_patch(chance);
  add_constant(made, chance, 5);
  return made;
}

Composition walls(Chance& chance) {
  Composition made = any_patch(chance);
  add_wall(made, chance);
  return made;
}

/// From one constant force to another at a line.
Composition edges(Chance& chance) {
  Composition made = any_patch(chance);
  const double size = rounded(chance.octaves(0.1, 4), 3), angle = any_orientation(chance);
  const double width = rounded(chance.octaves(0.2e-3, 3e-3), 3), line = rounded(chance.between(-0.03, 0.03), 3);
  const glm::dvec2 way{std::cos(angle), std::sin(angle)};
  made.push(
      fmt::format("{} N * (1 - 2 / (exp(2 * clamp(({} * x + {} * y - {}) / {}, -20, 20)) + 1)) * {}", number(size),
                  number(way.x), number(way.y), millimetres(line), millimetres(width), unit_vector(angle)),
      [=](const Sample& hand) { return size * std::tanh((glm::dot(way, hand.position) - line) / width) * way; });
  made.truth[Cue::constant] = open;
  return made;
}

/// A step beyond which hardly any of the patch is left, along x or y.
Composition steps_near_the_rim(Chance& chance) {
  Composition made = any_patch(chance);
  const bool along_x = chance.happens(0.5);
  const double half = along_x ? made.half().x : made.half().y;
  const double size = rounded(chance.octaves(0.3, 4), 3);
  const double line = rounded((chance.happens(0.5) ? 1 : -1) * half * chance.between(0.6, 0.95), 4);
  const bool beyond = chance.happens(0.5);
  const std::string one = fmt::format("{} N", number(size));
  const std::string step = fmt::format("if {} > {} then {} else {}", along_x ? "x" : "y", millimetres(line),
                                       beyond ? one : "0 N", beyond ? "0 N" : one);
  made.push(along_x ? fmt::format("vector({}, 0 N)", step) : fmt::format("vector(0 N, {})", step),
            [=](const Sample& hand) {
              const double at = along_x ? hand.position.x : hand.position.y;
              const double force = (at > line) == beyond ? size : 0;
              return along_x ? glm::dvec2(force, 0) : glm::dvec2(0, force);
            });
  made.truth[Cue::constant] = open;
  return made;
}

}  // namespace

void add_spring(Composition& made, Chance& chance, double stiffest) {
  const double stiffness = rounded(chance.octaves(5, stiffest), 3);
  const glm::dvec2 rest = chance.happens(0.7) ? glm::dvec2{nothing}
                                              : glm::dvec2{rounded(chance.between(-0.02, 0.02), 3),
                                                           rounded(chance.between(-0.02, 0.02), 3)};
  const std::string place = fmt::format("vector({}, {})", millimetres(rest.x), millimetres(rest.y));
  made.push(chance.happens(0.3) ? fmt::format("spring({} N/m, rest: {})", number(stiffness), place)
                                : fmt::format("-{} N/m * (hand - {})", number(stiffness), place),
            [=](const Sample& hand) { return -stiffness * (hand.position - rest); });
  made.truth[Cue::stiffness] = valued(stiffness);
  // The force in the patch's middle is where the spring rests, told another way.
  if (rest != glm::dvec2{nothing}) made.truth[Cue::constant] = open;
}

void add_constant(Composition& made, Chance& chance, double strongest) {
  const double size = rounded(chance.octaves(0.1, strongest), 3), angle = chance.between(0, 6.28);
  const glm::dvec2 force{rounded(size * std::cos(angle), 5), rounded(size * std::sin(angle), 5)};
  made.push(fmt::format("vector({} N, {} N)", number(force.x), number(force.y)), [=](const Sample&) { return force; });
  made.truth[Cue::constant] = valued(glm::length(force));
}

void add_wall(Composition& made, Chance& chance) {
  // The device's 10 N end the wall some way behind its face.
  const double stiffness = rounded(chance.octaves(100, 2000), 3), face = rounded(chance.between(-0.01, 0.03), 3);
  made.truth[Cue::wall_stiffness] = valued(stiffness), made.truth[Cue::face] = valued(face);
  made.truth[Cue::constant] = open;
  if (chance.happens(0.3)) {
    made.push(fmt::format("firm({} N/m, face: {})", number(stiffness), millimetres(face)), [=](const Sample& hand) {
      return glm::dvec2{-stiffness * std::max(0.0, hand.position.x - face), 0};
    });
    return;
  }
  const double angle = any_orientation(chance);
  const glm::dvec2 inward{std::cos(angle), std::sin(angle)};
  made.push(
      fmt::format("-{} N/m * max(0 mm, {} * x + {} * y - {}) * {}", number(stiffness), number(inward.x),
                  number(inward.y), millimetres(face), unit_vector(angle)),
      [=](const Sample& hand) { return -stiffness * std::max(0.0, glm::dot(inward, hand.position) - face) * inward; });
}

std::vector<Family> trend_families() {
  return {{"spring", springs},
          {"saturated spring", saturated_springs},
          {"groove", grooves},
          {"constant", constants},
          {"wall", walls},
          {"edge", edges},
          {"step near the rim", steps_near_the_rim}};
}

}  // namespace wale::truth
