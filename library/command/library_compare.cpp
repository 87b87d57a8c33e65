#include <CLI/CLI.hpp>
#include <cstdlib>
#include <memory>

#include "compiler/command/options.hpp"
#include "compiler/command/print.hpp"
#include "compiler/modules/library_folders.hpp"
#include "compiler/modules/load_modules.hpp"
#include "library/survey/changes.hpp"
#include "library/survey/survey.hpp"

namespace wale::command {
namespace {

struct LibraryCompareOptions {
  std::string before, after;
  std::vector<std::string> folders;
  bool json = false;
  Sandbox sandbox = Sandbox::required;
};

int library_compare(const LibraryCompareOptions& options) {
  warn_of_library_variable();
  FileRequest request;
  request.roots = library_folders(options.folders, std::getenv("WALE_LIBRARY")), request.sandbox = options.sandbox;
  const auto before = survey({options.before}, request, SurveyDepth::feel);
  if (!before) return refuse(before.error());
  const auto after = survey({options.after}, request, SurveyDepth::feel);
  if (!after) return refuse(after.error());
  bool whole = true;
  for (const Survey* each : {&*before, &*after})
    for (const Error& unread : each->unread) warn(unread), whole = false;
  const Comparer comparer(declared_everywhere()->declarations, default_device);
  const LibraryChanges changes = changes_between(before->entries, after->entries, comparer);
  print_out(options.json ? changes_json(changes) : changes_text(changes));
  return changes.keeps_promises() && whole ? done : refused;
}

Run declare_library_compare(CLI::App& verb) {
  const auto options = std::make_shared<LibraryCompareOptions>();
  must_say(verb.add_option("OLD", options->before, "the folder, or the Wale file, of the old version"),
           "the path of a folder or of a Wale file")
      ->required();
  must_say(verb.add_option("NEW", options->after, "that of the new one"), "the path of a folder or of a Wale file")
      ->required();
  offer_library(verb, options->folders);
  offer_sandbox(verb, options->sandbox);
  offer_json(verb, options->json, "what was added, removed, superseded and changed, cue by cue, as an object");
  verb.footer(
      "Exit status 1: a name has gone without a successor (`replaces`) or with several, or feels plainly different than\n"
      "before; or something of the new version cannot be built.\n"
      "Of a version in git: git worktree add ../before v1.0\n"
      "for example: wale library compare ../before my/library");
  return [options] { return library_compare(*options); };
}

}  // namespace

extern const Verb library_compare_verb{"library-compare", "says what changed to the hand between two versions of a library",
                                       declare_library_compare};

}  // namespace wale::command
