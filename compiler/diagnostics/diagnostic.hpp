#pragma once

#include <map>
#include <string>
#include <tuple>
#include <variant>
#include <vector>

#include "compiler/text/source.hpp"
#include "schema/code.hpp"

namespace wale {

/// Another place that has to do with it, and what stands there: the `{` that nothing closes, the first of two
/// declarations. It may be in another file.
struct SecondarySpan {
  Span span;
  std::string label;  ///< "opened here"; may be empty
};

/// A number as people say it: 4 "MB", 200 "" (a plain number).
struct NumberWithUnit {
  double value = 0;
  std::string unit;
};

/// Something a program can use without reading sentences: the limit that was passed, the name that was meant.
struct Fact {
  std::string name;  ///< in lower case with `_`, stable: "limit"
  std::variant<std::string, NumberWithUnit, Span> value;
};

/// Text that replaces a span; an empty span is a place to insert at.
struct Edit {
  Span span;
  std::string replacement;
};

/// A mend that a program can apply: all of its edits or none. `fix.hpp` makes them, `apply_fixes.hpp` applies them.
struct Fix {
  std::string title;  ///< what it does: "write `3 * hand`"
  std::vector<Edit> edits;
  /// There is no doubt that this was meant; `wale check --fix` applies it unasked.
  bool safe = false;
};

/// One thing wrong, and where. Rendered by `render.hpp`.
struct Diagnostic {
  Code code;
  Span span;
  std::string message;   ///< "force expected, found energy"
  std::string label;     ///< beside the carets: "N m"; may be empty
  std::string expected;  ///< what would have been right; may be empty
  std::string found;     ///< what stands there; may be empty
  std::string help;      ///< the proposal: what to write instead

  std::vector<SecondarySpan> secondary;  ///< in the order in which they are best read
  std::vector<Fact> facts;
  std::string cause;       ///< why it is so here, beyond `expected` and `found`; may be empty
  std::string rule;        ///< the rule of the language or of physics that was broken; may be empty
  std::vector<Fix> fixes;  ///< the likeliest first
};

/// What the stages report to. Nothing is printed here.
///
/// To report is rare, and `[[gnu::cold]]` says so: compilers then put what leads to it, the making of the message, away
/// from what every file goes through.
class Diagnostics {
 public:
  /// More errors than this are of no use to anybody, and a file of 4 MB could have hundreds of thousands.
  static constexpr std::size_t most_errors = 1000;

  /// A thing is said once: the same message at the same place again is dropped. So is everything after `most_errors`.
  [[gnu::cold]] void report(Diagnostic diagnostic);
  /// By file, then by place, what is at one place in the order of reporting.
  void sort();
  bool has_errors() const { return errors_ > 0; }
  std::size_t error_count() const { return errors_; }
  bool is_full() const { return errors_ >= most_errors; }
  const std::vector<Diagnostic>& all() const { return all_; }

 private:
  using Key = std::tuple<Code, SourceId, std::uint32_t, std::uint32_t>;

  std::vector<Diagnostic> all_;
  std::multimap<Key, std::string> said_;  ///< messages by code and place
  std::size_t errors_ = 0;
};

}  // namespace wale
