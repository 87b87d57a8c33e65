#pragma once

#include <string>

#include "wale/result.hpp"

namespace wale {

/// The error for a node such as /dev/hidraw3 that cannot be used, by the system's error number (`errno`).
Error why_not_opened(int error, const std::string& node);

}  // namespace wale
