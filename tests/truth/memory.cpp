// What a program remembers of the hand.

#include <fmt/format.h>

#include "tests/truth/families.hpp"

namespace wale::truth {
namespace {

/// A spring that gives way while it is held, and recovers: at the first touch it is what it is.
Composition tiring_springs(Chance& chance) {
  Composition made = any_patch(chance);
  const double stiffness = rounded(chance.octaves(10, 80), 3), share = rounded(chance.between(0.2, 0.7), 2);
  made.statement("state tired = 0 in 0 .. 1");
  made.statement(fmt::format("tired' = (clamp(length(hand) / 50 mm, 0, 1) - tired) / {} s",
                             number(rounded(chance.between(1, 5), 2))));
  made.push(fmt::format("-{} N/m * (1 - {} * tired) * hand", number(stiffness), number(share)));
  made.truth[Cue::stiffness] = valued(stiffness);
  made.truth[Cue::constant] = some;  // what it loses while it is held is no other cue's
  return made;
}

/// A spring with a bristle beside it: there and back it pushes differently by twice the bristle's force, which slides.
Composition hysteresis(Chance& chance) {
  Composition made = any_patch(chance);
  add_spring(made, chance, 60);
  const double size = rounded(chance.octaves(0.1, 2), 3), bristle = rounded(chance.octaves(300, 1200), 3);
  made.statement("state anchor : position = hand in -115 mm .. 115 mm");
  made.statement(fmt::format("let stretch = hold(hand - anchor, {} N / {} N/m)", number(size), number(bristle)));
  made.statement("next anchor = hand - stretch");
  made.push(fmt::format("-{} N/m * stretch", number(bristle)));
  made.truth[Cue::friction] = valued(size);
  made.truth[Cue::breakaway] = open;
  return made;
}

}  // namespace

std::vector<Family> memory_families() { return {{"tiring spring", tiring_springs}, {"hysteresis", hysteresis}}; }

}  // namespace wale::truth
