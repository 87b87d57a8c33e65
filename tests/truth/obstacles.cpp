// Several walls at once, round ones, steps, what lies beside them, and resistance where the device's limit is reached.

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "tests/truth/families.hpp"

namespace wale::truth {
namespace {

using std::numbers::pi;

constexpr double degree = pi / 180;

glm::dvec2 way_of(double angle) { return {std::cos(angle), std::sin(angle)}; }

/// The stiffest of the walls that a program has is its wall.
void tell_walls(Composition& made, const std::vector<WallTruth>& walls) {
  const WallTruth& stiffest = *std::ranges::max_element(walls, {}, &WallTruth::stiffness);
  made.truth[Cue::wall_stiffness] = valued(stiffest.stiffness), made.truth[Cue::face] = open;
  made.truth[Cue::constant] = open;
  made.truth.walls = walls, made.truth.steps.emplace();
}

/// A straight wall.
WallTruth add_straight(Composition& made, double stiffness, double face, double angle) {
  const glm::dvec2 inward = way_of(angle);
  made.push(
      fmt::format("-{} N/m * max(0 mm, {} * x + {} * y - {}) * {}", number(stiffness), number(inward.x),
                  number(inward.y), millimetres(face), unit_vector(angle)),
      [=](const Sample& hand) { return -stiffness * std::max(0.0, glm::dot(inward, hand.position) - face) * inward; });
  return {stiffness, face, angle};
}

/// Left and right of the hand, of different stiffness; or two that meet at an angle.
Composition two_walls(Chance& chance) {
  Composition made = any_patch(chance);
  const double half = std::min(made.half().x, made.half().y), angle = any_orientation(chance);
  const auto stiffness = [&] { return rounded(chance.octaves(100, 1500), 3); };
  const auto face = [&] { return rounded(half * chance.between(0.15, 0.75), 3); };
  const double turn = chance.happens(0.6) ? pi : rounded(chance.between(40, 140), 3) * degree;
  std::vector<WallTruth> walls = {add_straight(made, stiffness(), face(), angle)};
  walls.push_back(add_straight(made, stiffness(), face(), angle + turn));
  if (chance.happens(0.3)) add_spring(made, chance, 30);
  if (chance.happens(0.3)) add_texture(made, chance, sine(), 1e-3, 6e-3, 1);
  tell_walls(made, walls);
  return made;
}

/// Four walls around the hand.
Composition boxes(Chance& chance) {
  Composition made = any_patch(chance);
  const double angle = chance.happens(0.7) ? 0 : rounded(chance.between(0, 1.5), 3);
  const double alike = rounded(chance.octaves(100, 1500), 3);
  const bool same = chance.happens(0.5);
  const double half = std::min(made.half().x, made.half().y);
  std::vector<WallTruth> walls;
  for (int side = 0; side < 4; ++side)
    walls.push_back(add_straight(made, same ? alike : rounded(chance.octaves(100, 1500), 3),
                                 rounded(half * chance.between(0.3, 0.7), 3), angle + side * pi / 2));
  tell_walls(made, walls);
  return made;
}

/// A room without corners, or a post.
Composition round_walls(Chance& chance) {
  Composition made = any_patch(chance);
  const double half = std::min(made.half().x, made.half().y);
  const double stiffness = rounded(chance.octaves(100, 1500), 3);
  const double radius = rounded(half * chance.between(0.25, 0.7), 3);
  const auto aside = [&] { return chance.happens(0.5) ? 0 : rounded(chance.between(-0.25, 0.25) * half, 3); };
  const glm::dvec2 centre{aside(), aside()};
  const bool post = chance.happens(0.4);
  made.statement(fmt::format("let off = hand - vector({}, {})", millimetres(centre.x), millimetres(centre.y)));
  made.statement("let far = max(length(off), 1 um)");
  made.push(post ? fmt::format("{} N/m * max(0 mm, {} - far) * off / far", number(stiffness), millimetres(radius))
                 : fmt::format("-{} N/m * max(0 mm, far - {}) * off / far", number(stiffness), millimetres(radius)),
            [=](const Sample& hand) {
              const glm::dvec2 off = hand.position - centre;
              const double far = std::max(glm::length(off), 1e-6);
              return (post ? std::max(0.0, radius - far) : -std::max(0.0, far - radius)) * stiffness / far * off;
            });
  if (chance.happens(0.3)) add_texture(made, chance, sine(), 1e-3, 6e-3, 1);
  tell_walls(made, {{stiffness, radius, 0, post ? -1 : 1, centre.x, centre.y}});
  return made;
}

Composition walls_beside_slow_waves(Chance& chance) {
  Composition made;
  made.push_wave({chance.happens(0.7) ? sine() : triangle(), rounded(chance.between(0.02, 0.05), 3),
                  any_orientation(chance), rounded(chance.between(0, 1), 3), rounded(chance.octaves(0.2, 2), 3)},
                 chance.happens(0.3) ? std::optional(any_orientation(chance)) : std::nullopt);
  tell_walls(made, {add_straight(made, rounded(chance.octaves(100, 2000), 3), rounded(chance.between(0, 0.05), 3),
                                 any_orientation(chance))});
  if (chance.happens(0.3)) add_spring(made, chance, 30);
  return made;
}

/// A slow wave and a fine one, and a wall beside both.
Composition walls_beside_slow_and_fine(Chance& chance) {
  Composition made;
  const double orientation = any_orientation(chance);
  const auto wave = [&](double period, double way) {
    made.push_wave({sine(), rounded(period, 6), way, rounded(chance.between(0, 1), 3),
                    rounded(chance.octaves(0.3, 1.5), 3)});
  };
  wave(chance.between(0.02, 0.035), orientation);
  wave(chance.octaves(0.2e-3, 2e-3), chance.happens(0.6) ? orientation : any_orientation(chance));
  tell_walls(made, {add_straight(made, rounded(chance.octaves(100, 1000), 3), rounded(chance.between(0.005, 0.05), 3),
                                 chance.happens(0.5) ? orientation : any_orientation(chance))});
  return made;
}

StepTruth add_step(Composition& made, double line, double angle, glm::dvec2 change) {
  const glm::dvec2 way = way_of(angle);
  made.push(fmt::format("if {} * x + {} * y > {} then vector({} N, {} N) else vector(0 N, 0 N)", number(way.x),
                        number(way.y), millimetres(line), number(change.x), number(change.y)),
            [=](const Sample& hand) { return glm::dot(way, hand.position) > line ? change : glm::dvec2(0); });
  return {line, angle, change.x, change.y};
}

glm::dvec2 any_change(Chance& chance, double angle) {
  const double size = rounded(chance.octaves(0.2, 3), 3) * (chance.happens(0.5) ? 1 : -1);
  const glm::dvec2 change = size * way_of(chance.happens(0.7) ? angle : any_orientation(chance));
  return {rounded(change.x, 4), rounded(change.y, 4)};
}

/// A step, and a spring or ribs or both.
Composition steps_beside(Chance& chance) {
  Composition made = any_patch(chance);
  const double half = std::min(made.half().x, made.half().y), angle = any_orientation(chance);
  made.truth.steps = {{add_step(made, rounded(half * chance.between(-0.6, 0.6), 3), angle, any_change(chance, angle))}};
  made.truth.walls.emplace();
  const bool spring = chance.happens(0.6);
  if (spring) add_spring(made, chance, 60);
  if (!spring || chance.happens(0.5)) add_texture(made, chance, any_waveform(chance), 1e-3, 8e-3, 1.5);
  made.truth[Cue::constant] = open;
  return made;
}

/// Two or three steps along one direction.
Composition few_steps(Chance& chance) {
  Composition made = any_patch(chance);
  const double half = std::min(made.half().x, made.half().y), angle = any_orientation(chance);
  made.truth.walls.emplace();
  std::vector<StepTruth> steps;
  double line = -half * chance.between(0.5, 0.7);
  const int count = chance.happens(0.5) ? 2 : 3;
  for (int i = 0; i < count; ++i) {
    steps.push_back(add_step(made, rounded(line, 3), angle, any_change(chance, angle)));
    line += half * chance.between(0.3, 0.5);
  }
  made.truth.steps = steps;
  made.truth[Cue::constant] = open;
  return made;
}

/// A slope in equal steps: in the mean it pushes like a spring, and the rest is a sawtooth.
Composition staircases(Chance& chance) {
  Composition made = any_patch(chance);
  const double longest = std::min(made.longest_period(), 0.03);
  const double angle = any_orientation(chance), period = rounded(chance.octaves(2e-3, longest), 3);
  const double most = std::min(2.0, 8 * period / made.half().x);  // N: below the device's limit
  const double size = rounded(chance.octaves(0.2 * most, most), 3) * (chance.happens(0.5) ? 1 : -1);
  const glm::dvec2 way = way_of(angle);
  const double stiffness = -size / period;
  made.push(fmt::format("{} N/m * ({} * x + {} * y) * {}", number(-stiffness), number(way.x), number(way.y),
                        unit_vector(angle)),
            [=](const Sample& hand) { return -stiffness * glm::dot(way, hand.position) * way; });
  made.push_wave({sawtooth(), period, angle, rounded(chance.between(0, 1), 3), 0.5 * std::abs(size)},
                 size > 0 ? angle : angle + pi);
  made.truth[Cue::stiffness] = valued(stiffness), made.truth[Cue::stiffness_across] = valued(0);
  made.truth[Cue::axis] = valued(std::fmod(angle, pi));
  made.truth[Cue::constant] = open;
  return made;
}

/// In a wall or at a strong spring's end, the device has no force left for what resists the hand.
Composition resistance_at_a_limit(Chance& chance) {
  Composition made;
  const double stiffness = rounded(chance.octaves(300, 2000), 3);
  if (chance.happens(0.7)) {
    tell_walls(made,
               {add_straight(made, stiffness, rounded(chance.between(-0.05, -0.02), 3), any_orientation(chance))});
  } else {
    const glm::dvec2 rest{rounded(chance.between(-0.06, 0.06), 3), rounded(chance.between(-0.06, 0.06), 3)};
    made.push(
        fmt::format("-{} N/m * (hand - vector({}, {}))", number(stiffness), millimetres(rest.x), millimetres(rest.y)),
        [=](const Sample& hand) { return -stiffness * (hand.position - rest); });
    made.truth[Cue::stiffness] = valued(stiffness), made.truth[Cue::constant] = open;
  }
  const double size = rounded(chance.octaves(0.1, 1), 3);
  switch (static_cast<int>(chance.between(0, 4))) {
    case 0:
      made.push(fmt::format("sticky({} N)", number(size)));
      made.truth[Cue::friction] = valued(size), made.truth[Cue::breakaway] = open;
      break;
    case 1: add_friction(made, chance, 1); break;
    case 2: add_viscosity(made, chance, 3); break;
    default: add_mass(made, chance);
  }
  return made;
}

}  // namespace

std::vector<Family> obstacle_families() {
  return {{"two walls", two_walls},      {"box", boxes},
          {"round wall", round_walls},   {"wall beside slow waves", walls_beside_slow_waves},
          {"wall beside slow and fine", walls_beside_slow_and_fine},
          {"step beside", steps_beside}, {"few steps", few_steps},
          {"staircase", staircases},     {"resistance at a limit", resistance_at_a_limit}};
}

}  // namespace wale::truth
