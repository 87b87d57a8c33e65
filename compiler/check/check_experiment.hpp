#pragma once

#include "compiler/expression/check_expression.hpp"
#include "compiler/expression/checked.hpp"

namespace wale {

/// The most stimuli of an experiment, standards not counted.
inline constexpr std::size_t most_stimuli = 2000;

/// s that the simulated hand takes for one movement to and fro; 0 if no hand is declared. A presentation that is shorter
/// shows a part of its stimulus only.
double seconds_to_and_fro(const Declarations& declarations);

/// Checks the experiments of a file and adds them to the module. Each of their stimuli is a checked material. Errors are
/// reported; an experiment that has one is left out.
void check_experiments(const SyntaxTree& tree, const Surroundings& surroundings, CheckedModule& module);

}  // namespace wale
