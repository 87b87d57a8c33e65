#include <CLI/CLI.hpp>
#include <cstdlib>
#include <filesystem>
#include <memory>

#include "compiler/command/options.hpp"
#include "compiler/command/print.hpp"
#include "compiler/modules/library_folders.hpp"
#include "library/review/review.hpp"

namespace wale::command {
namespace {

struct LibraryCheckOptions {
  std::vector<std::string> paths, folders;
  std::string since;  ///< the file of an earlier check; empty for none
  bool json = false;
  Sandbox sandbox = Sandbox::required;
};

/// What an earlier check has kept; nothing if there was none.
Result<KeptReview> kept_in(const std::string& since) {
  std::error_code ignored;
  if (since.empty() || !std::filesystem::exists(since, ignored)) return KeptReview();
  return read_kept(since);
}

int library_check(const LibraryCheckOptions& options) {
  warn_of_library_variable();
  const auto kept = kept_in(options.since);
  if (!kept) return refuse(kept.error());
  ReviewRequest request;
  request.paths = options.paths.empty() ? std::vector<std::string>{"."} : options.paths;
  request.roots = library_folders(options.folders, std::getenv("WALE_LIBRARY"));
  request.sandbox = options.sandbox, request.since = &*kept;
  const auto review = wale::review(request);
  if (!review) return refuse(review.error());
  if (options.json) {
    print_out(review_json(*review));
  } else {
    for (const ReviewedFile& file : review->files) {
      Diagnostics of_language;
      for (const Diagnostic& each : file.diagnostics.all())
        if (!is_of_library(each.code)) of_language.report(each);
      print_diagnostics(stdout, of_language, file.sources);
    }
    print_out(review_text(*review));
  }
  if (!options.since.empty()) {
    InputFiles inputs;
    for (const ReviewedFile& file : review->files) inputs.push_back(file.file);
    if (const auto written = write_file(options.since, kept_text(review->kept), inputs); !written)
      return refuse(written.error());
  }
  return review->accepted() ? done : refused;
}

Run declare_library_check(CLI::App& verb) {
  const auto options = std::make_shared<LibraryCheckOptions>();
  must_say(verb.add_option("FILE", options->paths,
                           "paths of Wale files, or of folders with all Wale files in them, as in library/fabric "
                           "(default: the current folder)"),
           "the path of a Wale file or of a folder");
  must_say(verb.add_option("--since", options->since,
                           "compiles only files that have changed since this file was written, by a hash of all that they "
                           "rest on, and writes it anew; it may be missing the first time")
               ->type_name("FILE"),
           "the name of a file", "for example, `--since checked.json`");
  offer_library(verb, options->folders);
  offer_sandbox(verb, options->sandbox);
  offer_json(verb, options->json, "whether all are accepted, each material, and the diagnostics, as an object");
  verb.footer(
      "A library takes a material with three layers, names in two languages, sources, a licence, and how well each\n"
      "level is known, that compiles for every class of devices, feels as it asks, and that nobody takes for another\n"
      "one of its kind. Exit status 1: it cannot take all of them.\n"
      "for example: wale library check my/library --since checked.json;  wale library check cord.wale");
  return [options] { return library_check(*options); };
}

}  // namespace

extern const Verb library_check_verb{
    "library-check", "says whether a library can take materials in, and what is missing", declare_library_check};

}  // namespace wale::command
