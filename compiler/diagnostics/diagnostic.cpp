#include "compiler/diagnostics/diagnostic.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

namespace wale {
namespace {

struct CodeEntry {
  Code code;
  Severity severity;
  const char* title;
};

constexpr CodeEntry entries[] = {
#define CODE(number, name, severity, title) {Code::name, Severity::severity, title},
#include "compiler/diagnostics/diagnostic_codes.def"
};

const CodeEntry& entry(Code code) {
  for (const CodeEntry& each : entries) {
    if (each.code == code) return each;
  }
  return entries[0];  // every enumerator is in the table, so this is never reached
}

}  // namespace

std::string code_name(Code code) { return fmt::format("W{:04}", static_cast<unsigned>(code)); }

std::string code_title(Code code) { return entry(code).title; }

Severity severity_of(Code code) { return entry(code).severity; }

void Diagnostics::report(Diagnostic diagnostic) {
  if (is_full()) return;
  const Key key(diagnostic.code, diagnostic.span.source, diagnostic.span.begin, diagnostic.span.end);
  for (auto [said, end] = said_.equal_range(key); said != end; ++said)
    if (said->second == diagnostic.message) return;
  said_.emplace(key, diagnostic.message);
  if (severity_of(diagnostic.code) == Severity::error) ++errors_;
  all_.push_back(std::move(diagnostic));
}

void Diagnostics::sort() {
  std::ranges::stable_sort(all_, {},
                           [](const Diagnostic& each) { return std::pair(each.span.source, each.span.begin); });
}

}  // namespace wale
