#include "compiler/compare/compare.hpp"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <memory>

#include "compiler/command/options.hpp"
#include "compiler/command/print.hpp"
#include "compiler/command/recalled.hpp"
#include "compiler/compare/compare_files.hpp"
#include "compiler/measure/coarseness.hpp"
#include "compiler/modules/load_modules.hpp"
#include "schema/visible_text.hpp"

namespace wale::command {
namespace {

struct CompareOptions {
  Choice choice;  ///< device and folders; no file
  std::vector<std::string> names;
  bool with_table = false, json = false;
};

int compare(const CompareOptions& options) {
  const std::shared_ptr<const CommonModules> common = declared_everywhere();
  const FileRequest request = options.choice.request();
  warn_of_library_variable();
  std::vector<ComparedFile> files = read_cues(options.names, request, common->declarations);
  if (std::ranges::any_of(options.names, is_searched_for)) say_unread(request.roots);
  Choice choice = options.choice;
  choice.shares_options = std::ranges::any_of(
      files, [](const ComparedFile& file) { return !file.opened || !file.opened->program.has_value(); });
  int status = done;
  const auto require = [&](const auto& result) {
    if (!result) status = std::max(status, refuse(result.error()));
    return result.has_value();
  };
  for (const ComparedFile& file : files) {
    if (!require(file.opened)) continue;
    const OpenedFile& opened = *file.opened;
    if (opened.module && !require(has_device(*opened.module, options.choice)))
      return status;  // nor have the others, most likely
    say_taken(opened);
    print_diagnostics(stderr, opened.diagnostics, opened.sources);
    require(is_as_named(opened, file.name.material, options.choice));
    if (!require(has_use_for_options(opened, choice))) return status;  // nor has any other
    if (opened.diagnostics.has_errors()) status = std::max(status, refused);
    // Some files only have functions for others.
    if (file.without_material())
      refuse(fmt::format("`{}` has no material and is left out", visible_text(file.name.file)));
  }
  if (status != done) return status;
  warn_of_device_files(options.choice);
  if (const auto fit = comparable(files); !fit) return refuse(fit.error());
  std::vector<Cues> materials;
  for (ComparedFile& file : files) materials.insert(materials.end(), file.cues.begin(), file.cues.end());
  for (const Cues& cues : materials)
    if (cues.coarseness > 1) print_error("wale: {}\n", coarseness_note(cues.material, cues.coarseness));
  const ComparisonMatrix matrix(std::move(materials), common->declarations);
  print_recalled(matrix.recalled());
  print_out(options.json ? comparison_json(matrix) : comparison_text(matrix, options.with_table));
  return done;
}

Run declare_compare(CLI::App& verb) {
  const auto options = std::make_shared<CompareOptions>();
  must_say(verb.add_option(
               "FILE", options->names,
               "Wale files or patch programs, with all of their materials; FILE:MATERIAL for one; or materials of the "
               "library by name"),
           "a file or the name of a material")
      ->required();
  offer_device(verb, options->choice);
  offer_library(verb, options->choice.folders);
  offer_sandbox(verb, options->choice.sandbox);
  auto* table =
      verb.add_flag("--matrix", options->with_table, "prints all distances, even if the table does not fit a screen");
  offer_json(verb, options->json,
             "an object with every material's cues, all distances, and the nearest pairs cue by cue")
      ->excludes(table);
  verb.footer("for example: wale compare velvet denim;  wale compare my.wale:old my.wale:new");
  return [options] { return compare(*options); };
}

}  // namespace

extern const Verb compare_verb{"compare", "says by which cues people would tell materials apart, and how easily",
                               declare_compare};

}  // namespace wale::command
