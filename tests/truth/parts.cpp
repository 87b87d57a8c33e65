// What is in a part of the patch only, or changes there: a swing on one side of a line, springs with a dead band, and
// springs that stiffen or soften.

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>
#include <string>

#include "tests/truth/families.hpp"

namespace wale::truth {
namespace {

using std::numbers::pi;

/// A vibration or a sway in a round spot or on one side of a line; elsewhere nothing.
Composition swings_in_a_part(Chance& chance) {
  Composition made;
  const bool slow = chance.happens(0.4);
  const double rate = rounded(slow ? chance.octaves(0.6, 6) : chance.octaves(15, 200), 3);
  const double size = rounded(chance.octaves(0.2, 2), 3), angle = any_orientation(chance);
  const glm::dvec2 way{std::cos(angle), std::sin(angle)};
  const double half = std::min(made.half().x, made.half().y);
  std::string where;
  std::function<bool(glm::dvec2)> inside;
  if (chance.happens(0.5)) {
    const double side = any_orientation(chance), line = rounded(half * chance.between(-0.6, 0.6), 3);
    const glm::dvec2 across{std::cos(side), std::sin(side)};
    where = fmt::format("{} * x + {} * y > {}", number(across.x), number(across.y), millimetres(line));
    inside = [=](glm::dvec2 place) { return glm::dot(across, place) > line; };
  } else {
    const glm::dvec2 centre{rounded(half * chance.between(-0.6, 0.6), 3), rounded(half * chance.between(-0.6, 0.6), 3)};
    const double radius = rounded(chance.between(14e-3, 30e-3), 3);
    where = fmt::format("length(hand - vector({}, {})) < {}", millimetres(centre.x), millimetres(centre.y),
                        millimetres(radius));
    inside = [=](glm::dvec2 place) { return glm::distance(place, centre) < radius; };
  }
  made.statement("active 20 W");
  const bool own_clock = chance.happens(0.5);  // the phase begins when the hand comes
  const ForceLaw law = [=](const Sample& hand) {
    return inside(hand.position) ? size * std::sin(2 * pi * rate * hand.time) * way : glm::dvec2(0);
  };
  made.push(fmt::format("(if {} then {} N else 0 N) * sin(2 * pi * {}) * {}", where, number(size),
                        own_clock ? fmt::format("phase({} Hz)", number(rate)) : fmt::format("{} Hz * time", number(rate)),
                        unit_vector(angle)),
            own_clock ? ForceLaw() : law);
  made.truth[slow ? Cue::sway : Cue::vibration] = valued(size);
  made.truth[slow ? Cue::sway_rate : Cue::vibration_rate] = valued(rate);
  made.truth.walls.emplace(), made.truth.steps.emplace();
  return made;
}

/// Two walls that face each other, in one of the spellings of what a number is beyond its ends.
Composition dead_bands(Chance& chance) {
  Composition made;
  const double half = std::min(made.half().x, made.half().y), angle = any_orientation(chance);
  const glm::dvec2 way{std::cos(angle), std::sin(angle)};
  const double stiffness = rounded(chance.octaves(60, 600), 3), band = rounded(half * chance.between(0.2, 0.7), 3);
  made.statement(fmt::format("let across = {} * x + {} * y", number(way.x), number(way.y)));
  const std::string end = millimetres(band);
  const std::string spelling =
      chance.happens(0.3)   ? fmt::format("across - clamp(across, -{0}, {0})", end)
      : chance.happens(0.3) ? fmt::format("across - min(max(across, -{0}), {0})", end)
      : chance.happens(0.3) ? fmt::format("max(across - {0}, 0 mm) + min(across + {0}, 0 mm)", end)
      : chance.happens(0.5) ? fmt::format("across - hold(across, {0})", end)
                            : fmt::format("sign(across) * max(abs(across) - {0}, 0 mm)", end);
  made.push(fmt::format("-{} N/m * ({}) * {}", number(stiffness), spelling, unit_vector(angle)),
            [=](const Sample& hand) {
              const double across = glm::dot(way, hand.position);
              return -stiffness * (across - std::clamp(across, -band, band)) * way;
            });
  if (chance.happens(0.5)) add_texture(made, chance, any_waveform(chance), 0.8e-3, 6e-3, 0.8);
  made.truth[Cue::wall_stiffness] = valued(stiffness), made.truth[Cue::face] = open;
  made.truth[Cue::constant] = open;
  made.truth.walls = {{stiffness, band, angle}, {stiffness, band, angle + pi}};
  made.truth.steps.emplace();
  return made;
}

/// A spring about the middle that is stiffer beyond a circle: the wall there adds the difference.
Composition stiffening_springs(Chance& chance) {
  Composition made;
  const double half = std::min(made.half().x, made.half().y), radius = rounded(half * chance.between(0.3, 0.7), 3);
  const double soft = rounded(chance.octaves(10, 60), 3), more = rounded(chance.octaves(60, 400), 3);
  made.push(fmt::format("-{} N/m * hand - {} N/m * (hand - hold(hand, {}))", number(soft), number(more),
                        millimetres(radius)),
            [=](const Sample& hand) {
              const double far = glm::length(hand.position), beyond = std::max(0.0, far - radius);
              return -soft * hand.position - (far > 0 ? more * beyond / far : 0) * hand.position;
            });
  made.truth[Cue::stiffness] = valued(soft);
  made.truth[Cue::wall_stiffness] = valued(more), made.truth[Cue::face] = open;
  made.truth.walls = {{.stiffness = more, .face = radius, .round = 1}};
  made.truth.steps.emplace();
  return made;
}

/// A spring about the middle of which a part ends on a circle: one law until then.
Composition softening_springs(Chance& chance) {
  Composition made;
  const double half = std::min(made.half().x, made.half().y), radius = rounded(half * chance.between(0.1, 0.6), 3);
  const double part = rounded(chance.octaves(30, 200), 3), rest = rounded(chance.octaves(5, 40), 3);
  const bool by_force = chance.happens(0.5);
  const double ends = by_force ? rounded(part * radius, 3) / part : radius;
  const ForceLaw law = [=](const Sample& hand) {
    const double far = glm::length(hand.position), held = std::min(far, ends);
    return -(far > 0 ? part * held / far : 0) * hand.position;
  };
  made.push(by_force ? fmt::format("spring({} N/m) limit {} N", number(part), number(rounded(part * radius, 3)))
                     : fmt::format("-{} N/m * hold(hand, {})", number(part), millimetres(radius)),
            law);
  made.push(fmt::format("spring({} N/m)", number(rest)), [=](const Sample& hand) { return -rest * hand.position; });
  made.truth[Cue::stiffness] = valued(part + rest);
  made.truth.walls.emplace(), made.truth.steps.emplace();
  return made;
}

}  // namespace

std::vector<Family> part_families() {
  return {{"swing in a part", swings_in_a_part},
          {"dead band", dead_bands},
          {"stiffening spring", stiffening_springs},
          {"softening spring", softening_springs}};
}

}  // namespace wale::truth
