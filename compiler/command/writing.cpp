#include <fmt/format.h>

#include <cstdlib>

#include "compiler/check_files.hpp"
#include "compiler/command/verbs.hpp"
#include "compiler/diagnostics/apply_fixes.hpp"
#include "compiler/diagnostics/explain.hpp"
#include "compiler/diagnostics/render.hpp"
#include "compiler/format/format.hpp"
#include "compiler/modules/library_folders.hpp"
#include "compiler/text/replace_file.hpp"

// The verbs of those who write Wale.

namespace wale::command {
namespace {

/// Mends files before they are checked, and says what was done on standard error, which leaves the output to the check.
bool mend(const std::vector<std::string>& files, const std::vector<std::string>& roots) {
  bool written = true;
  for (const auto& file : mend_files(files, roots)) {
    for (const auto& mend : file.mends)
      fmt::print(stderr, "mended {}:{}:{}: {}\n", file.file, mend.place.line, mend.place.column, mend.title);
    if (file.problem) refuse(fmt::format("cannot write `{}`: {}", file.file, *file.problem));
    written = written && !file.problem;
  }
  return written;
}

}  // namespace

int check(const std::vector<std::string>& files, const std::vector<std::string>& folders, bool json, bool fix) {
  const auto roots = library_folders(folders, std::getenv("WALE_LIBRARY"));
  const bool mended = !fix || mend(files, roots);
  const auto [sources, diagnostics] = check_files(files, roots);
  if (json) {
    fmt::print("{}\n", render_json(diagnostics, sources));
  } else {
    print_diagnostics(stdout, diagnostics, sources);
    const std::size_t warnings = diagnostics.all().size() - diagnostics.error_count();
    const std::size_t mendable = safe_fixes(diagnostics.all()).size();
    const auto count = [](std::size_t n, const char* what) {
      return fmt::format("{} {}{}", n, what, n == 1 ? "" : "s");
    };
    fmt::print("{}: {}{}, {}{}\n", count(files.size(), "file"), count(diagnostics.error_count(), "error"),
               diagnostics.is_full() ? " and more that are not listed" : "", count(warnings, "warning"),
               mendable > 0 && !fix ? fmt::format("; `wale check --fix` mends {}", mendable) : "");
  }
  return diagnostics.has_errors() || !mended ? refused : 0;
}

int explain(const std::string& name) {
  if (name.empty()) {
    fmt::print("{}", codes_text());
    return 0;
  }
  const auto code = code_named(name);
  if (!code) return refuse(unknown_code_text(name));
  fmt::print("{}", explanation_text(*code));
  return 0;
}

int format(const std::vector<std::string>& files, bool check_only) {
  int status = 0;
  for (const auto& file : files) {
    const bool standard = file == "-";
    auto read = read_file(standard ? "/dev/stdin" : file);
    if (!read) {
      status = refuse(fmt::format("`{}` cannot be read: {}", file, read.error().sentence));
      continue;
    }
    SourceSet sources;
    Diagnostics diagnostics;
    const SourceId source = sources.add(file, std::move(read->bytes));
    const auto formatted = format(sources, source, diagnostics);
    print_diagnostics(stderr, diagnostics, sources);
    const bool changes = formatted && *formatted != sources[source].text;
    if (!formatted || (check_only && changes)) status = refused;
    if (check_only && changes) fmt::print("{}\n", file);
    if (!formatted || check_only) continue;
    std::optional<std::string> problem;
    if (standard) problem = write_file("-", *formatted);
    if (!standard && changes) problem = replace_file(file, *formatted);
    if (problem) status = refuse(standard ? *problem : fmt::format("cannot write `{}`: {}", file, *problem));
  }
  return status;
}

}  // namespace wale::command
