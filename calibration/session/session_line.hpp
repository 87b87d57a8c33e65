#pragma once

#include <cstddef>
#include <string_view>

#include "wale/session_log.hpp"

namespace wale {

inline constexpr int session_log_version = 1;
inline constexpr std::size_t longest_session_line = std::size_t{1} << 20;  // bytes

/// Reads one line. Errors: `damaged_file`; `newer_file` for a first line of a newer format. They have no place.
Result<SessionEntry> read_session_line(std::string_view line);

}  // namespace wale
