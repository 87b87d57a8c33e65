#pragma once

#include <string>

#include "compiler/grade/grade.hpp"

namespace wale {

/// The lines under "stability" of a description, each indented by two spaces.
std::string grade_text(const Grade& grade, const DeviceProfile& device);

/// "the first 8 s were looked at; later it may push up to 3.000 N (proved)".
std::string later_words(double newton);

}  // namespace wale
