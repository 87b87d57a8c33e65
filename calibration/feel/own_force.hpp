#pragma once

#include <optional>

#include "wale/felt.hpp"

namespace wale {

/// What a run would have measured if the handle had got the program's own force in each tick, at the same places and
/// speeds of the hand: what the hand's way could show, without device and guards. Nothing of a program that remembers,
/// whose force depends on more than a tick, and of one that vibrates a pad.
std::optional<Felt> measured_of_program(const Bank& bank, const Record& record, const MeasureOptions& options);

}  // namespace wale
