#pragma once

#include <map>
#include <string>
#include <tuple>
#include <variant>
#include <vector>

#include "compiler/diagnostics/budget.hpp"
#include "compiler/text/source.hpp"
#include "wale/code.hpp"

namespace wale {

/// Another place that matters, such as the `{` that is not closed or the first of two declarations. It may be in
/// another file.
struct SecondarySpan {
  Span span;
  std::string label;  ///< "opened here"; may be empty
};

/// A number with its unit as people write it: 4 "MB", 200 "" (a plain number).
struct NumberWithUnit {
  double value = 0;
  std::string unit;
};

/// A fact that a program can use without reading the sentences: the limit that was passed, the name that was meant.
struct Fact {
  std::string name;  ///< in lower case with `_`, stable: "limit"
  std::variant<std::string, NumberWithUnit, Span> value;
};

/// Text that replaces a span; at an empty span it is inserted.
struct Edit {
  Span span;
  std::string replacement;
};

/// A correction that a program can apply, with all of its edits or none. `fix.hpp` makes fixes, `apply_fixes.hpp`
/// applies them.
struct Fix {
  std::string title;  ///< what it does: "write `3 * hand`"
  std::vector<Edit> edits;
  /// No other meaning is possible, so `wale check --fix` applies it without asking.
  bool safe = false;
};

/// One error or warning and its place. Rendered by `render.hpp`.
struct Diagnostic {
  Code code;
  Span span;
  std::string message;   ///< "expected a force, found an energy"
  std::string label;     ///< next to the carets: "N m"; may be empty
  std::string expected;  ///< what would be right; may be empty
  std::string found;     ///< what the text has; may be empty
  std::string help;      ///< the proposal: what to write instead

  std::vector<SecondarySpan> secondary;  ///< in the order to read them
  std::vector<Fact> facts;
  std::string cause;       ///< why it is wrong here, beyond `expected` and `found`; may be empty
  std::string rule;        ///< the broken rule of the language or of physics; may be empty
  std::vector<Fix> fixes;  ///< the likeliest first
};

/// The diagnostics that stages report, and the work that they may do. Nothing is printed here.
///
/// Reports are rare, and `[[gnu::cold]]` says so: the compiler then moves the code that makes a message away from the
/// code that every file runs through.
class Diagnostics {
 public:
  /// More errors are not useful, and a file of 4 MB could have hundreds of thousands.
  static constexpr std::size_t most_errors = 1000;

  /// The same message at the same place is reported once, and a place with an error has no warnings: they are about the
  /// same mistake. Everything after `most_errors` is dropped.
  [[gnu::cold]] void report(Diagnostic diagnostic);
  /// Gives the error of that code that was reported at that place another proposal: that of a later stage, which knows
  /// more. Nothing happens if there is none.
  [[gnu::cold]] void propose(Code code, const Span& span, std::string help);
  /// By file, then by place; diagnostics at one place stay in the order of reporting.
  void sort();
  bool has_errors() const { return errors_ > 0; }
  std::size_t error_count() const { return errors_; }
  bool is_full() const { return errors_ >= most_errors; }
  const std::vector<Diagnostic>& all() const { return all_; }

  /// Begins a compilation with a budget of its own.
  void renew_budget() { budget_ = {}; }
  /// Allows the work for a text of that many bytes.
  void allow_text(std::size_t bytes) { budget_.allow(Budget::for_each_byte * bytes); }
  /// Takes operations from the budget before they are done. False if it is spent: the stage stops, and W0603 has been
  /// reported, at the place of what spends it. Whatever is reported afterwards only follows from that, and is dropped.
  bool charge(std::size_t operations, const Span& place, Work on) {
    if (budget_.take(operations)) [[likely]]
      return true;
    report_spent(place, on);
    return false;
  }
  /// The same, where the place is not at hand; `report_spent` must follow.
  bool charge(std::size_t operations) { return budget_.take(operations); }
  [[gnu::cold]] void report_spent(const Span& place, Work on);
  /// As `Budget`. The caller reports it (W0509).
  bool take_samples(std::size_t samples, bool is_new) { return budget_.take_samples(samples, is_new); }
  bool has_samples() const { return budget_.has_samples(); }
  /// Goes on with the budget of `other`, whose diagnostics are kept apart.
  void continue_budget(const Diagnostics& other) { budget_ = other.budget_, spent_ = other.spent_; }
  bool is_spent() const { return spent_; }
  const Budget& budget() const { return budget_; }

 private:
  using Key = std::tuple<Code, SourceId, std::uint32_t, std::uint32_t>;

  std::vector<Diagnostic> all_;
  std::multimap<Key, std::string> said_;  ///< messages by code and place
  std::size_t errors_ = 0;
  Budget budget_;
  bool spent_ = false;  ///< which has been reported
};

}  // namespace wale
