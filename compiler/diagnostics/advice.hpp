#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "compiler/diagnostics/diagnostic.hpp"
#include "compiler/diagnostics/fix.hpp"

namespace wale {

/// The parts of a diagnostic besides the error itself: the proposal, the fixes that carry it out, other places, facts,
/// and the rule that was broken. A text alone makes a proposal without the other parts.
class Advice {
 public:
  [[gnu::cold]] Advice(std::string help) : about_{.help = std::move(help)} {}
  [[gnu::cold]] Advice(const char* help) : Advice(std::string(help)) {}

  /// Another place to look at: "declared here first".
  Advice see(Span span, std::string label) &&;
  Advice fact(std::string name, std::string value) &&;
  Advice fact(std::string name, double value, std::string unit = {}) &&;
  Advice fact(std::string name, Span place) &&;
  Advice because(std::string rule) &&;
  Advice fix(Fix fix) &&;
  Advice fix(std::vector<Fix> fixes) &&;

  /// Puts a text before the proposal.
  Advice behind(const std::string& text) &&;

  [[gnu::cold]] Diagnostic about(Code code, Span span, std::string message) &&;

 private:
  Diagnostic about_;
};

/// "did you mean `X`?" with the fix that writes it (`respell`); `otherwise` if no candidate is near.
[[gnu::cold]] Advice did_you_mean(Span span, std::string_view word, const std::vector<std::string>& candidates,
                                  Advice otherwise, bool may_be_safe = true);

}  // namespace wale
