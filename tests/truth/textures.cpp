// One wave: every waveform, from 0.12 to 70 mm, as a force and as a height.

#include <fmt/format.h>

#include "tests/truth/families.hpp"

namespace wale::truth {
namespace {

constexpr double shortest = 0.12e-3;  // m: just above two encoder counts

Composition one_wave(Chance& chance, const Waveform& form) {
  Composition made = any_patch(chance);
  add_texture(made, chance, form, shortest, std::min(made.longest_period(), 0.07));
  return made;
}

Composition sines(Chance& chance) { return one_wave(chance, sine()); }
Composition squares(Chance& chance) { return one_wave(chance, square()); }
Composition triangles(Chance& chance) { return one_wave(chance, triangle()); }
Composition sawteeth(Chance& chance) { return one_wave(chance, sawtooth()); }
Composition ridges(Chance& chance) { return one_wave(chance, ridge(rounded(chance.between(0.05, 0.3), 3))); }
Composition missing_fundamentals(Chance& chance) {
  return one_wave(chance, missing_fundamental(rounded(chance.between(0.5, 1.2), 3)));
}
Composition bumps(Chance& chance) { return one_wave(chance, smooth_bumps(rounded(chance.between(0.05, 0.1), 3))); }

/// Between a third and half of the patch: only a sine is told from a hill there.
Composition long_sines(Chance& chance) {
  Composition made = any_patch(chance);
  add_texture(made, chance, sine(), made.longest_period(), std::min(1.5 * made.longest_period(), 0.07));
  return made;
}

/// Finer than two encoder counts: reported as itself.
Composition fine_waves(Chance& chance) {
  Composition made = any_patch(chance);
  add_texture(made, chance, chance.happens(0.5) ? sine() : any_waveform(chance), 0.03e-3, 0.11e-3);
  return made;
}

/// `grating` as users write it.
Composition gratings(Chance& chance) {
  Composition made = any_patch(chance);
  const double duty = rounded(chance.between(0.05, 0.6), 3);
  const double smooth = rounded(std::min(chance.between(0.02, 0.12), duty / 2), 3);
  Wave wave{sine(), rounded(chance.octaves(shortest, std::min(made.longest_period(), 0.07)), 4),
            any_orientation(chance), 0, 1};
  made.push_height(
      fmt::format("grating({} * x + {} * y, period: {}, duty: {}, smooth: {})", number(wave.direction().x),
                  number(wave.direction().y), millimetres(wave.period), number(duty), number(smooth)),
      wave, [duty, smooth](double t) { return grating_slope(t, duty, smooth); }, rounded(chance.octaves(0.02, 4), 3));
  return made;
}

}  // namespace

void add_texture(Composition& made, Chance& chance, const Waveform& form, double shortest_period, double longest,
                 double strongest) {
  const double amplitude = rounded(chance.octaves(0.02, strongest), 3);
  Wave wave{form, rounded(chance.octaves(shortest_period, longest), 4), any_orientation(chance),
            rounded(chance.between(0, 1), 3), amplitude};
  if (chance.happens(0.4)) {
    wave.amplitude = 1;
    made.push_height({wave}, amplitude);
  } else {
    made.push_wave(wave, chance.happens(0.2) ? std::optional(any_orientation(chance)) : std::nullopt);
  }
}

std::vector<Family> texture_families() {
  return {{"sine", sines},
          {"long sine", long_sines},
          {"square", squares},
          {"triangle", triangles},
          {"sawtooth", sawteeth},
          {"narrow ridge", ridges},
          {"missing fundamental", missing_fundamentals},
          {"smooth bumps", bumps},
          {"grating", gratings},
          {"finer than 2 counts", fine_waves}};
}

}  // namespace wale::truth
