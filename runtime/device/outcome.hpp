#pragma once

#include <cstdint>

namespace wale {

/// How a transfer to or from a device ended.
enum class Outcome : std::uint8_t { done, stalled, timed_out, failed, gone };

}  // namespace wale
