#pragma once

#include <string>

#include "compiler/grade/grade.hpp"

namespace wale {

/// The lines under "stability" of a description, each indented by two spaces.
std::string grade_text(const Grade& grade, const DeviceProfile& device);

}  // namespace wale
