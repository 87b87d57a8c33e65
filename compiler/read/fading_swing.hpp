#pragma once

#include <optional>
#include <vector>

#include "compiler/read/swing.hpp"
#include "wale/program.hpp"

namespace wale {

/// A swing that dies away, or grows, by an exponential in time, and nothing beside it but a constant force: of the
/// forces on one hand at `rate` (Hz). Nothing if they are not so, or hardly change in size over their time.
std::optional<Swing> fading_swing(const std::vector<Force>& forces, double rate);

/// What is left of the forces at all places without such a swing.
std::vector<std::vector<Force>> without_fading(const std::vector<std::vector<Force>>& felt, double rate,
                                               double frequency, double rate_of_change);

}  // namespace wale
