#pragma once

#include <string>
#include <variant>

#include "schema/patch_program.hpp"
#include "wale/trace.hpp"

namespace wale {

/// A hand's movement from a CSV file; refused with the line that is wrong and what should be there.
std::variant<Trace, Refusal> load_trace(const std::string& path);

}  // namespace wale
