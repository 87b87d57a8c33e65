#pragma once

#include <string>

namespace wale {

enum class Severity { error, warning };

/// Stable names of everything that can be wrong, in a Wale file or elsewhere; `codes.def` lists them with their titles.
enum class Code : unsigned {
#define CODE(number, name, severity, title) name = 1##number - 10000,  // the numbers' leading zero must not mean octal
#include "schema/codes.def"
};

/// "W0301".
std::string code_name(Code code);
/// One line that says what the code is about, whatever the case.
std::string code_title(Code code);
Severity severity_of(Code code);

}  // namespace wale
