#pragma once

#include <string>
#include <vector>

#include "wale/result.hpp"

namespace wale {

/// The bytes of a Wale file in which the device `name` has these settings instead of its own ones with the same keys.
/// Everything else stays as it was written, with its comments. `settings`: lines that begin with a key, as
/// `calibrated_settings` gives them; `also`: keys that are removed besides. Errors: W0601 if the file declares no such
/// device, W0801 if its text cannot be read.
Result<std::string> with_settings(const std::string& bytes, const std::string& name,
                                  const std::vector<std::string>& settings, const std::vector<std::string>& also);

}  // namespace wale
