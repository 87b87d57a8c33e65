#pragma once

#include <string>

#include "schema/result.hpp"

namespace wale {

/// Why a node such as /dev/hidraw3 cannot be used, by the number of the system's error.
Error why_not_opened(int error, const std::string& node);

}  // namespace wale
