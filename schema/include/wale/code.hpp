#pragma once

#include <string>

namespace wale {

enum class Severity { error, warning };

/// Stable names of all errors and warnings, in a Wale file or elsewhere; `codes.def` lists them with their titles.
enum class Code : unsigned {
#define WALE_CODE(number, name, severity, title) name = 1##number - 10000,  // the numbers' leading zero must not mean octal
#include "wale/codes.def"
};

/// "W0301".
std::string code_name(Code code);
/// One line that describes the code in general.
std::string code_title(Code code);
Severity severity_of(Code code);

}  // namespace wale
