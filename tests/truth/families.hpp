#pragma once

#include <vector>

#include "tests/truth/composition.hpp"

namespace wale::truth {

/// A class of programs: what they have in common is what a reader finds hard or easy about them.
struct Family {
  const char* name;
  Composition (*make)(Chance&);
};

// Each in its own file.
std::vector<Family> texture_families();
std::vector<Family> sum_families();
std::vector<Family> aperiodic_families();
std::vector<Family> trend_families();
std::vector<Family> motion_families();
std::vector<Family> time_families();
std::vector<Family> swing_families();
std::vector<Family> way_families();
std::vector<Family> memory_families();
std::vector<Family> mixture_families();
std::vector<Family> axis_families();
std::vector<Family> obstacle_families();
std::vector<Family> place_families();
std::vector<Family> part_families();

/// All of them.
std::vector<Family> families();
/// The program of a class with this number: always the same.
Case generated(const Family& family, std::size_t index);

// Parts that several classes are made of. Each says in `truth` what it adds.

/// A wave with a period that fits: a force, a height under `lateral`, or a force across its own direction.
void add_texture(Composition& made, Chance& chance, const Waveform& form, double shortest, double longest,
                 double strongest = 4);
void add_hill(Composition& made, Chance& chance, double strongest);
void add_spring(Composition& made, Chance& chance, double stiffest);
void add_constant(Composition& made, Chance& chance, double strongest);
void add_viscosity(Composition& made, Chance& chance, double strongest);
/// Coulomb friction by the velocity, which rises within 2 to 10 mm/s.
void add_friction(Composition& made, Chance& chance, double strongest);
void add_mass(Composition& made, Chance& chance);
void add_sway(Composition& made, Chance& chance, double strongest);
void add_vibration(Composition& made, Chance& chance, double strongest);
void add_wall(Composition& made, Chance& chance);

}  // namespace wale::truth
