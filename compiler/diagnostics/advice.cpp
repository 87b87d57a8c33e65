#include "compiler/diagnostics/advice.hpp"

#include <fmt/format.h>

#include <utility>

namespace wale {

Advice Advice::see(Span span, std::string label) && {
  about_.secondary.push_back({span, std::move(label)});
  return std::move(*this);
}

Advice Advice::fact(std::string name, std::string value) && {
  about_.facts.push_back({std::move(name), std::move(value)});
  return std::move(*this);
}

Advice Advice::fact(std::string name, double value, std::string unit) && {
  about_.facts.push_back({std::move(name), NumberWithUnit{value, std::move(unit)}});
  return std::move(*this);
}

Advice Advice::fact(std::string name, Span place) && {
  about_.facts.push_back({std::move(name), place});
  return std::move(*this);
}

Advice Advice::because(std::string rule) && {
  about_.rule = std::move(rule);
  return std::move(*this);
}

Advice Advice::fix(Fix fix) && {
  about_.fixes.push_back(std::move(fix));
  return std::move(*this);
}

Advice Advice::fix(std::vector<Fix> fixes) && {
  for (Fix& each : fixes) about_.fixes.push_back(std::move(each));
  return std::move(*this);
}

Advice Advice::behind(const std::string& text) && {
  about_.help.insert(0, text);
  return std::move(*this);
}

Diagnostic Advice::about(Code code, Span span, std::string message) && {
  about_.code = code;
  about_.span = span;
  about_.message = std::move(message);
  return std::move(about_);
}

Advice did_you_mean(Span span, std::string_view word, const std::vector<std::string>& candidates, Advice otherwise,
                    bool may_be_safe) {
  auto fixes = respell(span, word, candidates, may_be_safe);
  if (fixes.empty()) return otherwise;
  const std::string meant = fixes.front().edits.front().replacement;
  return Advice(fmt::format("did you mean `{}`?", meant)).fix(std::move(fixes)).fact("meant", meant);
}

}  // namespace wale
