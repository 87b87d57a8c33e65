#include <CLI/CLI.hpp>
#include <cstdlib>
#include <memory>

#include "compiler/command/options.hpp"
#include "compiler/command/print.hpp"
#include "compiler/modules/library_folders.hpp"
#include "compiler/modules/load_modules.hpp"
#include "library/survey/coverage.hpp"
#include "library/survey/survey.hpp"
#include "schema/visible_text.hpp"

namespace wale::command {
namespace {

struct LibraryCoverageOptions {
  std::vector<std::string> paths, folders;
  std::string out;  ///< empty for no picture
  bool json = false;
  Sandbox sandbox = Sandbox::required;
};

int library_coverage(const LibraryCoverageOptions& options) {
  warn_of_library_variable();
  FileRequest request;
  request.roots = library_folders(options.folders, std::getenv("WALE_LIBRARY")), request.sandbox = options.sandbox;
  const auto surveyed =
      survey(options.paths, request, SurveyDepth::feel);
  if (!surveyed) return refuse(surveyed.error());
  int status = surveyed->unread.empty() ? done : refused;
  for (const Error& each : surveyed->unread) warn(each);
  for (const Entry& each : surveyed->entries) {
    if (!each.program.empty()) continue;
    print_error("wale: {}: `{}` cannot be built: {}\n", visible_text(each.file), each.name, visible_text(each.trouble));
    status = refused;
  }
  const auto declared = declared_everywhere();
  const std::vector<std::string> known = declared->declarations.percepts_with_levels();
  const Coverage coverage = coverage_of(surveyed->entries, known);
  if (!options.out.empty()) {
    const auto page = draw_coverage(coverage);
    if (!page) return refuse(page.error());
    const auto bytes = encode_page(**page, options.out);
    if (!bytes) return refuse(bytes.error());
    const auto written =
        write_file(options.out, {reinterpret_cast<const char*>(bytes->data()), bytes->size()}, surveyed->read);
    if (!written) return refuse(written.error());
  }
  print_out(options.json ? coverage_json(coverage) : coverage_text(coverage));
  return status;
}

Run declare_library_coverage(CLI::App& verb) {
  const auto options = std::make_shared<LibraryCoverageOptions>();
  must_say(verb.add_option("FILE", options->paths,
                           "paths of Wale files, or of folders with all Wale files in them (default: the current folder, or the shipped library if it has none)"),
           "the path of a Wale file or of a folder");
  must_say(offer_output(verb, options->out, "a picture of it, as in coverage.svg, or .png"),
           "the name of the file to write", "for example, `-o coverage.svg`");
  offer_library(verb, options->folders);
  offer_sandbox(verb, options->sandbox);
  offer_json(verb, options->json, "the level of each material with its interval, and the empty regions, as an object");
  verb.footer(
      "Levels are those that the finished programs read. A region is empty if no material's interval reaches into it.\n"
      "Exit status 1: some materials could not be built, or files read, and are left out.\n"
      "for example: wale library coverage my/library -o coverage.svg");
  return [options] { return library_coverage(*options); };
}

}  // namespace

extern const Verb library_coverage_verb{
    "library-coverage", "says where a library has materials in percept space, and where it has none",
    declare_library_coverage};

}  // namespace wale::command
