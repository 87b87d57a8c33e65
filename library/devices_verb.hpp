#pragma once

#include <atomic>
#include <string>

/// The verb that lists devices, and finds out how one lies.
namespace wale::command {

/// What can be built for, and what is plugged in.
int devices(bool json);

/// Finds out how a device that is plugged in lies on the desk, and prints a declaration that says so. `device` is
/// spelt as for `--device`, empty: the best one; `max_force` as in "1 N", empty: a fifth of its own, which is not
/// exceeded.
int identify(const std::string& device, const std::string& max_force, const std::atomic<bool>& stop);

}  // namespace wale::command
