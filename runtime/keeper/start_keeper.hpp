#pragma once

#include <sys/types.h>

#include <span>
#include <string>
#include <vector>

#include "schema/companion.hpp"
#include "wale/result.hpp"

namespace wale {

/// The program `wale-keeper`: `named` where it is given; else the first of `places` that can be run. Error:
/// `no_keeper`.
Result<std::string> find_keeper(const std::string& named,
                                const std::vector<std::string>& places = companion_paths("wale-keeper"));

/// Starts `program` with `words`, as no child of this process: its end raises no SIGCHLD here, and no `wait` of this
/// process sees it. It inherits these descriptors under their numbers, blocks all signals, and handles none. Error:
/// `no_keeper`. May be called from any thread.
Result<pid_t> start_keeper(const std::string& program, std::span<const std::string> words,
                           std::span<const int> descriptors);

}  // namespace wale
