#pragma once

#include "wale/instruction.hpp"

namespace wale {

/// The machine's result of one operation on single values, with its arithmetic and its treatment of subnormals. 0 for
/// operations that read tables, grids or peaks.
float result_of(Operation operation, float a, float b, float c);

}  // namespace wale
