// Several waves at once.

#include <numbers>

#include "tests/truth/families.hpp"

namespace wale::truth {
namespace {

using std::numbers::pi;

Wave wave_of(Chance& chance, const Waveform& form, double period, double orientation, double amplitude) {
  return {form, period, orientation, rounded(chance.between(0, 1), 3), rounded(amplitude, 3)};
}

/// The waves as forces, or as one height whose slopes are in the same proportions.
void add_waves(Composition& made, Chance& chance, std::vector<Wave> waves) {
  if (chance.happens(0.5)) {
    for (const Wave& wave : waves) made.push_wave(wave);
    return;
  }
  const double size = rounded(chance.octaves(0.1, 4), 3);
  for (Wave& wave : waves) {
    double steepest = 0;
    for (int i = 0; i < 1000; ++i) steepest = std::max(steepest, std::abs(wave.form.slope(i / 1000.0)));
    wave.amplitude = rounded(1e3 * wave.amplitude * wave.period / steepest, 5);
  }
  made.push_height(waves, size);
}

/// Two waves along one direction whose periods go p and q times into their common multiple, which is the period of
/// both.
Composition collinear(Chance& chance) {
  Composition made = any_patch(chance);
  const auto [p, q] = chance.one_of({std::pair(2, 3), {3, 4}, {2, 5}, {3, 5}, {4, 5}});
  const double multiple = rounded(chance.octaves(1e-3, made.longest_period()), 3);
  const double orientation = any_orientation(chance), size = chance.octaves(0.05, 2);
  made.truth[Cue::period] = valued(multiple);
  const double other = size * chance.between(0.6, 1.4);
  const auto form = [&] { return chance.happens(0.5) ? sine() : smooth_bumps(rounded(chance.between(0.06, 0.1), 3)); };
  const Waveform first = form(), second = form();
  // Nothing tells which of two waves a harmonic belongs to that both may have.
  if (first.name != sine().name || second.name != sine().name)
    if (band_of(multiple / p) != band_of(multiple / q)) made.truth[Cue::roughness] = made.truth[Cue::bumpiness] = open;
  add_waves(made, chance,
            {wave_of(chance, first, multiple / p, orientation, size),
             wave_of(chance, second, multiple / q, orientation, other)});
  return made;
}

/// Two waves along one direction without a small common multiple: the period of the stronger.
Composition incommensurate(Chance& chance) {
  Composition made = any_patch(chance);
  const double longer = rounded(chance.octaves(0.5e-3, made.longest_period()), 4);
  const double ratio = chance.one_of({1.4142, 1.618, 2.7183, 3.3166, 4.2361});
  const double orientation = any_orientation(chance), size = chance.octaves(0.05, 2);
  const double other = size * chance.between(0.4, 0.75);
  const bool first = chance.happens(0.5);
  const auto form = [&] { return chance.happens(0.5) ? sine() : smooth_bumps(rounded(chance.between(0.06, 0.1), 3)); };
  const Waveform one = form(), two = form();
  add_waves(made, chance,
            {wave_of(chance, one, longer, orientation, first ? size : other),
             wave_of(chance, two, rounded(longer / ratio, 4), orientation, first ? other : size)});
  return made;
}

/// A fine sine on a coarse one along one direction, whose periods have any ratio but nearly a whole one: then the fine
/// one is a harmonic, and both are one wave. Over a long common multiple nobody can say which is the period.
Composition fine_on_coarse(Chance& chance) {
  Composition made = any_patch(chance);
  const double coarse = rounded(chance.octaves(2e-3, made.longest_period()), 4);
  double ratio = chance.octaves(1.3, 12);
  while (std::abs(ratio - std::round(ratio)) < 0.1) ratio = chance.octaves(1.3, 12);
  const double orientation = any_orientation(chance), size = chance.octaves(0.05, 2);
  const double other = size * chance.between(0.4, 1);
  const bool first = chance.happens(0.5);
  made.truth[Cue::period] = open;
  add_waves(made, chance,
            {wave_of(chance, sine(), coarse, orientation, first ? size : other),
             wave_of(chance, sine(), rounded(coarse / ratio, 4), orientation, first ? other : size)});
  return made;
}

/// Ribs of which a whole number fits into wider ones along the same direction: both are waves of their own.
Composition whole_ratio(Chance& chance) {
  Composition made = any_patch(chance);
  const double number = chance.one_of({2.0, 4.0, 5.0, 6.0});
  const double coarse = rounded(chance.octaves(0.4e-3 * number, made.longest_period()), 4);
  const double orientation = any_orientation(chance), size = chance.octaves(0.1, 2);
  made.truth[Cue::period] = valued(coarse);
  add_waves(made, chance,
            {wave_of(chance, smooth_ribs(), coarse, orientation, size),
             wave_of(chance, smooth_ribs(), coarse / number, orientation, size * chance.between(0.7, 1.4))});
  return made;
}

/// Two sines of which a small patch holds three to six periods, sometimes beside one that is a hundred times finer.
Composition few_of_two(Chance& chance) {
  const double side = rounded(chance.between(0.03, 0.09), 3);
  Composition made({side, side});
  const double coarse = rounded(made.longest_period() * chance.between(0.8, 1), 4);
  const double fine = rounded(coarse / chance.between(1.35, 1.85), 4);
  const double orientation = any_orientation(chance), size = chance.octaves(0.2, 1.5);
  const bool along = chance.happens(0.6), finer = chance.happens(0.5);
  const double other = along ? orientation : rounded(std::fmod(orientation + chance.between(0.6, 2.5), pi), 6);
  made.truth[Cue::period] = open;
  made.push_wave(wave_of(chance, sine(), coarse, orientation, size));
  made.push_wave(wave_of(chance, sine(), fine, other, size * chance.between(0.6, 1)));
  if (finer)
    made.push_wave(wave_of(chance, sine(), rounded(chance.octaves(0.16e-3, 0.5e-3), 6), any_orientation(chance),
                           size * chance.between(0.4, 0.7)));
  return made;
}

/// Two waves of any form across each other.
Composition crossed(Chance& chance) {
  Composition made = any_patch(chance);
  const double orientation = any_orientation(chance), size = chance.octaves(0.05, 2);
  const double turned = std::fmod(orientation + (chance.happens(0.5) ? pi / 2 : chance.between(0.5, 2.6)), pi);
  const auto period = [&] { return rounded(chance.octaves(0.3e-3, made.longest_period()), 4); };
  const double first = period(), second = chance.happens(0.3) ? first : period();
  add_waves(made, chance,
            {wave_of(chance, any_waveform(chance), first, orientation, size),
             wave_of(chance, any_waveform(chance), second, rounded(turned, 6), size * chance.between(0.4, 0.7))});
  return made;
}

/// Three sines in directions and scales of their own.
Composition three_waves(Chance& chance) {
  Composition made = any_patch(chance);
  const double orientation = any_orientation(chance), size = chance.octaves(0.05, 1.5);
  std::vector<Wave> waves;
  for (int i = 0; i < 3; ++i)
    waves.push_back(wave_of(chance, sine(), rounded(chance.octaves(0.5e-3, made.longest_period()), 4),
                            rounded(std::fmod(orientation + i * pi / 3 + chance.between(-0.25, 0.25) + pi, pi), 6),
                            i == 0 ? size : size * chance.between(0.5, 0.75)));
  add_waves(made, chance, waves);
  return made;
}

}  // namespace

std::vector<Family> sum_families() {
  return {{"collinear", collinear},
          {"incommensurate", incommensurate},
          {"fine on coarse", fine_on_coarse},
          {"whole ratio", whole_ratio},
          {"few periods of two", few_of_two},
          {"crossed", crossed},
          {"three waves", three_waves}};
}

}  // namespace wale::truth
