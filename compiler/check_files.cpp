#include "compiler/check_files.hpp"

#include <fmt/format.h>

#include <filesystem>
#include <set>
#include <tuple>
#include <utility>

#include "compiler/compile.hpp"
#include "compiler/compile_workspace.hpp"
#include "compiler/diagnostics/apply_fixes.hpp"
#include "compiler/legibility/check_legibility.hpp"
#include "compiler/solve/level_scale.hpp"
#include "compiler/text/other_file.hpp"
#include "compiler/text/output_file.hpp"
#include "compiler/try_fixes.hpp"

namespace wale {
namespace {

/// Rounds of fixes for one file: a fix may uncover another error, and a round reports at most a hundred errors. Files
/// that people write need fewer than half of this.
constexpr int most_rounds = 20;
/// Passes over all files: mending one file may uncover errors in a file that imports it.
constexpr int most_passes = 3;

}  // namespace

Diagnostics check_text(SourceSet& sources, SourceId source, const std::vector<std::string>& roots, Sandbox sandbox) {
  Diagnostics diagnostics;
  const auto resolver = file_resolver(roots, nullptr, sandbox);
  const CheckedModule module = check_source(sources, source, *resolver, diagnostics);
  if (diagnostics.has_errors())
    return with_fixes_that_mend(sources, source, diagnostics, [&](SourceSet& again, SourceId changed) {
      Diagnostics found;
      check_source(again, changed, *file_resolver(roots, nullptr, sandbox), found);
      return found;
    });
  check_levels(module.declarations(), source, default_device, diagnostics);
  for (const auto& material : module.materials) {
    Diagnostics of_material;
    compile_material(module, material.name, default_device, sources, source, *resolver, of_material);
    for (const auto& diagnostic : of_material.all()) diagnostics.report(diagnostic);
  }
  for (const auto& workspace : module.workspaces) {
    const auto laid = compile_workspace(workspace, module, default_device, sources, source, *resolver, diagnostics);
    if (laid) check_legibility(workspace, *laid, module.declarations(), default_device, diagnostics);
  }
  return diagnostics;
}

namespace {

/// The text after those fixes of it that make it no worse.
FixedText carefully_fixed(const std::string& file, const std::string& text, SourceId source,
                          const Diagnostics& diagnostics, const std::vector<std::string>& roots, Sandbox sandbox) {
  const std::vector<Fix> fixes = safe_fixes(diagnostics.all());
  const ErrorCount before(diagnostics);
  const auto helps = [&](const FixedText& fixed) {
    SourceSet again;
    const SourceId changed = again.add(file, fixed.text);
    return ErrorCount(check_text(again, changed, roots, sandbox)).is_no_more_than(before);
  };
  FixedText all = apply_fixes(text, source, fixes);
  if (all.applied.empty() || helps(all)) return all;
  FixedText good{text, {}};
  std::vector<Fix> chosen;
  for (const Fix& fix : fixes) {
    chosen.push_back(fix);
    FixedText more = apply_fixes(text, source, chosen);
    if (more.applied.size() > good.applied.size() && helps(more))
      good = std::move(more);
    else
      chosen.pop_back();
  }
  return good;
}

/// Applies fixes to a text until none are left; adds them to `mends`.
std::string mended(const std::string& file, std::string text, const std::vector<std::string>& roots, Sandbox sandbox,
                   std::vector<Mend>& mends) {
  std::set<std::string> seen = {text};
  for (int round = 0; round < most_rounds; ++round) {
    SourceSet sources;
    const SourceId source = sources.add(file, text);
    const Diagnostics diagnostics = check_text(sources, source, roots, sandbox);
    FixedText fixed = carefully_fixed(file, text, source, diagnostics, roots, sandbox);
    // Stop if the fixes lead back to an earlier text.
    if (fixed.applied.empty() || !seen.insert(fixed.text).second) break;
    for (const Fix& fix : fixed.applied) mends.push_back({sources.place(fix.edits.front().span), fix.title});
    text = std::move(fixed.text);
  }
  return text;
}

/// Whether the file was changed.
bool mend_file(MendedFile& result, const std::vector<std::string>& roots, Sandbox sandbox) {
  auto read = read_file(result.file);
  if (!read || !result.written || other_file(result.file, read->bytes)) return false;  // the check reports why
  std::vector<Mend> mends;
  const std::string text = mended(result.file, read->bytes, roots, sandbox, mends);
  if (text == read->bytes) return false;
  result.written = replace_file(result.file, text);
  if (!result.written) return false;
  result.mends.insert(result.mends.end(), mends.begin(), mends.end());
  return true;
}

}  // namespace

CheckedFiles check_files(const std::vector<std::string>& files, const std::vector<std::string>& roots,
                         Sandbox sandbox) {
  CheckedFiles result;
  std::set<std::tuple<std::string, std::uint32_t, std::uint32_t, Code, std::string>> said;
  for (const auto& file : files) {
    auto read = read_file(file);
    Diagnostics diagnostics;
    if (!read) {
      diagnostics.report({.code = Code::unreadable_file,
                          .span = {result.sources.add(file, ""), 0, 0},
                          .message = fmt::format("`{}` cannot be read: {}", file, read.error().sentence),
                          .help = mend_of_path(file)});
    } else if (const auto other = other_file(file, read->bytes)) {
      diagnostics.report({.code = Code::damaged_file,
                          .span = {result.sources.add(file, ""), 0, 0},
                          .message = fmt::format("expected a Wale file, found {}: `{}`", other->what, file),
                          .help = std::string(other->mend)});
    } else {
      const SourceId source = result.sources.add(file, std::move(read->bytes));
      diagnostics = check_text(result.sources, source, roots, sandbox);
    }
    for (const auto& each : diagnostics.all()) {
      const auto name = std::filesystem::path(result.sources[each.span.source].name).lexically_normal().string();
      if (said.emplace(name, each.span.begin, each.span.end, each.code, each.message).second)
        result.diagnostics.report(each);
    }
  }
  return result;
}

std::vector<MendedFile> mend_files(const std::vector<std::string>& files, const std::vector<std::string>& roots,
                                   Sandbox sandbox) {
  std::vector<MendedFile> results;
  for (const auto& file : files) results.push_back({.file = file});
  for (int pass = 0; pass < most_passes; ++pass) {
    bool changed = false;
    for (MendedFile& each : results) changed = mend_file(each, roots, sandbox) || changed;
    if (!changed) break;
  }
  return results;
}

}  // namespace wale
