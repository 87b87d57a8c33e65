#pragma once

#include <optional>
#include <span>

#include "compiler/grade/explore.hpp"
#include "compiler/grade/grade.hpp"
#include "compiler/grade/slopes.hpp"
#include "compiler/grade/steep_places.hpp"
#include "compiler/grade/steps.hpp"

namespace wale {

/// Explores with the button up, and also with the button held if the program reads it.
Exploration explore_with_button(const Bank& bank, const GradingHand& hand);

/// What is known of a program before its sources of energy are sought.
struct SoughtSources {
  const Bank& bank;
  const GradingHand& hand;
  ProgramSlopes& slopes;
  LookedAt looked_at;
  std::span<const ForceStep> steps;  ///< by place
  double least_watt = 0;             ///< a smaller power does not count
};

/// Finds the energy from memory, and from sources that move by themselves, unless the force only ever resists. It looks
/// where the exploration was and, if the program depends on the place or the button, all over the patch and where a
/// step says that another program begins. `exploration` is made if there is none, and gets what the visits found.
/// Deterministic.
void find_sources(const SoughtSources& sought, std::optional<Exploration>& exploration, Energy& energy);

}  // namespace wale
