// The command line: a table of verbs, each a few calls into the folders.

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <optional>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include "compiler/command/deep_thread.hpp"
#include "compiler/command/options.hpp"
#include "compiler/command/print.hpp"
#include "schema/spelling.hpp"
#include "schema/visible_text.hpp"

namespace wale::command {

// Each is defined in FOLDER/command/VERB.cpp.
extern const Verb build_verb, check_verb, compare_verb, describe_verb, devices_verb, explain_verb, feel_verb, find_verb,
    format_verb, levels_verb, preview_verb, replay_verb, sample_verb;

}  // namespace wale::command

namespace {

using namespace wale;
using namespace wale::command;

constexpr const Verb* verbs[] = {&check_verb,  &explain_verb, &format_verb, &build_verb, &describe_verb,
                                 &find_verb,   &compare_verb, &levels_verb, &feel_verb,  &replay_verb,
                                 &sample_verb, &preview_verb, &devices_verb};

/// The footer of `wale --help`.
constexpr const char* statuses =
    R"(exit status  0: done;  1: the command cannot be carried out, or an error was found;
             2: the words of the command make no sense, or an option names something unknown;
             3: an error in Wale itself)";

constexpr const char* about =
    R"(Wale: a language for how things feel, and the runtime that makes a force-feedback joystick feel that way.

  designers    write a material, then:   wale check my.wale;  wale describe my.wale;  wale feel my.wale
  curators     find, compare and trust:  wale find ribbed;  wale compare A.wale B.wale;  wale levels roughness;
                                         wale describe --json FILE;  wale preview FILE -o OUT.png
  programmers  take a program along:     wale build FILE -o OUT.wpp;  wale sample FILE --at "10.6 mm, 5 mm"
                                         examples/roughness_by_name asks for a roughness by name from C++

Begin with library/fabric/corduroy.wale; schema/LANGUAGE.md is the language.)";

/// "there is no option `--devise`; did you mean `--device`?"
std::string unknown_option(const CLI::App& app, const std::string& word) {
  std::vector<std::string> known;
  const auto enter = [&](const CLI::App& of) {
    for (const CLI::Option* option : of.get_options()) {
      for (const std::string& name : option->get_lnames()) known.push_back("--" + name);
      for (const std::string& name : option->get_snames()) known.push_back("-" + name);
    }
  };
  enter(app);
  for (const CLI::App* group : app.get_subcommands({}))
    if (group->get_name().empty()) enter(*group);
  const auto near = nearest_spelling(word.substr(0, word.find('=')), known);
  return fmt::format("there is no option `{}`{}", visible_text(word),
                     near ? fmt::format("; did you mean `{}`?", *near) : "");
}

/// The message for a misspelt verb or option at the beginning, which CLI11 would report as a missing verb. Returns
/// nullopt if the first word is a verb or a known option. `second` is the word after it, which may be empty.
std::optional<std::string> misspelt_verb(const CLI::App& app, const std::string& first, const std::string& second) {
  std::vector<std::string> verbs;
  for (const CLI::App* known : app.get_subcommands({})) verbs.push_back(known->get_name());
  if (first == "-h" || first == "--help" || first == "--version" || std::ranges::find(verbs, first) != verbs.end())
    return std::nullopt;
  if (first.starts_with('-')) return unknown_option(app, first);
  if (first == "help") {
    const bool is_verb = !second.empty() && std::ranges::find(verbs, second) != verbs.end();
    return fmt::format("there is no verb `help`; `wale {}--help` is the help", is_verb ? second + " " : "");
  }
  const auto near = nearest_spelling(first, verbs);
  return fmt::format("there is no verb `{}`; {}", visible_text(first),
                     near ? fmt::format("did you mean `{}`?", *near)
                          : fmt::format("the verbs are {}; `wale --help` says what they do", fmt::join(verbs, ", ")));
}

