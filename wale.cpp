// The command line: a table of verbs, each a few calls into the folders.

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <exception>
#include <optional>
#include <string>
#include <vector>

#include "compiler/command/options.hpp"
#include "schema/spelling.hpp"

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

constexpr const char* about =
    R"(Wale: a language for how things feel, and the runtime that makes a force-feedback joystick feel that way.

  designers    write a material, then:   wale check my.wale;  wale describe my.wale;  wale feel my.wale
  curators     find, compare and trust:  wale find ribbed;  wale compare A.wale B.wale;  wale levels roughness;
                                         wale describe --json FILE;  wale preview FILE -o OUT.png
  programmers  take a program along:     wale build FILE -o OUT.wpp;  wale sample FILE --at "10.6 mm, 5 mm"
                                         examples/roughness_by_name asks for a roughness by name from C++

Begin with library/fabric/corduroy.wale; schema/LANGUAGE.md is the language.)";

/// The message for a misspelt verb, which CLI11 would report as a missing one; nothing if the first word is a verb or
/// an option.
std::optional<std::string> misspelt_verb(const CLI::App& app, const std::string& first) {
  std::vector<std::string> verbs;
  for (const CLI::App* known : app.get_subcommands({})) verbs.push_back(known->get_name());
  if (first.starts_with('-') || std::ranges::find(verbs, first) != verbs.end()) return std::nullopt;
  const auto near = nearest_spelling(first, verbs);
  return fmt::format("there is no verb `{}`; {}", first,
                     near ? fmt::format("did you mean `{}`?", *near)
                          : fmt::format("the verbs are {}; `wale --help` says what they do", fmt::join(verbs, ", ")));
}

/// The error in the words of a command, and where its options are listed.
std::string misuse_text(const CLI::App* app, const CLI::Error& error) {
  const auto verbs = app->get_subcommands();
  const std::string verb = verbs.empty() ? "wale" : "wale " + verbs.front()->get_name();
  return fmt::format("wale: {}\n  = help: `{} --help` lists the options\n", error.what(), verb);
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app(about, "wale");
  app.set_version_flag("--version", "wale " WALE_VERSION ", language version 1");
  app.require_subcommand(1);
  int status = 0;

  for (const Verb* each : verbs) {
    CLI::App* declared = app.add_subcommand(each->name, each->about);
    declared->callback([&status, declared, run = each->declare(*declared)] {
      const Result<> complete = without_empty_words(*declared);
      if (!complete) refuse(complete.error());
      status = complete ? run() : misused;
    });
  }

  if (argc == 1) {
    fmt::print(stderr, "{}", app.help());
    return misused;
  }
  if (const auto misspelt = misspelt_verb(app, argv[1])) {
    refuse(*misspelt);
    return misused;
  }
  app.failure_message(misuse_text);
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    const int refusal = app.exit(error);  // the codes of CLI11 itself are above 100
    return refusal == done || refusal == refused ? refusal : misused;
  } catch (const std::exception& error) {  // thrown on the way here, it has let every device go
    fmt::print(stderr, "wale: ended by an error that nothing handles: {}; please report what led to it\n", error.what());
    return refused;
  }
  return status;
}
