// Forces by time.

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "tests/truth/families.hpp"

namespace wale::truth {
namespace {

using std::numbers::pi;

void add_shaking(Composition& made, Chance& chance, double size, double rate) {
  const double angle = any_orientation(chance);
  const glm::dvec2 way{std::cos(angle), std::sin(angle)};
  const ForceLaw law = [=](const Sample& hand) { return size * std::sin(2 * pi * rate * hand.time) * way; };
  made.statement("active 20 W");
  if (chance.happens(0.3))  // the phase begins when the hand comes
    made.push(fmt::format("{} N * sin(2 * pi * phase({} Hz)) * {}", number(size), number(rate), unit_vector(angle)));
  else
    made.push(fmt::format("{} N * sin(2 * pi * {} Hz * time) * {}", number(size), number(rate), unit_vector(angle)),
              law);
}

Composition sways(Chance& chance) {
  Composition made = any_patch(chance);
  add_sway(made, chance, 3);
  return made;
}

Composition vibrations(Chance& chance) {
  Composition made = any_patch(chance);
  add_vibration(made, chance, 3);
  return made;
}

/// Two rates that come and go together: their size is not defined, but a vibration it is.
Composition beats(Chance& chance) {
  Composition made = any_patch(chance);
  const double size = rounded(chance.octaves(0.05, 1.5), 3), rate = rounded(chance.octaves(25, 300), 3);
  const double apart = rounded(chance.between(2, 8), 2), angle = any_orientation(chance);
  const glm::dvec2 way{std::cos(angle), std::sin(angle)};
  made.statement("active 20 W");
  made.push(fmt::format("{} N * (sin(2 * pi * {} Hz * time) + sin(2 * pi * {} Hz * time)) * {}", number(size),
                        number(rate), number(rate + apart), unit_vector(angle)),
            [=](const Sample& hand) {
              return size * (std::sin(2 * pi * rate * hand.time) + std::sin(2 * pi * (rate + apart) * hand.time)) * way;
            });
  made.allow(2e-4 * size);  // each of the two sines is rounded by itself
  made.truth[Cue::vibration] = some;
  made.truth[Cue::vibration_rate] = open;
  made.truth[Cue::other_vibration] = valued(size);
  made.truth[Cue::other_vibration_rate] = open;  // either
  return made;
}

/// One soft push after another: a sway by its rate, with a force in the mean.
Composition heartbeats(Chance& chance) {
  Composition made = any_patch(chance);
  // Slow and weak enough that its harmonics above 10 Hz are below 0.01 N.
  const double size = rounded(chance.octaves(0.1, 0.8), 3), rate = rounded(chance.between(0.8, 1.6), 3);
  const double share = rounded(chance.between(0.4, 0.6), 2), angle = any_orientation(chance);
  const glm::dvec2 way{std::cos(angle), std::sin(angle)};
  made.statement("active 20 W");
  made.statement(fmt::format("let turn = {} Hz * time", number(rate)));
  made.push(
      fmt::format("(if turn - floor(turn) < {0} then {1} N * sin(pi * (turn - floor(turn)) / {0})^2 else 0 N) * {2}",
                  number(share), number(size), unit_vector(angle)),
      [=](const Sample& hand) {
        const double turn = rate * hand.time - std::floor(rate * hand.time);
        return turn < share ? size * std::pow(std::sin(pi * turn / share), 2) * way : glm::dvec2{0};
      });
  made.truth[Cue::sway] = some;
  made.truth[Cue::sway_rate] = valued(rate);
  made.truth[Cue::constant] = open;
  return made;
}

/// Sways of few periods in the time that a reader looks, which seldom fit into it a whole number of times.
Composition slow_sways(Chance& chance) {
  Composition made = any_patch(chance);
  const double size = rounded(chance.octaves(0.1, 2), 3), rate = rounded(chance.octaves(0.28, 1.4), 3);
  add_shaking(made, chance, size, rate);
  made.truth[Cue::sway] = valued(size);
  made.truth[Cue::sway_rate] = valued(rate);
  return made;
}

/// What dies away: its size is the 99th percentile of the changing force over the 8 s that are looked at.
Composition dying(Chance& chance) {
  Composition made = any_patch(chance);
  const bool sway = chance.happens(0.3);
  const double size = rounded(chance.octaves(0.2, 2), 3), lasts = rounded(chance.octaves(sway ? 1 : 0.4, 4), 3);
  const double rate = rounded(sway ? chance.octaves(2, 8) : chance.octaves(15, 250), 3);
  const double angle = any_orientation(chance);
  const glm::dvec2 way{std::cos(angle), std::sin(angle)};
  const auto at = [=](double seconds) { return size * std::exp(-seconds / lasts) * std::sin(2 * pi * rate * seconds); };
  made.statement("active 20 W");
  made.push(fmt::format("{} N * exp(-time / {} s) * sin(2 * pi * {} Hz * time) * {}", number(size), number(lasts),
                        number(rate), unit_vector(angle)),
            [=](const Sample& hand) { return at(hand.time) * way; });
  constexpr int moments = 80000;
  std::vector<double> sizes;
  for (int i = 0; i < moments; ++i) sizes.push_back(std::abs(at(8.0 * i / moments)));
  std::ranges::nth_element(sizes, sizes.begin() + moments / 100 * 99);
  made.truth[sway ? Cue::sway : Cue::vibration] = valued(sizes[moments / 100 * 99]);
  made.truth[sway ? Cue::sway_rate : Cue::vibration_rate] = valued(rate);
  return made;
}

}  // namespace

void add_sway(Composition& made, Chance& chance, double strongest) {
  const double size = rounded(chance.octaves(0.05, strongest), 3), rate = rounded(chance.octaves(0.5, 9), 3);
  add_shaking(made, chance, size, rate);
  made.truth[Cue::sway] = valued(size);
  made.truth[Cue::sway_rate] = valued(rate);
}

void add_vibration(Composition& made, Chance& chance, double strongest) {
  const double size = rounded(chance.octaves(0.05, strongest), 3), rate = rounded(chance.octaves(15, 350), 3);
  add_shaking(made, chance, size, rate);
  made.truth[Cue::vibration] = valued(size);
  made.truth[Cue::vibration_rate] = valued(rate);
}

std::vector<Family> time_families() {
  return {{"sway", sways},           {"slow sway", slow_sways}, {"vibration", vibrations},
          {"dying swing", dying}, {"beat", beats},           {"heartbeat", heartbeats}};
}

}  // namespace wale::truth
