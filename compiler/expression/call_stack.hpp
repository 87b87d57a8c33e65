#pragma once

#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "compiler/diagnostics/advice.hpp"
#include "compiler/expression/value.hpp"

namespace wale {

/// How deep functions and constants of a file may be nested.
inline constexpr std::size_t deepest_call = 64;

/// The definitions that are being read, one inside another. An error inside a function of another file is reported at
/// the call that led there, and the function's terms are attributed to that call.
class CallStack {
 public:
  CallStack(const SourceSet& sources, Diagnostics& diagnostics, Terms& terms)
      : sources_(sources), diagnostics_(diagnostics), terms_(terms) {}

  bool empty() const { return open_.empty(); }
  std::size_t depth() const { return open_.size(); }
  /// Whether the definition is being read already; using it again would be recursion.
  bool contains(std::string_view name, bool constant) const;
  /// ": `a` needs `b`, which needs `a`", for a constant that is being read and others inside it; empty without others.
  std::string circle(std::string_view constant) const;
  /// Begins reading a definition that is used at `site`; `leave` ends it.
  void enter(std::string_view name, bool constant, Span site);
  void leave();
  /// The likely cause of a wrong dimension inside the function that is called next from outside of all definitions: it
  /// is reported instead. Nothing: none is known.
  void expect(std::optional<Diagnostic> cause) { cause_ = std::move(cause); }

  /// The place where the outermost definition is used; there must be one.
  Span outermost() const { return open_.front().site; }
  /// The place to report for a place inside the open definitions.
  Span blame(Span span) const { return open_.empty() || at_home(span) ? span : open_.front().site; }

  /// Reports an error at the place given by `blame` and returns the failed value.
  [[gnu::cold]] Value report(Code code, Span span, std::string message, std::string label = {}, Advice advice = "");
  [[gnu::cold]] void say(Diagnostic diagnostic);

 private:
  struct Open {
    std::string_view name;
    bool constant;  ///< it is a `let` outside the materials, not a function
    Span site;      ///< where it is used
  };

  bool at_home(Span span) const { return !open_.empty() && span.source == open_.front().site.source; }
  [[gnu::cold]] std::string inside(Span span) const;
  [[gnu::cold]] std::string called_from(Span span) const;

  const SourceSet& sources_;
  Diagnostics& diagnostics_;
  Terms& terms_;
  std::vector<Open> open_;
  /// The calls inside which an error was reported, by source and begin, with their ends.
  std::map<std::pair<SourceId, std::uint32_t>, std::uint32_t> failed_calls_;
  std::optional<Diagnostic> cause_;  ///< of a wrong dimension inside the outermost definition
  std::optional<Span> outside_;  ///< the place to which terms were attributed before the outermost definition
};

}  // namespace wale
