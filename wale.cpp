// The command line: a table of verbs, each a few calls into the folders.

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <atomic>
#include <csignal>
#include <cstdio>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "calibration/feel/feel.hpp"
#include "compiler/command/options.hpp"
#include "compiler/measure/sample.hpp"
#include "compiler/quantity.hpp"
#include "schema/spelling.hpp"
#include "library/device_to_feel.hpp"
#include "library/devices_verb.hpp"
#include "library/load_trace.hpp"

namespace wale::command {

// Each is defined in FOLDER/command/VERB.cpp.
extern const Verb build_verb, check_verb, compare_verb, describe_verb, explain_verb, find_verb, format_verb,
    levels_verb, preview_verb;

}  // namespace wale::command

namespace {

using namespace wale;
using namespace wale::command;

constexpr const Verb* verbs[] = {&check_verb, &explain_verb, &format_verb, &build_verb,  &describe_verb,
                                 &find_verb,  &compare_verb, &levels_verb, &preview_verb};

std::atomic<bool> interrupted{false};

int sample(const Choice& choice, const std::vector<std::string>& settings, const std::string& at,
           const std::string& trace_file, const std::string& out, bool json) {
  const auto programs = command::load_programs(choice, false);
  if (programs.empty()) return refused;
  const auto parameters = command::chosen_parameters(programs.front(), settings);
  if (!parameters) return refused;
  std::vector<SampledHand> hands;
  if (!trace_file.empty()) {
    const auto trace = load_trace(trace_file);
    if (const auto* refusal = std::get_if<Refusal>(&trace)) return refuse(refusal->reason);
    for (const auto& point : std::get<Trace>(trace).points)
      hands.push_back({point.time, {glm::vec2(point.position), glm::vec2(point.velocity)}});
  } else {
    const auto hand = read_hand(declared_everywhere()->declarations, "--at", at);
    if (!hand) return refuse(hand.error());
    hands.push_back({0, *hand});
  }
  const Bank bank(programs.front(), *parameters, programs.front().default_size());
  const bool vibrates = programs.front().description().vibrates();
  const std::string text =
      json ? samples_json(sample(bank, hands), vibrates) : samples_csv(sample(bank, hands), vibrates);
  if (const auto problem = command::write_file(out, text)) return refuse(*problem);
  return 0;
}

/// Ctrl-C ends a run, and a question too, since reading is not taken up again.
void stop_on_signals() {
  struct sigaction action {};
  action.sa_handler = [](int) { interrupted = true; };
  sigaction(SIGINT, &action, nullptr);
  sigaction(SIGTERM, &action, nullptr);
}

void say(const std::string& what) { fmt::print(stderr, "wale: {}\n", what); }

/// What `feel` runs on.
command::FeltOn felt_on(const FeelOptions& options, const DeviceToFeel& device) {
  const ChosenDevice& chosen = device.chosen;
  return {.is_felt = !chosen.plugged || chosen.plugged->kind != "pointer",
          .built =
              [&](Choice choice) {
                if (!chosen.profile.empty()) choice.device = chosen.profile;
                return choice;
              },
          .open = [&](const PatchProgram& program) -> std::unique_ptr<Device> {
            auto opened = open_to_feel(device, program, say, interrupted);
            if (const auto* refusal = std::get_if<Refusal>(&opened)) refuse(refusal->reason);
            auto* joystick = std::get_if<std::unique_ptr<Device>>(&opened);
            return joystick != nullptr ? std::move(*joystick) : nullptr;
          },
          .manner =
              [&](const Device& opened) {
                if (const auto* plugged = dynamic_cast<const HotPluggedDevice*>(&opened))
                  return RunManner{in_words(*chosen.plugged), "yours", false, plugged->report()};
                return RunManner{"simulated", device.hand, options.virtual_time, std::nullopt};
              }};
}

/// Runs until it is over, or the person ends it.
int feel(const FeelOptions& options) {
  stop_on_signals();
  const auto device = device_to_feel({.file = options.choice.request(),
                                      .spelling = options.device,
                                      .built_for = options.built_for,
                                      .hand = options.hand,
                                      .virtual_time = options.virtual_time,
                                      .seconds = options.seconds},
                                     say, interrupted);
  if (const auto* refusal = std::get_if<Refusal>(&device)) return refuse(refusal->reason);
  const command::FeltOn on = felt_on(options, std::get<DeviceToFeel>(device));
  return options.blind ? command::feel_blind(options, on, interrupted) : command::feel(options, on, interrupted);
}

int identify(const std::string& device, const std::string& max_force) {
  stop_on_signals();
  return command::identify(device, max_force, interrupted);
}

constexpr const char* about =
    R"(Wale: a language for how things feel, and the runtime that makes a force-feedback joystick feel that way.

  designers    write a material, then:   wale check my.wale;  wale describe my.wale;  wale feel my.wale
  curators     find, compare and trust:  wale find ribbed;  wale compare A.wale B.wale;  wale levels roughness;
                                         wale describe --json FILE;  wale preview FILE -o OUT.png
  programmers  take a program along:     wale build FILE -o OUT.wpp;  wale sample FILE --at "10 mm, 5 mm"
                                         examples/roughness_by_name asks for a roughness by name from C++

Begin with library/fabric/corduroy.wale; schema/LANGUAGE.md is the language.)";

/// A misspelt verb, which CLI11 would take for a missing one; nothing where the first word is a verb or an option.
std::optional<std::string> misspelt_verb(const CLI::App& app, const std::string& first) {
  std::vector<std::string> verbs;
  for (const CLI::App* known : app.get_subcommands({})) verbs.push_back(known->get_name());
  if (first.starts_with('-') || std::ranges::find(verbs, first) != verbs.end()) return std::nullopt;
  const auto near = nearest_spelling(first, verbs);
  return fmt::format("there is no verb `{}`; {}", first,
                     near ? fmt::format("did you mean `{}`?", *near)
                          : fmt::format("the verbs are {}; `wale --help` says what they do", fmt::join(verbs, ", ")));
}

