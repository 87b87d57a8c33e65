#pragma once

#include <string>

#include "wale/result.hpp"
#include "wale/trace.hpp"

namespace wale {

/// A hand's movement from a CSV file, as `read_trace` reads it. The error names the file and the line:
/// `unreadable_file`, `unreadable_table`.
Result<Trace> load_trace(const std::string& path);

}  // namespace wale
