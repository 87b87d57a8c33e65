#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "compiler/read/motion.hpp"

namespace wale {

/// What resists a moving hand and is no single friction or viscosity, in lines of two spaces' indent.
std::string motion_lines(const OpposingForce& motion);

/// Adds the same to the JSON; only what there is.
void add_motion(nlohmann::ordered_json& json, const OpposingForce& motion);

/// What of a mass differs with the way, and from place to place, likewise.
std::string mass_lines(const Mass& mass);
void add_mass(nlohmann::ordered_json& json, const Mass& mass);

}  // namespace wale