/// What is wrong with the words of a command, and where its options are listed.
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

  std::vector<std::string> settings;
  Choice choice;
  FeelOptions feeling;
  std::string out, at, trace;
  bool json = false;

  for (const Verb* each : verbs) {
    CLI::App* declared = app.add_subcommand(each->name, each->about);
    declared->callback([&status, run = each->declare(*declared)] { status = run(); });
  }

  auto* verb = app.add_subcommand("feel", "runs a material on a joystick and measures what comes out of its handle");
  offer_material(*verb, feeling.choice, "--built-for");
  offer_settings(*verb, feeling.settings);
  verb->add_option(
      "--device", feeling.device,
      "auto (default): the best one plugged in, else simulated; simulated; a name from `wale devices`: the "
      "real one; simulated:NAME; usb; 1209:ffb0; a port, 1-2. One that is not there is waited for");
  verb->add_option("--hand", feeling.hand,
                   "how the simulated hand moves: lateral (default), circular, rest, or a CSV trace of t, x, y");
  verb->add_option(
      "--seconds", feeling.seconds,
      "how long (default: 5; with --blind 3 for each of the two), and how long a device that is not plugged in is "
      "waited for at most (default: until Ctrl-C)");
  auto* virtual_time =
      verb->add_flag("--virtual-time", feeling.virtual_time, "as fast as possible, the same bit for bit each time");
  verb->add_option("--max-force", feeling.max_force, "the largest force allowed, as in \"3 N\"");
  auto* record = verb->add_option("--record", feeling.record,
                                  "records every tick: NAME.wrec as it happens, for `wale replay`; NAME.csv");
  auto* against = verb->add_option("--against", feeling.against, "another to tell it from: a file, or FILE:MATERIAL");
  auto* blind = verb->add_flag("--blind", feeling.blind,
                               "feels FILE (A) and the other (B) in random order and asks which of two was A")
                    ->needs(against)
                    ->excludes(record);
  against->needs(blind);
  verb->add_option("--trials", feeling.trials, "how often it asks (default: 12)")
      ->needs(blind)
      ->check(CLI::Range(1, 1000));
  verb->add_option("--seed", feeling.seed, "of the random order (default: another each time)")->needs(blind);
  verb->add_flag("--watch", feeling.watch,
                 "feels the file anew whenever it is saved; until Ctrl-C unless --seconds say so")
      ->excludes(blind)
      ->excludes(virtual_time);
  verb->add_flag("--json", feeling.json, "the report as a JSON object");
  verb->footer("for example: wale feel library/fabric/velvet.wale --against library/fabric/denim.wale --blind");
  verb->callback([&, built_for = verb->get_option("--built-for")] {
    if (built_for->count() > 0) feeling.built_for = feeling.choice.device;
    status = feel(feeling);
  });

  verb = app.add_subcommand("replay", "runs a recording's programs again on what its device told, and compares");
  command::ReplayOptions replaying;
  verb->add_option("FILE", replaying.file, "a recording that `wale feel --record` made (.wrec)")->required();
  verb->add_option("--csv", replaying.csv, "writes every tick to a CSV file");
  verb->add_option("--wav", replaying.wav,
                   "writes the force as sound: x left, y right, the device's peak force full scale");
  verb->add_option("--ticks", replaying.ticks, "only the first so many, of a damaged one those before the damage")
      ->type_name("N");
  verb->add_flag("--json", replaying.json, "as a JSON object");
  verb->footer("for example: wale replay corduroy.wrec --wav corduroy.wav");
  verb->callback([&] { status = command::replay(replaying); });

  verb = app.add_subcommand("sample", "the program's force at given hands, open loop; outside the patch it is zero");
  offer_material(*verb, choice);
  offer_settings(*verb, settings);
  auto* places = verb->add_option_group("hands", "where the hand is")->require_option(1);
  places->add_option("--at", at, "one hand from the patch's centre: \"10 mm, 5 mm[, 0.1 m/s, 0 m/s]\"");
  places->add_option("--trace", trace,
                     "a CSV file with t, x, y in s and m, and vx, vy in m/s if it has them; a line is a tick");
  verb->add_option("-o,--output", out, "where to write (default: standard output)");
  verb->add_flag("--json", json, "a JSON array instead of CSV");
  verb->footer("for example: wale sample library/fabric/corduroy.wale --at \"10 mm, 5 mm\"");
  verb->callback([&] { status = sample(choice, settings, at, trace, out.empty() ? "-" : out, json); });

  verb = app.add_subcommand("devices", "lists the joysticks that materials can be felt on and built for");
  auto* as_json = verb->add_flag("--json", json, "as a JSON array");
  std::string identified, gentle;
  auto* identifies = verb->add_option("--identify", identified,
                                      "pushes one gently, to find out how its axes and motors lie, and prints a "
                                      "declaration of it (default: the best one plugged in)")
                         ->expected(0, 1)
                         ->type_name("[DEVICE]")
                         ->excludes(as_json);
  verb->add_option("--max-force", gentle,
                   "the largest force of --identify, as in \"1 N\" (default, and at most: a fifth of its own)")
      ->needs(identifies);
  verb->footer("for example: wale devices --json; wale devices --identify > devices.wale");
  verb->callback(
      [&, identifies] { status = identifies->count() > 0 ? identify(identified, gentle) : command::devices(json); });

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
    return app.exit(error) == 0 ? 0 : misused;
  }
  return status;
}
