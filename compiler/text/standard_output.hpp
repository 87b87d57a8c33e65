#pragma once

#include <string_view>

/// The standard output of the process. Whoever writes to it does so here, so that a failure is not lost: the first is
/// remembered, and what comes later is dropped.
namespace wale {

/// Writes bytes as they are, in the order of the calls. They may wait for `finish_standard_output`.
void write_standard_output(std::string_view bytes);

/// Writes what is left. Returns the system's number of the first failure (`ENOSPC`; `EPIPE` where the reader of a pipe
/// has gone), or 0. May be called more than once.
int finish_standard_output();

}  // namespace wale
