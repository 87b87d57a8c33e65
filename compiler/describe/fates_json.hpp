#pragma once

#include <nlohmann/json.hpp>
#include <vector>

#include "compiler/describe/fates_at.hpp"

namespace wale {

/// `{"percepts": {NAME: {fate, asked, given, reason, changes}}, "physics": {NAME: {fate, reason}}}`, where `changes` is
/// an array of `{fate, parameter, unit, above}`, or `below` instead of `above`; left out where there are none.
nlohmann::ordered_json to_json(const std::vector<DescribedFate>& fates);

}  // namespace wale
