#pragma once

#include <vector>

#include "compiler/check/check.hpp"
#include "wale/library.hpp"

namespace wale {

/// The devices that a file may name: its own and those that it imports, and then those that every file knows.
std::vector<DeclaredDevice> devices_known(const CheckedModule& module);
std::vector<DeclaredDevice> devices_known(const Declarations& declarations);

/// The devices that a file in this folder would know. What is wrong with their declarations is printed.
std::vector<DeclaredDevice> devices_here();

}  // namespace wale
