#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "compiler/diagnostics/advice.hpp"
#include "compiler/expression/value.hpp"

namespace wale {

/// Functions, and constants of a file, may be nested this deep.
inline constexpr std::size_t deepest_call = 64;

/// The definitions that are being read within one another. It knows where to point: an error inside a function of
/// another file is reported at the call that led there, and terms that it adds are attributed to that call.
class CallStack {
 public:
  CallStack(const SourceSet& sources, Diagnostics& diagnostics, Terms& terms)
      : sources_(sources), diagnostics_(diagnostics), terms_(terms) {}

  bool empty() const { return open_.empty(); }
  std::size_t depth() const { return open_.size(); }
  /// Whether the definition is being read already, so that it leads back to itself.
  bool contains(std::string_view name, bool constant) const;
  /// A definition is read because it is used at `site`, until `leave`.
  void enter(std::string_view name, bool constant, Span site);
  void leave();

  /// Where the outermost definition is used; there must be one.
  Span outermost() const { return open_.front().site; }
  /// Where to point for a place inside the definitions that are open.
  Span blame(Span span) const { return open_.empty() || at_home(span) ? span : open_.front().site; }

  /// Reports something at the place that `blame` gives. The value is `failed`.
  [[gnu::cold]] Value report(Code code, Span span, std::string message, std::string label = {}, Advice advice = "");
  [[gnu::cold]] void say(Diagnostic diagnostic);

 private:
  struct Open {
    std::string_view name;
    bool constant;  ///< a `let` outside the materials, and not a function
    Span site;      ///< where it is used
  };

  bool at_home(Span span) const { return !open_.empty() && span.source == open_.front().site.source; }
  [[gnu::cold]] std::string inside(Span span) const;
  [[gnu::cold]] std::string called_from(Span span) const;

  const SourceSet& sources_;
  Diagnostics& diagnostics_;
  Terms& terms_;
  std::vector<Open> open_;
  std::optional<Span> outside_;  ///< what terms were attributed to before the outermost definition
};

}  // namespace wale
