#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cstdlib>
#include <memory>

#include "compiler/check_files.hpp"
#include "compiler/command/options.hpp"
#include "compiler/command/print.hpp"
#include "compiler/diagnostics/apply_fixes.hpp"
#include "compiler/diagnostics/render.hpp"
#include "compiler/modules/library_folders.hpp"
#include "schema/visible_text.hpp"

namespace wale::command {
namespace {

struct CheckOptions {
  std::vector<std::string> files, folders;
  bool json = false, fix = false;
  Sandbox sandbox = Sandbox::required;
};

/// Mends files before they are checked. Reports the mends on standard error, since standard output is for diagnostics.
bool mend(const std::vector<std::string>& files, const std::vector<std::string>& roots, Sandbox sandbox) {
  bool written = true;
  for (const auto& file : mend_files(files, roots, sandbox)) {
    for (const auto& mend : file.mends)
      print_error("mended {}:{}:{}: {}\n", visible_text(file.file), mend.place.line, mend.place.column,
                  visible_text(mend.title));
    if (!file.written) refuse(file.written.error());
    written = written && file.written;
  }
  return written;
}

std::string counted(std::size_t n, const char* what) { return fmt::format("{} {}{}", n, what, n == 1 ? "" : "s"); }

int check(const CheckOptions& options) {
  const auto roots = library_folders(options.folders, std::getenv("WALE_LIBRARY"));
  warn_of_library_variable();
  const bool mended = !options.fix || mend(options.files, roots, options.sandbox);
  const auto [sources, diagnostics] = check_files(options.files, roots, options.sandbox);
  if (options.json) {
    print_out(render_json(diagnostics, sources) + "\n");
  } else {
    print_diagnostics(stdout, diagnostics, sources);
    const std::size_t warnings = diagnostics.all().size() - diagnostics.error_count();
    const std::size_t mendable = safe_fixes(diagnostics.all()).size();
    print_out("{}: {}{}, {}{}\n", counted(options.files.size(), "file"), counted(diagnostics.error_count(), "error"),
              diagnostics.is_full() ? " and more that are not listed" : "", counted(warnings, "warning"),
              mendable > 0 && !options.fix ? fmt::format("; `wale check --fix` mends {}", mendable) : "");
  }
  return diagnostics.has_errors() || !mended ? refused : done;
}

Run declare_check(CLI::App& verb) {
  const auto options = std::make_shared<CheckOptions>();
  must_say(verb.add_option("FILE", options->files, "paths of your Wale files, as in my.wale (not names of materials)"),
           "the path of a Wale file")
      ->required();
  offer_library(verb, options->folders);
  offer_sandbox(verb, options->sandbox);
  verb.add_flag("--json", options->json,
                "the diagnostics as a JSON array, on standard output also if there are errors");
  verb.add_flag("--fix", options->fix, "first writes the mends into the files, where only one meaning is possible");
  verb.footer(
      "Materials are checked as for sandpaper; `wale describe FILE --device NAME` checks them for another device.\n"
      "for example: wale check --fix my.wale");
  return [options] { return check(*options); };
}

}  // namespace

extern const Verb check_verb{"check", "finds errors in Wale files, and says how to mend them", declare_check};

}  // namespace wale::command
