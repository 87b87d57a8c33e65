#include "compiler/diagnostics/apply_fixes.hpp"

#include <algorithm>
#include <map>

namespace wale {
namespace {

/// Edits by their first byte; no two overlap.
using Edits = std::map<std::uint32_t, Edit>;

/// Adds the edit unless it overlaps with another or inserts at the same place, where the order would be a guess.
bool add(Edits& edits, const Edit& edit) {
  const auto next = edits.lower_bound(edit.span.begin);
  if (next != edits.end() && (next->first == edit.span.begin || next->first < edit.span.end)) return false;
  if (next != edits.begin() && std::prev(next)->second.span.end > edit.span.begin) return false;
  edits.emplace_hint(next, edit.span.begin, edit);
  return true;
}

/// Adds all edits of the fix or none.
bool add(Edits& edits, const Fix& fix, SourceId source, std::size_t text_size) {
  std::vector<std::uint32_t> added;
  const bool whole = std::ranges::all_of(fix.edits, [&](const Edit& edit) {
    const Span span = edit.span;
    const bool fits = span.source == source && span.begin <= span.end && span.end <= text_size && add(edits, edit);
    if (fits) added.push_back(span.begin);
    return fits;
  });
  if (!whole)
    for (const std::uint32_t begin : added) edits.erase(begin);
  return whole && !added.empty();
}

}  // namespace

FixedText apply_fixes(std::string_view text, SourceId source, const std::vector<Fix>& fixes) {
  FixedText result;
  Edits edits;
  for (const Fix& fix : fixes)
    if (add(edits, fix, source, text.size())) result.applied.push_back(fix);
  std::ranges::stable_sort(result.applied, {}, [](const Fix& fix) { return fix.edits.front().span.begin; });
  std::size_t at = 0;
  for (const auto& [begin, edit] : edits) {
    result.text += text.substr(at, begin - at);
    result.text += edit.replacement;
    at = edit.span.end;
  }
  result.text += text.substr(at);
  return result;
}

std::vector<Fix> safe_fixes(const std::vector<Diagnostic>& diagnostics) {
  std::vector<Fix> fixes;
  for (const Diagnostic& diagnostic : diagnostics) {
    const auto safe = std::ranges::find(diagnostic.fixes, true, &Fix::safe);
    if (safe != diagnostic.fixes.end()) fixes.push_back(*safe);
  }
  return fixes;
}

}  // namespace wale