/// The words of the command line after the program's name. `--device=` becomes `--device` and an empty word, for an
/// option that takes a value: CLI11 would take the next option as its value.
std::vector<std::string> words_of(const CLI::App& app, int argc, char** argv) {
  std::vector<std::string> words(argv + 1, argv + argc);
  const std::vector<const CLI::App*> verbs = app.get_subcommands({});
  const auto named = std::ranges::find(verbs, words.front(), [](const CLI::App* each) { return each->get_name(); });
  if (named == verbs.end()) return words;
  const CLI::App* verb = *named;
  const auto marks_the_end = std::ranges::find(words, "--");
  std::vector<std::string> split(words.begin(), marks_the_end);
  for (std::size_t i = 1; i < split.size(); ++i) {
    if (!split[i].starts_with("--") || split[i].find('=') + 1 != split[i].size()) continue;
    const std::string name = split[i].substr(0, split[i].size() - 1);
    const CLI::Option* option = verb->get_option_no_throw(name);
    if (option == nullptr || option->get_items_expected_max() == 0) continue;
    split[i] = name;
    split.insert(split.begin() + static_cast<std::ptrdiff_t>(++i), "");
  }
  split.insert(split.end(), marks_the_end, words.end());
  return split;
}

/// "--device: expected once, found twice" or "--device: expected NAME, found nothing": an option with another number of
/// values than it takes. Only the last word can be an option without its value, since an option takes the next word.
std::string mismatch_text(const CLI::App& verb, const std::string& last_word) {
  for (const CLI::Option* option : verb.get_options()) {
    const std::size_t count = option->count();
    if (count > 1 && option->get_items_expected_max() == 1)
      return fmt::format("{}: expected once, found {}", option->get_name(),
                         count == 2 ? "twice" : fmt::format("{} times", count));
  }
  const CLI::Option* last = verb.get_option_no_throw(last_word);
  return last == nullptr ? "expected another number of values"
                         : fmt::format("{}: expected {}, found nothing", last_word, last->get_type_name());
}

/// The error in the words of a command, and where its options are listed.
std::string misuse_text(const CLI::App* app, const CLI::Error& error, const std::string& last_word) {
  const auto verbs = app->get_subcommands();
  const std::string verb = verbs.empty() ? "wale" : "wale " + verbs.front()->get_name();
  std::string what = error.what();
  const auto is = [&](CLI::ExitCodes code) { return error.get_exit_code() == static_cast<int>(code); };
  // An unknown option is told before what is missing: it may be the misspelt name of just that, or of --help.
  if ((is(CLI::ExitCodes::ExtrasError) || is(CLI::ExitCodes::RequiredError)) && !verbs.empty()) {
    const std::vector<std::string> unexpected = verbs.front()->remaining();
    const auto option = std::ranges::find_if(unexpected, [](const auto& word) { return word.starts_with('-'); });
    if (option != unexpected.end())
      what = unknown_option(*verbs.front(), *option);
    else if (is(CLI::ExitCodes::ExtrasError) && unexpected.empty())  // CLI11 hands them to nobody
      what = "`--` ends the options: write it before the first word that is none";
    else if (is(CLI::ExitCodes::ExtrasError))
      what = "unexpected: " + visible_text(fmt::format("{}", fmt::join(unexpected, " ")));
  }
  if (is(CLI::ExitCodes::ArgumentMismatch) && !verbs.empty()) what = mismatch_text(*verbs.front(), last_word);
  return fmt::format("wale: {}\n  = help: `{} --help` lists the options\n", what, verb);
}

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
    print_error(app.help());
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
    print_out(out.str());
    print_error(err.str());
    return refusal == done || refusal == refused ? refusal : misused;
  }
  return status;
}

}  // namespace

int main(int argc, char** argv) {
  prepare_streams();
  return finish_output(
      status_of([&] { return with_deep_stack([&] { return status_of([&] { return run(argc, argv); }); }); }));
}
