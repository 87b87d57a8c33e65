// What stands in one place beside something else: a hill beside a spring or a wall, walls that begin with a jump, walls
// one behind the other, walls that push with a power of the depth, springs in half of the patch, soft steps, and walls
// that the author limits.

#include <fmt/format.h>

#include <numbers>

#include "tests/truth/families.hpp"

namespace wale::truth {
namespace {

using std::numbers::pi;

double nearer_half(const Composition& made) { return std::min(made.half().x, made.half().y); }

/// A wall behind a straight line, which begins with `preload` newtons.
WallTruth push_wall(Composition& made, double stiffness, double face, double angle, double preload = 0) {
  const glm::dvec2 inward{std::cos(angle), std::sin(angle)};
  made.push(fmt::format("(if {0} * x + {1} * y > {2} then -{3} N/m * ({0} * x + {1} * y - {2}) - {4} N else 0 N) * {5}",
                        number(inward.x), number(inward.y), millimetres(face), number(stiffness), number(preload),
                        unit_vector(angle)),
            [=](const Sample& hand) {
              const double depth = glm::dot(inward, hand.position) - face;
              return depth > 0 ? -(preload + stiffness * depth) * inward : glm::dvec2(0);
            });
  return {stiffness, face, angle};
}

/// The stiffest is the wall of the program.
void expect_walls(Composition& made, const std::vector<WallTruth>& walls, std::optional<double> jump = {}) {
  const WallTruth& stiffest = *std::ranges::max_element(walls, {}, &WallTruth::stiffness);
  made.truth[Cue::wall_stiffness] = valued(stiffest.stiffness), made.truth[Cue::face] = open;
  made.truth[Cue::wall_jump] = jump ? valued(*jump) : Expected{};
  made.truth.walls = walls, made.truth.steps.emplace();
  made.truth[Cue::constant] = open;
}

/// How a round hill's push depends on the distance from its top, in widths: 1 at most.
struct HillForm {
  const char* text;  ///< over the distance, of `far`
  double (*law)(double far);
};

/// A hill as a push away from its top, or a hole as one towards it.
void push_hill(Composition& made, Chance& chance, double weakest, double strongest) {
  static constexpr HillForm forms[] = {
      // The slope of a Gaussian; of the square of a cosine; of (1 - r^2)^2, which ends at a rim with a corner.
      {"exp(0.5 - 0.5 * far^2)", [](double far) { return std::exp(0.5 - 0.5 * far * far); }},
      {"(if far < 2 then sin(pi * far / 2) / max(far, 0.001) else 0)",
       [](double far) { return far < 2 ? std::sin(pi * far / 2) / std::max(far, 0.001) : 0; }},
      {"2.598076211 * max(0, 1 - far^2 / 4) / 2",
       [](double far) { return 2.598076211 * std::max(0.0, 1 - far * far / 4) / 2; }}};
  const HillForm& form = forms[chance.happens(0.6) ? 0 : chance.happens(0.5) ? 1 : 2];
  const double width = rounded(chance.octaves(7e-3, 0.2 * nearer_half(made)), 3);
  const double size = rounded(chance.octaves(weakest, strongest), 3) * (chance.happens(0.5) ? 1 : -1);
  const auto aside = [&] {
    return chance.happens(0.4) ? 0 : rounded(chance.between(-0.25, 0.25) * nearer_half(made), 3);
  };
  const glm::dvec2 top{aside(), aside()};
  made.statement(fmt::format("let from_top = (hand - vector({}, {})) / {}", millimetres(top.x), millimetres(top.y),
                             millimetres(width)));
  made.statement("let far = length(from_top)");
  const ForceLaw law = [=](const Sample& hand) {
    const glm::dvec2 from_top = (hand.position - top) / width;
    return size * form.law(glm::length(from_top)) * from_top;
  };
  made.push(fmt::format("{} N * {} * from_top", number(size), form.text), law);
  made.truth[Cue::amplitude] = made.truth[Cue::bumpiness] = valued(made.percentile_99(law));
  made.truth[Cue::orientation] = open;
  made.truth.waves.reset();
}

/// Beside a spring or a push, neither hides in the other.
Composition hills_beside_trends(Chance& chance) {
  Composition made = any_patch(chance);
  push_hill(made, chance, 0.3, 2);
  if (chance.happens(0.6))
    add_spring(made, chance, 70);
  else
    add_constant(made, chance, 1.5);
  return made;
}

Composition hills_beside_walls(Chance& chance) {
  Composition made = any_patch(chance);
  push_hill(made, chance, 0.3, 2);
  expect_walls(made, {push_wall(made, rounded(chance.octaves(100, 800), 3),
                                rounded(nearer_half(made) * chance.between(0.5, 0.75), 3), any_orientation(chance))});
  return made;
}

Composition hills_beside_steps(Chance& chance) {
  Composition made = any_patch(chance);
  push_hill(made, chance, 0.3, 2);
  const double angle = any_orientation(chance), line = rounded(nearer_half(made) * chance.between(-0.6, 0.6), 3);
  const glm::dvec2 way{std::cos(angle), std::sin(angle)};
  const double size = rounded(chance.octaves(0.3, 3), 3);
  made.push(fmt::format("(if {} * x + {} * y > {} then {} N else 0 N) * {}", number(way.x), number(way.y),
                        millimetres(line), number(size), unit_vector(angle)),
            [=](const Sample& hand) { return glm::dot(way, hand.position) > line ? size * way : glm::dvec2(0); });
  made.truth.walls.emplace();
  made.truth.steps = {{line, angle, size * way.x, size * way.y}};
  made.truth[Cue::constant] = open;
  return made;
}

/// A wall that begins with a jump, over a texture.
Composition jumping_walls_on_textures(Chance& chance) {
  Composition made = any_patch(chance);
  const double half = nearer_half(made), jump = rounded(chance.octaves(0.3, 2), 3);
  add_texture(made, chance, any_waveform(chance), 0.5e-3, 8e-3, 1);
  expect_walls(made,
               {push_wall(made, rounded(chance.octaves(100, 1000), 3), rounded(half * chance.between(0, 0.6), 3),
                          any_orientation(chance), jump)},
               jump);
  return made;
}

/// Two of them that meet at an angle, or face each other.
Composition two_jumping_walls(Chance& chance) {
  Composition made = any_patch(chance);
  const double half = nearer_half(made), angle = any_orientation(chance);
  const double turn = chance.happens(0.4) ? pi : rounded(chance.between(60, 120), 3) * pi / 180;
  std::vector<WallTruth> walls;
  double jump = 0;
  for (int i = 0; i < 2; ++i) {
    const double begins = rounded(chance.octaves(0.3, 2), 3);
    walls.push_back(push_wall(made, rounded(chance.octaves(100, 1000), 3), rounded(half * chance.between(0.2, 0.6), 3),
                              angle + i * turn, begins));
    if (i == 0 || walls[1].stiffness > walls[0].stiffness) jump = begins;
  }
  expect_walls(made, walls, jump);
  return made;
}

/// Behind the first face stands a second one.
Composition nested_walls(Chance& chance) {
  Composition made = any_patch(chance);
  const double half = nearer_half(made), angle = any_orientation(chance);
  const double first = rounded(half * chance.between(-0.1, 0.25), 3);
  std::vector<WallTruth> walls = {push_wall(made, rounded(chance.octaves(60, 300), 3), first, angle)};
  walls.push_back(push_wall(made, rounded(chance.octaves(100, 700), 3),
                            rounded(first + half * chance.between(0.2, 0.4), 3), angle));
  expect_walls(made, walls);
  return made;
}

/// A wall that pushes with a power of the depth: softer bodies, or rounder ones (Hertz: 3/2).
void push_bent_wall(Composition& made, Chance& chance) {
  const double angle = any_orientation(chance);
  const double face = rounded(nearer_half(made) * chance.between(-0.2, 0.4), 3);
  const double power = rounded(chance.happens(0.3)   ? 1.5
                               : chance.happens(0.3) ? chance.between(0.6, 0.85)
                                                     : chance.between(1.25, 3.2),
                               3);
  const double newton = rounded(chance.octaves(0.8, 6), 3), scale = 0.06;
  const glm::dvec2 inward{std::cos(angle), std::sin(angle)};
  // The device's own limit stays out of it.
  const double deepest = std::abs(inward.x) * made.half().x + std::abs(inward.y) * made.half().y - face;
  const double size = rounded(newton * std::pow(scale / deepest, power), 5);
  made.push(fmt::format("-{} N * (max({} * x + {} * y - {}, 0 mm) / {})^{} * {}", number(size), number(inward.x),
                        number(inward.y), millimetres(face), millimetres(scale), number(power), unit_vector(angle)),
            [=](const Sample& hand) {
              const double depth = std::max(0.0, glm::dot(inward, hand.position) - face);
              return -size * std::pow(depth / scale, power) * inward;
            });
  made.allow(1e-4);
  const double stiffness = size * std::pow(deepest / scale, power) / deepest;
  expect_walls(made, {{.stiffness = stiffness, .face = face, .inward = angle, .power = power}});
  made.truth[Cue::wall_jump] = open;
}

Composition bent_walls(Chance& chance) {
  Composition made = any_patch(chance);
  push_bent_wall(made, chance);
  if (chance.happens(0.3)) add_viscosity(made, chance, 4);
  return made;
}

Composition bent_walls_on_textures(Chance& chance) {
  Composition made = any_patch(chance);
  push_bent_wall(made, chance);
  add_texture(made, chance, any_waveform(chance), 0.8e-3, 6e-3, 0.8);
  return made;
}

/// A spring on one side of a line along which it pulls: neither a hole nor a wall.
Composition half_springs(Chance& chance) {
  Composition made = any_patch(chance);
  const double angle = any_orientation(chance), line = rounded(nearer_half(made) * chance.between(-0.3, 0.3), 3);
  const double stiffness = rounded(chance.octaves(10, 60), 3);
  const glm::dvec2 across{std::cos(angle), std::sin(angle)}, along{-across.y, across.x};
  made.push(fmt::format("(if {} * x + {} * y > {} then -{} N/m * ({} * x + {} * y) else 0 N) * {}", number(across.x),
                        number(across.y), millimetres(line), number(stiffness), number(along.x), number(along.y),
                        unit_vector(angle + pi / 2)),
            [=](const Sample& hand) {
              return glm::dot(across, hand.position) > line ? -stiffness * glm::dot(along, hand.position) * along
                                                            : glm::dvec2(0);
            });
  for (const Cue cue : {Cue::stiffness, Cue::stiffness_across, Cue::axis, Cue::constant}) made.truth[cue] = open;
  return made;
}

/// A step that rises over some millimetres, by a polynomial.
Composition soft_steps(Chance& chance) {
  Composition made = any_patch(chance);
  const double angle = any_orientation(chance), line = rounded(nearer_half(made) * chance.between(-0.4, 0.4), 3);
  const double size = rounded(chance.octaves(0.3, 2), 3), width = rounded(chance.octaves(2e-3, 14e-3), 3);
  const glm::dvec2 way{std::cos(angle), std::sin(angle)};
  made.push(fmt::format("{} N * smoothstep(({} * x + {} * y - {}) / {} + 0.5) * {}", number(size), number(way.x),
                        number(way.y), millimetres(line), millimetres(width), unit_vector(angle)),
            [=](const Sample& hand) {
              const double t = std::clamp((glm::dot(way, hand.position) - line) / width + 0.5, 0.0, 1.0);
              return size * t * t * (3 - 2 * t) * way;
            });
  made.truth.walls.emplace();
  made.truth.steps = {{line, angle, size * way.x, size * way.y}};
  made.truth[Cue::constant] = open;
  return made;
}

/// The author's limit is reached somewhere behind the face, often just before the patch ends; beside it, friction or a
/// texture.
Composition limited_walls(Chance& chance) {
  Composition made;
  const double stiffness = rounded(chance.octaves(60, 600), 3), face = rounded(chance.between(-0.01, 0.03), 3);
  const double depth = chance.happens(0.7) ? chance.between(0.068, 0.0745) - face : chance.between(0.01, 0.03);
  const double limit = std::min(9.0, rounded(stiffness * depth, 3));
  made.push(fmt::format("firm({} N/m, face: {}) limit {} N", number(stiffness), millimetres(face), number(limit)),
            [=](const Sample& hand) {
              return glm::dvec2{-std::min(limit, stiffness * std::max(0.0, hand.position.x - face)), 0};
            });
  if (chance.happens(0.5)) {
    const double size = rounded(chance.octaves(0.1, 0.8), 3);
    made.push(fmt::format("sticky({} N)", number(size)));
    made.truth[Cue::friction] = valued(size), made.truth[Cue::breakaway] = open;
    made.truth[Cue::wall_push] = valued(limit);
  } else {
    add_texture(made, chance, sine(), 1e-3, 6e-3, 0.8);
  }
  expect_walls(made, {{stiffness, face, 0}});
  return made;
}

}  // namespace

std::vector<Family> place_families() {
  return {{"hill beside a trend", hills_beside_trends},
          {"hill beside a wall", hills_beside_walls},
          {"hill beside a step", hills_beside_steps},
          {"jumping wall on texture", jumping_walls_on_textures},
          {"two jumping walls", two_jumping_walls},
          {"nested walls", nested_walls},
          {"bent wall", bent_walls},
          {"bent wall on texture", bent_walls_on_textures},
          {"half spring", half_springs},
          {"soft step", soft_steps},
          {"limited wall", limited_walls}};
}

}  // namespace wale::truth
