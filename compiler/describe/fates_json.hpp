#pragma once

#include <nlohmann/json.hpp>
#include <vector>

#include "compiler/describe/fates_at.hpp"

namespace wale {

/// `{"percepts": {NAME: {fate, asked, given, reason, changes}}, "physics": {NAME: {fate, reason}}}`. `changes` is an
/// array of `{fate, parameter, unit, above}`, with `below` instead of `above` where the fate holds below; it is left
/// out if empty.
nlohmann::ordered_json to_json(const std::vector<DescribedFate>& fates);

}  // namespace wale
