#pragma once

#include <nlohmann/json_fwd.hpp>

#include "library/index/entry.hpp"
#include "wale/result.hpp"

namespace wale {

/// An entry as an object, without the program's bytes: all that is stored of it and printed for programs. Levels are
/// 0 .. 1 and sizes in SI units; what is unknown or does not apply is null.
nlohmann::ordered_json entry_json(const Entry& entry);

/// The entry of such an object. Members that are unknown are ignored. Error: W0506 if one is missing or of another kind.
Result<Entry> entry_of_json(const nlohmann::ordered_json& json);

}  // namespace wale
