// Several swings at once, swings that are no sines, and swings beside what resists.

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>
#include <vector>

#include "tests/truth/families.hpp"

namespace wale::truth {
namespace {

using std::numbers::pi;

struct Sine {
  double size = 0, rate = 0, angle = 0;
};

/// N: the 99th percentile of the size of a force over 8 s.
double size_over_time(const std::function<glm::dvec2(double)>& at) {
  constexpr int moments = 400000;
  std::vector<double> sizes;
  for (int i = 0; i < moments; ++i) sizes.push_back(glm::length(at(8.0 * (i + 0.5) / moments)));
  std::ranges::nth_element(sizes, sizes.begin() + moments / 100 * 99);
  return sizes[moments / 100 * 99];
}

glm::dvec2 sum_at(const std::vector<Sine>& sines, double seconds) {
  glm::dvec2 sum{0};
  for (const Sine& each : sines)
    sum += each.size * std::sin(2 * pi * each.rate * seconds) * glm::dvec2{std::cos(each.angle), std::sin(each.angle)};
  return sum;
}

void add_sines(Composition& made, Chance& chance, const std::vector<Sine>& sines) {
  const bool by_phase = chance.happens(0.5);
  made.statement("active 20 W");
  for (const Sine& each : sines) {
    const std::string turns = by_phase ? fmt::format("phase({} Hz)", number(each.rate))
                                       : fmt::format("{} Hz * time", number(each.rate));
    const std::string text =
        fmt::format("{} N * sin(2 * pi * {}) * {}", number(each.size), turns, unit_vector(each.angle));
    if (by_phase)
      made.push(text);
    else
      made.push(text, [=](const Sample& hand) { return sum_at({each}, hand.time); });
    made.allow(2e-4 * each.size);
  }
}

/// A sway and a vibration, each of any size and along any axis.
Composition sways_and_vibrations(Chance& chance) {
  Composition made = any_patch(chance);
  const Sine slow{rounded(chance.octaves(0.1, 2), 3), rounded(chance.between(1.6, 8), 2), any_orientation(chance)};
  const Sine fast{rounded(chance.octaves(0.1, 2), 3), rounded(chance.octaves(30, 300), 2), any_orientation(chance)};
  add_sines(made, chance, {slow, fast});
  made.truth[Cue::sway] = valued(slow.size), made.truth[Cue::sway_rate] = valued(slow.rate);
  made.truth[Cue::vibration] = valued(fast.size), made.truth[Cue::vibration_rate] = valued(fast.rate);
  return made;
}

/// Two along one axis: the size is that of both together, and each has its own. One rate is no small multiple of the
/// other.
Composition two_of(Chance& chance, bool fast) {
  Composition made = any_patch(chance);
  const double angle = any_orientation(chance);
  const double rate = rounded(fast ? chance.octaves(20, 90) : chance.between(1.2, 3), 3);
  const double ratio = chance.one_of({1.37, 1.5, 1.618, 2.4, 2.7});
  Sine one{rounded(chance.octaves(0.3, 1.5), 3), rate, angle};
  Sine other{rounded(one.size * chance.between(0.35, 0.8), 3), rounded(rate * ratio, 3), angle};
  if (chance.happens(0.5)) std::swap(one.rate, other.rate);
  add_sines(made, chance, {one, other});
  made.truth[fast ? Cue::vibration : Cue::sway] =
      valued(size_over_time([&](double seconds) { return sum_at({one, other}, seconds); }));
  made.truth[fast ? Cue::vibration_rate : Cue::sway_rate] = valued(one.rate);
  made.truth[fast ? Cue::other_vibration : Cue::other_sway] = valued(other.size);
  made.truth[fast ? Cue::other_vibration_rate : Cue::other_sway_rate] = valued(other.rate);
  return made;
}
Composition two_vibrations(Chance& chance) { return two_of(chance, true); }
Composition two_sways(Chance& chance) { return two_of(chance, false); }

/// A sway with corners is one sway, however many harmonics of it are faster than 10 Hz: its size is about its mean.
Composition cornered_sways(Chance& chance) {
  Composition made = any_patch(chance);
  const double size = rounded(chance.octaves(0.1, 2), 3), rate = rounded(chance.between(1.6, 6), 2);
  const double angle = any_orientation(chance);
  made.statement("active 20 W");
  made.statement(fmt::format("let turn = phase({} Hz)", number(rate)));
  const int kind = chance.one_of({0, 1, 2, 3});
  const double part = rounded(chance.between(0.15, 0.45), 2);
  std::string text;
  double above_mean = 0, mean = 0;
  if (kind == 0) text = "2 * turn - 1", above_mean = 0.99;
  if (kind == 1) text = "if turn < 0.5 then 1 else -1", above_mean = 1;
  if (kind == 2) text = "abs(4 * turn - 2) - 1", above_mean = 0.99;
  if (kind == 3) text = fmt::format("if turn < {} then 1 else 0", number(part)), above_mean = 1 - part, mean = part;
  made.push(fmt::format("{} N * ({}) * {}", number(size), text, unit_vector(angle)));
  made.truth[Cue::sway] = valued(above_mean * size), made.truth[Cue::sway_rate] = valued(rate);
  made.truth[Cue::constant] = valued(mean * size);
  return made;
}

/// A drag, and beside it a sway of any form.
Composition drags_beside_sways(Chance& chance) {
  Composition made = any_patch(chance);
  add_viscosity(made, chance, 6);
  const double size = rounded(chance.octaves(0.2, 2), 3), rate = rounded(chance.between(0.8, 6), 2);
  made.statement("active 20 W");
  made.statement(fmt::format("let turn = phase({} Hz)", number(rate)));
  const int kind = chance.one_of({0, 0, 1, 2});
  const std::string text = kind == 0   ? "if turn < 0.5 then 1 else -1"
                           : kind == 1 ? "2 * turn - 1"
                                       : "sin(2 * pi * turn)";
  made.push(fmt::format("{} N * ({}) * {}", number(size), text, unit_vector(any_orientation(chance))));
  made.truth[Cue::sway] = valued((kind == 1 ? 0.99 : 1) * size), made.truth[Cue::sway_rate] = valued(rate);
  return made;
}

/// What is over within a second or so, a sway or a vibration: its size is the 99th percentile over 8 s.
Composition short_swings(Chance& chance) {
  Composition made = any_patch(chance);
  const double size = rounded(chance.octaves(0.5, 2), 3), lasts = rounded(chance.octaves(0.15, 0.5), 3);
  const double rate = rounded(chance.happens(0.5) ? chance.between(4, 9) : chance.octaves(11, 200), 3);
  const double angle = any_orientation(chance);
  const glm::dvec2 way{std::cos(angle), std::sin(angle)};
  const auto at = [=](double seconds) {
    return size * std::exp(-seconds / lasts) * std::sin(2 * pi * rate * seconds) * way;
  };
  made.statement("active 20 W");
  made.push(fmt::format("{} N * exp(-time / {} s) * sin(2 * pi * phase({} Hz)) * {}", number(size), number(lasts),
                        number(rate), unit_vector(angle)));
  made.truth[rate < 10 ? Cue::sway : Cue::vibration] = valued(size_over_time(at));
  made.truth[rate < 10 ? Cue::sway_rate : Cue::vibration_rate] = valued(rate);
  return made;
}

/// A friction that holds and slides alike, beside a vibration: nothing breaks away.
Composition frictions_beside_vibrations(Chance& chance) {
  Composition made = any_patch(chance);
  const double friction = rounded(chance.octaves(0.2, 1.5), 3);
  made.push(fmt::format("sticky({} N)", number(friction)));
  const Sine swing{rounded(chance.octaves(0.2, 1.5), 3),
                   rounded(chance.happens(0.5) ? chance.octaves(12, 200) : chance.between(1, 8), 2),
                   any_orientation(chance)};
  made.statement("active 20 W");
  made.push(fmt::format("{} N * sin(2 * pi * phase({} Hz)) * {}", number(swing.size), number(swing.rate),
                        unit_vector(swing.angle)));
  made.truth[Cue::friction] = valued(friction);
  const bool fast = swing.rate >= 10;
  made.truth[fast ? Cue::vibration : Cue::sway] = valued(swing.size);
  made.truth[fast ? Cue::vibration_rate : Cue::sway_rate] = valued(swing.rate);
  return made;
}

/// A wave that travels over the patch has no mean over time at any place.
Composition travelling_waves(Chance& chance) {
  Composition made = any_patch(chance);
  const double size = rounded(chance.octaves(0.2, 2), 3), rate = rounded(chance.octaves(0.6, 6), 3);
  const double period = rounded(chance.octaves(5e-3, 30e-3), 3), angle = any_orientation(chance);
  const glm::dvec2 way{std::cos(angle), std::sin(angle)};
  made.statement("active 20 W");
  made.push(fmt::format("{} N * sin(2 * pi * ((({} * x) + ({} * y)) / {} - phase({} Hz))) * {}", number(size),
                        number(way.x), number(way.y), millimetres(period), number(rate), unit_vector(angle)));
  for (const Cue cue : {Cue::amplitude, Cue::period, Cue::orientation, Cue::roughness, Cue::bumpiness}) made.truth[cue] = open;
  made.truth.waves = std::nullopt;
  made.truth[Cue::sway] = valued(size), made.truth[Cue::sway_rate] = valued(rate);
  return made;
}

}  // namespace

std::vector<Family> swing_families() {
  return {{"sway and vibration", sways_and_vibrations},
          {"two vibrations", two_vibrations},
          {"two sways", two_sways},
          {"sway with corners", cornered_sways},
          {"short swing", short_swings},
          {"drag beside a sway", drags_beside_sways},
          {"friction beside a swing", frictions_beside_vibrations},
          {"travelling wave", travelling_waves}};
}

}  // namespace wale::truth
