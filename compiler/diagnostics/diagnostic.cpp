#include "compiler/diagnostics/diagnostic.hpp"

#include <algorithm>
#include <utility>

namespace wale {
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
