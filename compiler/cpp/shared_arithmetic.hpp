#pragma once

#include <string>

namespace wale {

/// The arithmetic that all headers share, as it stands in each of them: the machine's own functions, the functions that
/// replace its operations on a processor in any mode, and what only headers need. A guard lets one program include it
/// once, and its name has a hash of its text, so that headers of two versions of Wale can be in one program.
struct SharedArithmetic {
  std::string name;  ///< the macro that is the guard, and names the namespace
  std::string text;
};

const SharedArithmetic& shared_arithmetic();

/// Declarations that make the arithmetic's names known in another namespace. Not a using-directive: the names of the
/// program that includes the header would then clash with them.
std::string using_arithmetic();

}  // namespace wale
