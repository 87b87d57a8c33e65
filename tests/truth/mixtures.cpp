// Causes that must be separated before they are measured.

#include "tests/truth/families.hpp"

namespace wale::truth {
namespace {

void add_any_texture(Composition& made, Chance& chance, double longest = 0.025) {
  add_texture(made, chance, any_waveform(chance), 0.3e-3, std::min(made.longest_period(), longest), 1.5);
}

Composition texture_on_trend(Chance& chance) {
  Composition made = any_patch(chance);
  add_any_texture(made, chance);
  switch (static_cast<int>(chance.between(0, 3))) {
    case 0: add_spring(made, chance, 40); break;
    case 1: add_constant(made, chance, 2); break;
    default: add_hill(made, chance, 2);
  }
  made.truth[Cue::constant] = open;  // whether it is a cue beside others
  return made;
}

/// A strong spring, or one towards a line, on which the waves of a texture are a small part of the force.
Composition long_wave_on_spring(Chance& chance) {
  Composition made = any_patch(chance);
  const double orientation = any_orientation(chance);
  made.push_wave({sine(), rounded(chance.octaves(3e-3, std::min(made.longest_period(), 0.04)), 4), orientation,
                  rounded(chance.between(0, 1), 3), rounded(chance.between(0.3, 1.5), 3)});
  const double stiffness = rounded(chance.between(40, 120), 4);
  const double angle = std::fmod(orientation + (chance.happens(0.5) ? 0 : pi / 2), pi);
  if (chance.happens(0.5)) {
    made.push(fmt::format("spring({} N/m)", number(stiffness)),
              [=](const Sample& hand) { return -stiffness * hand.position; });
    made.truth[Cue::stiffness] = valued(stiffness);
  } else {
    const glm::dvec2 way{std::cos(angle), std::sin(angle)};
    made.push(fmt::format("-{} N/m * ({} * x + {} * y) * {}", number(stiffness), number(way.x), number(way.y),
                          unit_vector(angle)),
              [=](const Sample& hand) { return -stiffness * glm::dot(way, hand.position) * way; });
    made.truth[Cue::stiffness] = valued(stiffness), made.truth[Cue::stiffness_across] = valued(0);
    made.truth[Cue::axis] = valued(angle);
  }
  made.truth[Cue::constant] = open;
  return made;
}

/// The wall stands at the side; the relief is felt everywhere, and repeats often enough in front of it.
Composition texture_and_wall(Chance& chance) {
  Composition made = any_patch(chance);
  add_any_texture(made, chance, 8e-3);
  add_wall(made, chance);
  return made;
}

Composition texture_in_motion(Chance& chance) {
  Composition made = any_patch(chance);
  add_any_texture(made, chance);
  if (chance.happens(0.6))
    add_viscosity(made, chance, 4);
  else
    add_friction(made, chance, 1.5);
  if (chance.happens(0.3)) add_mass(made, chance);
  return made;
}

Composition texture_in_time(Chance& chance) {
  Composition made = any_patch(chance);
  add_any_texture(made, chance);
  chance.happens(0.5) ? add_sway(made, chance, 1) : add_vibration(made, chance, 1);
  return made;
}

Composition spring_in_motion(Chance& chance) {
  Composition made = any_patch(chance);
  add_spring(made, chance, 60);
  add_viscosity(made, chance, 4);
  if (chance.happens(0.5)) add_friction(made, chance, 1.5);
  if (chance.happens(0.5)) add_mass(made, chance);
  if (chance.happens(0.4)) add_sway(made, chance, 1);
  return made;
}

Composition everything(Chance& chance) {
  Composition made = any_patch(chance);
  add_any_texture(made, chance);
  add_spring(made, chance, 30);
  add_viscosity(made, chance, 3);
  add_friction(made, chance, 0.8);
  add_mass(made, chance);
  add_vibration(made, chance, 0.8);
  return made;
}

}  // namespace

std::vector<Family> mixture_families() {
  return {{"texture on trend", texture_on_trend},
          {"long wave on spring", long_wave_on_spring},
          {"texture and wall", texture_and_wall},
          {"texture in motion", texture_in_motion},
          {"texture in time", texture_in_time},
          {"spring in motion", spring_in_motion},
          {"everything", everything}};
}

std::vector<Family> families() {
  std::vector<Family> all;
  for (const auto& part :
       {texture_families(), sum_families(), aperiodic_families(), trend_families(), motion_families(), time_families(),
        swing_families(), way_families(), memory_families(), mixture_families(), axis_families(), obstacle_families(),
         place_families(), part_families()})
    all.insert(all.end(), part.begin(), part.end());
  return all;
}

Case generated(const Family& family, std::size_t index) {
  Chance chance(family.name, index);
  Case made = family.make(chance).finished();
  made.name = std::string(family.name) + "/" + std::to_string(index);
  return made;
}

}  // namespace wale::truth
