#pragma once

#include "compiler/expression/check_expression.hpp"

namespace wale {

/// Warns of values that a function takes but that were hardly meant: angles in degrees or in turns (W0312), values
/// outside the range that `usual` states (W0308), and arguments whose places seem to be exchanged (W0313). Parameters
/// count with their defaults.
void check_usage(const CheckedMaterial& material, const CallRecord& record, const Surroundings& surroundings);

}  // namespace wale
