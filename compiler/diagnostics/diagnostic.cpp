#include "compiler/diagnostics/diagnostic.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "compiler/text/readable.hpp"

namespace wale {

namespace {

/// What takes the work, and what to do.
struct Spending {
  const char *what, *mend;
};
Spending spending(Work on) {
  switch (on) {
    case Work::expansion:
      return {"this expands to",
              "functions are expanded at every call; let them call each other less often, and name a "
              "value that is used twice with `let`"};
    case Work::assembly:
      return {"making this from other materials takes",
              "make it from fewer materials, or from one that stands on its own"};
    case Work::blend:
      return {"this blend takes",
              "a blend computes each of its components, and those of the blends in it; blend fewer"};
    case Work::solving:
      return {"solving these percepts takes", "ask for fewer percepts, or write the force as fewer terms"};
    case Work::gradient:
      return {"this gradient takes", "a gradient of a gradient is far larger than its height; derive a simpler one"};
    case Work::program: break;
  }
  return {"this material takes", "write it as several materials, or with fewer values"};
}

/// The longest name that a message quotes whole, in bytes. A name may be as long as its file.
constexpr std::size_t longest_quoted = 200;

/// Keeps the first part of each quoted text (`` `like this` ``) that is too long, and ends it with "…". Facts and
/// fixes, which programs read, keep theirs whole.
void shorten_quoted(std::string& text) {
  if (text.size() <= longest_quoted) return;
  std::string shortened;
  std::string_view rest = text;
  while (true) {
    const std::size_t open = rest.find('`');
    const std::size_t close = open == rest.npos ? rest.npos : rest.find('`', open + 1);
    if (close == rest.npos) break;
    std::size_t kept = close;
    if (close - open > longest_quoted) {
      kept = open + longest_quoted;
      while ((static_cast<unsigned char>(rest[kept]) & 0xC0) == 0x80) --kept;  // a whole character
    }
    shortened += rest.substr(0, kept);
    if (kept != close) shortened += "…";
    shortened += '`';
    rest.remove_prefix(close + 1);
  }
  text = shortened.append(rest);
}

}  // namespace

void Diagnostics::report_spent(const Span& place, Work on) {
  if (spent_) return;
  const auto [what, mend] = spending(on);
  const std::size_t most = budget_.allowed();
  report({.code = Code::program_too_large,
          .span = place,
          .message = readable("{} more than {} operations", what, most),
          .expected = readable("at most {} operations to compile this text", most),
          .found = "more",
          .help = mend,
          .facts = {{"limit", NumberWithUnit{static_cast<double>(most), ""}}}});
  spent_ = true;
}

void Diagnostics::report(Diagnostic diagnostic) {
  if (is_full() || spent_) return;
  for (std::string* text : {&diagnostic.message, &diagnostic.label, &diagnostic.expected, &diagnostic.found,
                            &diagnostic.cause, &diagnostic.rule, &diagnostic.help})
    shorten_quoted(*text);
  const Key key(diagnostic.code, diagnostic.span.source, diagnostic.span.begin, diagnostic.span.end);
  for (auto [said, end] = said_.equal_range(key); said != end; ++said)
    if (said->second == diagnostic.message) return;
  const bool is_error = severity_of(diagnostic.code) == Severity::error;
  const auto at_its_place = [&](const Diagnostic& other) {
    return other.span == diagnostic.span && (severity_of(other.code) == Severity::error) != is_error;
  };
  if (!is_error && std::ranges::any_of(all_, at_its_place)) return;
  if (is_error) std::erase_if(all_, at_its_place);
  said_.emplace(key, diagnostic.message);
  if (is_error) ++errors_;
  all_.push_back(std::move(diagnostic));
}

void Diagnostics::propose(Code code, const Span& span, std::string help) {
  const auto reported = std::ranges::find_if(
      all_, [&](const Diagnostic& each) { return each.code == code && each.span == span; });
  if (reported != all_.end()) reported->help = std::move(help);
}

void Diagnostics::sort() {
  std::ranges::stable_sort(all_, {},
                           [](const Diagnostic& each) { return std::pair(each.span.source, each.span.begin); });
}

}  // namespace wale
