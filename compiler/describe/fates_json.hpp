#pragma once

#include <nlohmann/json.hpp>
#include <vector>

#include "schema/patch_program.hpp"

namespace wale {

/// `{"percepts": {NAME: {fate, asked, given, reason}}, "physics": {NAME: {fate, reason}}}`.
nlohmann::ordered_json to_json(const std::vector<FateRecord>& fates);

}  // namespace wale
