#include "compiler/try_fixes.hpp"

#include <algorithm>
#include <array>
#include <set>
#include <string>
#include <utility>

#include "compiler/diagnostics/apply_fixes.hpp"

namespace wale {
namespace {

constexpr std::size_t most_tried = 40;
constexpr std::size_t longest_text = 256 * 1024;  // bytes

using Said = std::set<std::pair<Code, std::string>>;

Said errors_said(const Diagnostics& diagnostics) {
  Said said;
  for (const Diagnostic& each : diagnostics.all())
    if (severity_of(each.code) == Severity::error) said.emplace(each.code, each.message);
  return said;
}

/// The lines of the text after a fix that the fix has changed.
std::set<unsigned> lines_changed(const Fix& fix, const SourceSet& after, SourceId source) {
  std::vector<Edit> edits = fix.edits;
  std::ranges::sort(edits, {}, [](const Edit& each) { return each.span.begin; });
  std::set<unsigned> lines;
  std::int64_t moved = 0;
  for (const Edit& each : edits) {
    const auto begin = static_cast<std::uint32_t>(each.span.begin + moved);
    const auto end = static_cast<std::uint32_t>(begin + each.replacement.size());
    const unsigned last = after.place({source, end, end}).line;
    for (unsigned line = after.place({source, begin, begin}).line; line <= last; ++line) lines.insert(line);
    moved += static_cast<std::int64_t>(each.replacement.size()) - (each.span.end - each.span.begin);
  }
  return lines;
}

/// The lines of the text before a fix that the fix changes.
std::set<unsigned> lines_edited(const Fix& fix, const SourceSet& sources) {
  std::set<unsigned> lines;
  for (const Edit& each : fix.edits) {
    const unsigned last = sources.place({each.span.source, each.span.end, each.span.end}).line;
    for (unsigned line = sources.place(each.span).line; line <= last; ++line) lines.insert(line);
  }
  return lines;
}

std::size_t errors_in(const std::set<unsigned>& lines, const Diagnostics& diagnostics, const SourceSet& sources,
                      SourceId source) {
  return static_cast<std::size_t>(std::ranges::count_if(diagnostics.all(), [&](const Diagnostic& each) {
    return severity_of(each.code) == Severity::error && each.span.source == source &&
           lines.contains(sources.place(each.span).line);
  }));
}

/// Whether a has fewer errors than b, or as many where that is enough.
bool compare(const ErrorCount& a, const ErrorCount& b, bool or_equal) {
  const std::array<std::pair<std::size_t, std::size_t>, 3> stages = {
      {{a.unread, b.unread}, {a.meaningless, b.meaningless}, {a.unmade, b.unmade}}};
  for (const auto& [here, there] : stages) {
    if (here > 0) return here < there || (or_equal && here == there);
    if (there > 0) return true;
  }
  return or_equal;
}

bool mends(const Fix& fix, const SourceSet& sources, SourceId source, const Diagnostics& before,
           const CheckAgain& check) {
  const FixedText fixed = apply_fixes(sources[source].text, source, {fix});
  if (fixed.applied.empty()) return true;  // it is of another file
  SourceSet again;
  const SourceId changed = again.add(std::string(sources[source].name), fixed.text);
  const Diagnostics after = check(again, changed);
  Fix here = fix;
  for (Edit& each : here.edits) each.span.source = changed;
  const std::set<unsigned> lines = lines_changed(here, again, changed);
  if (fix.safe) {
    // Elsewhere what cannot be read hid other errors, but in its own lines a mend that leaves more was a wrong guess.
    const std::size_t left = errors_in(lines, after, again, changed);
    return left <= std::max<std::size_t>(1, errors_in(lines_edited(fix, sources), before, sources, source)) &&
           ErrorCount(after).is_no_more_than(ErrorCount(before));
  }
  if (!ErrorCount(after).is_less_than(ErrorCount(before))) return false;
  const Said said = errors_said(before);
  return std::ranges::none_of(after.all(), [&](const Diagnostic& each) {
    return severity_of(each.code) == Severity::error && each.span.source == changed &&
           lines.contains(again.place(each.span).line) && !said.contains({each.code, each.message});
  });
}

}  // namespace

ErrorCount::ErrorCount(const Diagnostics& diagnostics) {
  constexpr unsigned first_of_meaning = 200, first_of_programs = 400;  // W02xx, W04xx
  for (const Diagnostic& each : diagnostics.all()) {
    if (severity_of(each.code) != Severity::error) continue;
    const auto code = static_cast<unsigned>(each.code);
    ++(code < first_of_meaning ? unread : code < first_of_programs ? meaningless : unmade);
  }
}

bool ErrorCount::is_less_than(const ErrorCount& other) const { return compare(*this, other, false); }

bool ErrorCount::is_no_more_than(const ErrorCount& other) const { return compare(*this, other, true); }

Diagnostics with_fixes_that_mend(const SourceSet& sources, SourceId source, const Diagnostics& diagnostics,
                                 const CheckAgain& check) {
  if (!diagnostics.has_errors() || sources[source].text.size() > longest_text) return diagnostics;
  std::size_t tried = 0;
  Diagnostics result;
  for (Diagnostic each : diagnostics.all()) {
    if (severity_of(each.code) == Severity::error)
      std::erase_if(each.fixes, [&](const Fix& fix) {
        return ++tried <= most_tried && !mends(fix, sources, source, diagnostics, check);
      });
    result.report(std::move(each));
  }
  return result;
}

}  // namespace wale
