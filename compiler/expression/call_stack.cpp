#include "compiler/expression/call_stack.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

namespace wale {

bool CallStack::contains(std::string_view name, bool constant) const {
  return std::ranges::any_of(open_, [&](const Open& each) { return each.name == name && each.constant == constant; });
}

std::string CallStack::circle(std::string_view constant) const {
  auto each = std::ranges::find_if(open_, [&](const Open& open) { return open.constant && open.name == constant; });
  if (each == open_.end() || each + 1 == open_.end()) return {};
  std::string text = fmt::format(": `{}`", constant);
  for (++each; each != open_.end(); ++each) text += fmt::format(" needs `{}`, which", each->name);
  return fmt::format("{} needs `{}`", text, constant);
}

void CallStack::enter(std::string_view name, bool constant, Span site) {
  if (open_.empty()) outside_ = terms_.attributed();
  open_.push_back({name, constant, site});
  // If an outer place is already attributed, it stays.
  if (!outside_) terms_.attribute(open_.front().site);
}

void CallStack::leave() {
  open_.pop_back();
  if (!open_.empty()) return;
  terms_.attribute(outside_);
  cause_.reset();
}

/// " (inside `grating`)", if the place itself is outside that function.
std::string CallStack::inside(Span span) const {
  if (open_.empty() || at_home(span)) return {};
  return fmt::format(" (inside `{}{}`)", open_.back().constant ? "let " : "", open_.back().name);
}

/// "called on line 12", for a place inside a function of the same file.
std::string CallStack::called_from(Span span) const {
  if (!at_home(span) || open_.front().constant) return {};
  return fmt::format("called on line {}", sources_.place(open_.front().site).line);
}

Value CallStack::report(Code code, Span span, std::string message, std::string label, Advice advice) {
  Diagnostic diagnostic = std::move(advice).about(code, span, std::move(message));
  diagnostic.label = std::move(label);
  say(std::move(diagnostic));
  return failed_value(span);
}

void CallStack::say(Diagnostic diagnostic) {
  const Span span = diagnostic.span;
  // A wrong argument may cause several errors inside a function of another file. They are one mistake, at the call.
  if (!open_.empty() && !at_home(span) && severity_of(diagnostic.code) == Severity::error) {
    const auto [place, is_new] =
        failed_calls_.try_emplace({open_.front().site.source, open_.front().site.begin}, open_.front().site.end);
    if (!is_new && place->second == open_.front().site.end) return;
  }
  const bool of_dimension =
      diagnostic.code == Code::wrong_dimension || diagnostic.code == Code::mismatched_dimensions;
  if (cause_ && of_dimension && !open_.empty() && !at_home(span)) {
    cause_->message += inside(span);
    return diagnostics_.report(*std::exchange(cause_, std::nullopt));
  }
  diagnostic.span = blame(span);
  diagnostic.message += inside(span);
  if (diagnostic.label.empty()) diagnostic.label = called_from(span);
  if (diagnostic.span != span) diagnostic.fixes.clear();  // they are for the other file
  diagnostics_.report(std::move(diagnostic));
}

}  // namespace wale
