#pragma once

#include <string>
#include <vector>

#include "wale/library.hpp"

namespace wale {

/// What `wale devices` prints: the joysticks that can be felt on, and those that can be built for, with the evidence
/// for their figures.
std::string devices_text(const std::vector<DeclaredDevice>& devices);
/// An array: each device's name, whether it can be felt on, its figures in SI units, those assumed, their source.
std::string devices_json(const std::vector<DeclaredDevice>& devices);

}  // namespace wale
