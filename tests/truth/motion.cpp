// Forces by motion.

#include <fmt/format.h>

#include "tests/truth/families.hpp"

namespace wale::truth {
namespace {

Composition viscosities(Chance& chance) {
  Composition made = any_patch(chance);
  add_viscosity(made, chance, 10);
  return made;
}

Composition frictions(Chance& chance) {
  Composition made = any_patch(chance);
  add_friction(made, chance, 3);
  return made;
}

/// The library's own friction, whatever its law near rest.
Composition sticky(Chance& chance) {
  Composition made = any_patch(chance);
  const double size = rounded(chance.octaves(0.1, 2), 3);
  made.push(fmt::format("sticky({} N)", number(size)));
  made.truth[Cue::friction] = valued(size);
  made.truth[Cue::breakaway] = open;
  return made;
}

/// A bristle that holds up to the breakaway force and then slides.
Composition breakaways(Chance& chance) {
  Composition made = any_patch(chance);
  const double sliding = rounded(chance.octaves(0.1, 1.5), 3);
  const double holding = rounded(sliding * chance.between(1.3, 2.5), 3);
  const double bristle = rounded(chance.octaves(300, 1200), 3);
  made.statement("state anchor : position = hand in -115 mm .. 115 mm");
  made.statement("state sliding = 0 in 0 .. 1");
  made.statement(fmt::format("let breaks = length(hand - anchor) > {} mm", number(1e3 * holding / bristle)));
  made.statement("let slides = breaks or sliding > 0.5 and length(velocity) > 8 mm/s");
  made.statement(fmt::format("let stretch = hold(hand - anchor, (if slides then {} N else {} N) / {} N/m)",
                             number(sliding), number(holding), number(bristle)));
  made.statement("next anchor = hand - stretch");
  made.statement("next sliding = if slides then 1 else 0");
  made.push(fmt::format("-{} N/m * stretch", number(bristle)));
  made.truth[Cue::friction] = valued(sliding);
  made.truth[Cue::breakaway] = valued(holding);
  return made;
}

Composition masses(Chance& chance) {
  Composition made = any_patch(chance);
  add_mass(made, chance);
  return made;
}

Composition dragging_masses(Chance& chance) {
  Composition made = any_patch(chance);
  add_viscosity(made, chance, 4);
  if (chance.happens(0.7)) add_friction(made, chance, 1.5);
  if (chance.happens(0.7)) add_mass(made, chance);
  return made;
}

}  // namespace

void add_viscosity(Composition& made, Chance& chance, double strongest) {
  const double viscosity = rounded(chance.octaves(0.2, strongest), 3);
  made.push(chance.happens(0.3) ? fmt::format("viscous({} N s/m)", number(viscosity))
                                : fmt::format("-{} N s/m * velocity", number(viscosity)),
            [=](const Sample& hand) { return -viscosity * hand.velocity; });
  made.truth[Cue::viscosity] = valued(viscosity);
}

void add_friction(Composition& made, Chance& chance, double strongest) {
  const double size = rounded(chance.octaves(0.05, strongest), 3);
  const double rise = rounded(size / chance.octaves(0.002, 0.01), 3);
  made.push(fmt::format("hold(-{} N s/m * velocity, {} N)", number(rise), number(size)), [=](const Sample& hand) {
    const double speed = glm::length(hand.velocity);
    return rise * speed <= size ? -rise * hand.velocity : -size / speed * hand.velocity;
  });
  made.truth[Cue::friction] = valued(size);
  made.truth[Cue::breakaway] = open;
}

void add_mass(Composition& made, Chance& chance) {
  const double mass = rounded(chance.octaves(0.02, 0.6), 3);
  made.push(chance.happens(0.3) ? fmt::format("heavy({} kg)", number(mass))
                                : fmt::format("-{} kg * acceleration", number(mass)),
            [=](const Sample& hand) { return -mass * hand.acceleration; });
  made.truth[Cue::mass] = valued(mass);
}

std::vector<Family> motion_families() {
  return {{"viscosity", viscosities}, {"friction", frictions}, {"sticky", sticky},
          {"breakaway", breakaways},  {"mass", masses},        {"drag and mass", dragging_masses}};
}

}  // namespace wale::truth
