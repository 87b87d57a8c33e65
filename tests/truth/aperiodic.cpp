// Reliefs without a period.

#include <fmt/format.h>

#include <numbers>

#include "tests/truth/families.hpp"

namespace wale::truth {
namespace {

using std::numbers::pi;

/// What a relief without a period leaves open: its mean over the patch is a little force, too.
void without_period(Composition& made) {
  for (const Cue cue : {Cue::orientation, Cue::roughness, Cue::bumpiness, Cue::constant}) made.truth[cue] = open;
  made.truth.waves.reset();
}

/// A round hill or hollow: bumpiness without a period.
Composition hills(Chance& chance) {
  Composition made = any_patch(chance);
  add_hill(made, chance, 4);
  without_period(made);
  made.truth[Cue::bumpiness] = some;
  return made;
}

/// Grains in no order; `lateral` gives them their size.
Composition grains(Chance& chance) {
  Composition made = any_patch(chance);
  const double size = rounded(chance.octaves(0.05, 4), 3);
  const std::string grain = millimetres(rounded(chance.octaves(0.4e-3, 8e-3), 3));
  const int seed = static_cast<int>(chance.between(0, 100));
  made.statement(fmt::format("height grains = {}(x / {}, y / {}, seed: {})",
                             chance.happens(0.5) ? "noise2" : "gradient_noise", grain, grain, seed));
  made.push(fmt::format("lateral(grains, amplitude: {} N)", number(size)));
  without_period(made);
  made.truth[Cue::amplitude] = valued(size);
  return made;
}

/// A wave that grows ever finer along its way.
Composition chirp(Chance& chance) {
  Composition made = any_patch(chance);
  const double size = rounded(chance.octaves(0.05, 4), 3), angle = any_orientation(chance);
  const double middle = rounded(chance.octaves(1, 4), 3);                            // mm
  const double reach = 1.42e3 * std::max(made.half().x, made.half().y);              // mm
  const double curve = rounded(chance.between(0.5, 0.8) / (2 * middle * reach), 4);  // 1/mm^2
  const glm::dvec2 way{std::cos(angle), std::sin(angle)};
  made.statement(fmt::format("let along = ({} * x + {} * y) / 1 mm", number(way.x), number(way.y)));
  made.push(fmt::format("{} N * sin(2 * pi * (along / {} + {} * along^2)) * {}", number(size), number(middle),
                        number(curve), unit_vector(angle)),
            [=](const Sample& hand) {
              const double along = 1e3 * glm::dot(way, hand.position);
              return size * std::sin(2 * pi * (along / middle + curve * along * along)) * way;
            });
  without_period(made);
  made.truth[Cue::amplitude] = valued(size);
  return made;
}

/// A sine that wavers about its period, or comes and goes: rough, by however long it takes to be the same again.
Composition wavering(Chance& chance) {
  Composition made = any_patch(chance);
  const double size = rounded(chance.octaves(0.05, 4), 3), angle = any_orientation(chance);
  const double period = rounded(chance.octaves(1.2, 4), 3), after = rounded(period * chance.between(8, 16), 3);  // mm
  const double deep = rounded(chance.between(0.3, 2), 3);
  const bool comes_and_goes = chance.happens(0.5);
  const glm::dvec2 way{std::cos(angle), std::sin(angle)};
  const ForceLaw law = [=](const Sample& hand) {
    const double along = 1e3 * glm::dot(way, hand.position), turn = 2 * pi * along / after;
    const double there = 0.5 + 0.5 * std::cos(turn);
    return size *
           (comes_and_goes ? std::sin(2 * pi * along / period) * there * there
                           : std::sin(2 * pi * along / period + deep * std::sin(turn))) *
           way;
  };
  made.statement(fmt::format("let along = ({} * x + {} * y) / 1 mm", number(way.x), number(way.y)));
  made.statement(fmt::format("let turn = 2 * pi * along / {}", number(after)));
  const std::string wave = comes_and_goes
                               ? fmt::format("sin(2 * pi * along / {}) * (0.5 + 0.5 * cos(turn))^2", number(period))
                               : fmt::format("sin(2 * pi * along / {} + {} * sin(turn))", number(period), number(deep));
  made.push(fmt::format("{} N * {} * {}", number(size), wave, unit_vector(angle)), law);
  made.truth[Cue::amplitude] = made.truth[Cue::roughness] = valued(made.percentile_99(law));
  made.truth[Cue::period] = made.truth[Cue::orientation] = open;
  made.truth.waves.reset();
  return made;
}

}  // namespace

void add_hill(Composition& made, Chance& chance, double strongest) {
  // Wide enough that more than a hundredth of the patch pushes.
  const double width = rounded(chance.octaves(6e-3, 15e-3), 3);
  const double size = rounded(chance.octaves(0.2, strongest), 3) * (chance.happens(0.5) ? 1 : -1);
  const glm::dvec2 top{rounded(chance.between(-0.02, 0.02), 3), rounded(chance.between(-0.02, 0.02), 3)};
  made.statement(fmt::format("let from_top = (hand - vector({}, {})) / {}", millimetres(top.x), millimetres(top.y),
                             millimetres(width)));
  made.push(fmt::format("{} N * exp(0.5 - dot(from_top, from_top) / 2) * from_top", number(size)),
            [=](const Sample& hand) {
              const glm::dvec2 from_top = (hand.position - top) / width;
              return size * std::exp(0.5 - glm::dot(from_top, from_top) / 2) * from_top;
            });
  // Whether a single hill is a trend or all of the relief.
  for (const Cue cue : {Cue::amplitude, Cue::roughness, Cue::bumpiness, Cue::constant}) made.truth[cue] = open;
}

std::vector<Family> aperiodic_families() {
  return {{"hill", hills}, {"grains", grains}, {"chirp", chirp}, {"wavering", wavering}};
}

}  // namespace wale::truth
