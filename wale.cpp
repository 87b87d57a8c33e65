// The command line: a table of verbs, each a few calls into the folders.

#include <CLI/CLI.hpp>
#include <algorithm>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include "compiler/command/deep_thread.hpp"
#include "compiler/command/memory.hpp"
#include "compiler/command/options.hpp"
#include "compiler/command/print.hpp"
#include "compiler/command/words.hpp"

namespace wale::command {

// Each is defined in FOLDER/command/VERB.cpp.
extern const Verb between_verb, build_verb, calibrate_device_verb, calibrate_fit_verb, calibrate_report_verb, check_verb, compare_verb,
    describe_verb, devices_verb, experiment_export_verb, experiment_plan_verb, experiment_run_verb, explain_verb,
    export_verb, feel_verb, find_verb, format_verb, import_verb, levels_verb, library_check_verb, library_compare_verb,
    library_coverage_verb, library_import_verb, library_index_verb, library_serve_verb, library_sheet_verb,
    library_site_verb, manual_verb, preview_verb, replay_verb, sample_verb, sandpaper_verb, show_verb;

}  // namespace wale::command

namespace {

using namespace wale;
using namespace wale::command;

constexpr const Verb* verbs[] = {
    &check_verb,          &explain_verb,        &format_verb,           &build_verb,
    &describe_verb,       &find_verb,           &show_verb,             &between_verb,
    &compare_verb,        &library_check_verb,  &library_sheet_verb,    &library_coverage_verb,
    &library_compare_verb, &library_import_verb, &library_index_verb,   &library_site_verb,
    &library_serve_verb,  &levels_verb,         &feel_verb,             &replay_verb,
    &sample_verb,         &experiment_plan_verb, &experiment_run_verb,  &experiment_export_verb,
    &calibrate_device_verb, &calibrate_fit_verb,  &calibrate_report_verb, &preview_verb,        &import_verb,
    &export_verb,         &sandpaper_verb,      &devices_verb,          &manual_verb};

/// The footer of `wale --help`.
constexpr const char* statuses =
    R"(exit status  0: done;  1: the command cannot be carried out, or an error was found;
             2: the words of the command make no sense, or an option names something unknown;
             3: an error in Wale itself)";

constexpr const char* about =
    R"(Wale: a language for how things feel, and the runtime that makes a force-feedback joystick feel that way.

  designers    write a material, then:   wale check my.wale;  wale describe my.wale;  wale feel my.wale
  curators     find, compare and trust:  wale find ribbed;  wale find --near corduroy;  wale show denim;
                                         wale compare A.wale B.wale;  wale levels roughness;
                                         wale preview FILE -o OUT.png;  wale library check FILE
  programmers  take a program along:     wale build FILE -o OUT.wpp;  wale sample FILE --at "10.6 mm, 5 mm"
                                         examples/roughness_by_name asks for a roughness by name from C++
  researchers  where maps come from:     wale experiment run FILE --participant S1;
                                         wale calibrate fit S1.trials S2.trials -o map.wale

Begin with library/fabric/corduroy.wale; schema/LANGUAGE.md is the language.)";

/// Runs the verb that the words name. Returns the exit status.
int run(int argc, char** argv) {
  CLI::App app(about, "wale");
  app.set_version_flag("--version", "wale " WALE_VERSION ", language version 1");
  app.footer(statuses);
  app.require_subcommand(1);
  app.get_formatter()->label("REQUIRED", "(required)");
  app.get_formatter()->label("Needs", "needs");
  app.get_formatter()->label("Excludes", "not with");
  int status = 0;

  for (const Verb* each : verbs) {
    CLI::App* declared = app.add_subcommand(each->name, each->about);
    const Run chosen = each->declare(*declared);
    for (CLI::Option* option : declared->get_options())
      if (option->get_positional()) option->type_name("");  // its name says it: FILE, not FILE TEXT
    declared->callback([&status, declared, run = chosen] {
      const Result<> complete = without_empty_words(*declared);
      if (!complete) refuse(complete.error());
      status = complete ? run() : misused;
    });
  }

  if (argc <= 1) {
    print_error(with_spelt_verbs(app, app.help()));
    return misused;
  }
  if (const auto misspelt = misspelt_verb(app, argv[1], argc > 2 ? argv[2] : "")) {
    refuse(*misspelt);
    return misused;
  }
  std::vector<std::string> words = words_of(app, argc, argv);
  app.failure_message([last_word = words.back()](const CLI::App* of, const CLI::Error& error) {
    return misuse_text(of, error, last_word);
  });
  std::ranges::reverse(words);  // as CLI11 reads them
  try {
    app.parse(std::move(words));
  } catch (const CLI::ParseError& error) {
    std::ostringstream out, err;
    const int refusal = app.exit(error, out, err);  // the codes of CLI11 itself are above 100
    print_out(with_spelt_verbs(app, out.str()));
    print_error(with_spelt_verbs(app, err.str()));
    return refusal == done || refusal == refused ? refusal : misused;
  }
  return status;
}

}  // namespace

int main(int argc, char** argv) {
  keep_freed_memory();
  prepare_streams();
  return finish_output(
      status_of([&] { return with_deep_stack([&] { return status_of([&] { return run(argc, argv); }); }); }));
}
