#include <CLI/CLI.hpp>
#include <cstdlib>
#include <memory>

#include "compiler/command/options.hpp"
#include "compiler/command/print.hpp"
#include "compiler/modules/library_folders.hpp"
#include "library/review/review.hpp"

namespace wale::command {
namespace {

struct LibraryCheckOptions {
  std::vector<std::string> paths, folders;
  bool json = false;
  Sandbox sandbox = Sandbox::required;
};

int library_check(const LibraryCheckOptions& options) {
  warn_of_library_variable();
  const auto review =
      wale::review(options.paths, library_folders(options.folders, std::getenv("WALE_LIBRARY")), options.sandbox);
  if (!review) return refuse(review.error());
  if (options.json) {
    print_out(review_json(*review));
  } else {
    for (const ReviewedFile& file : review->files) print_diagnostics(stdout, file.diagnostics, file.sources);
    print_out(review_text(*review));
  }
  return review->accepted() ? done : refused;
}

Run declare_library_check(CLI::App& verb) {
  const auto options = std::make_shared<LibraryCheckOptions>();
  must_say(verb.add_option("FILE", options->paths,
                           "paths of Wale files, or of folders with all Wale files in them, as in library/fabric"),
           "the path of a Wale file or of a folder")
      ->required();
  offer_library(verb, options->folders);
  offer_sandbox(verb, options->sandbox);
  offer_json(verb, options->json, "whether all are accepted, each material, and the diagnostics, as an object");
  verb.footer(
      "A library takes a material with three layers, names in two languages, sources, a licence, and how well each\n"
      "level is known, that nobody takes for another one of its kind.\n"
      "for example: wale library check my/library;  wale library check cord.wale");
  return [options] { return library_check(*options); };
}

}  // namespace

extern const Verb library_check_verb{
    "library-check", "says whether a library can take materials in, and what is missing", declare_library_check};

}  // namespace wale::command
