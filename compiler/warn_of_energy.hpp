#pragma once

#include "compiler/check/check.hpp"
#include "compiler/diagnostics/diagnostic.hpp"
#include "compiler/grade/grade.hpp"
#include "compiler/solve/solve.hpp"

namespace wale {

/// Warns of a program that gives more energy than its material declares (W0604), and says what gives it: the device's
/// limit only where the force comes to it.
void warn_of_undeclared_energy(const Bank& bank, const CheckedMaterial& checked, const SolvedMaterial& material,
                               const GradingHand& hand, Diagnostics& diagnostics);

/// Warns of a force that drives the hand away, as of a spring without its minus (W0426).
void warn_of_driving_away(const CheckedMaterial& material, const SolvedMaterial& solved, Diagnostics& diagnostics);

}  // namespace wale
