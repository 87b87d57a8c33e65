#pragma once

#include <string>
#include <vector>

#include "compiler/source.hpp"

namespace wale {

enum class Severity { error, warning };

/// Stable names of everything that can be wrong with a Wale file; `diagnostic_codes.def` lists them with their titles.
enum class Code : unsigned {
#define CODE(number, name, severity, title) name = 1##number - 10000,  // the numbers' leading zero must not mean octal
#include "compiler/diagnostic_codes.def"
};

/// "W0301".
std::string code_name(Code code);
/// One line that says what the code is about, whatever the case.
std::string code_title(Code code);
Severity severity_of(Code code);

/// One thing wrong, and where. Rendered by `render.hpp`.
struct Diagnostic {
  Code code;
  Span span;
  std::string message;   ///< "force expected, found energy"
  std::string label;     ///< beside the carets: "N m"; may be empty
  std::string expected;  ///< what would have been right; may be empty
  std::string found;     ///< what stands there; may be empty
  std::string help;      ///< the mend: what to write instead
};

/// What the stages report to. Nothing is printed here.
class Diagnostics {
 public:
  /// A thing is said once: the same message at the same place again is dropped.
  void report(Diagnostic diagnostic);
  /// By file, then by place, what is at one place in the order of reporting.
  void sort();
  bool has_errors() const { return errors_ > 0; }
  std::size_t error_count() const { return errors_; }
  const std::vector<Diagnostic>& all() const { return all_; }

 private:
  std::vector<Diagnostic> all_;
  std::size_t errors_ = 0;
};

}  // namespace wale
