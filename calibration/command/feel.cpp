#include <fmt/format.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <atomic>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <initializer_list>
#include <iostream>
#include <memory>
#include <optional>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include "calibration/command/feel_run.hpp"
#include "calibration/command/interrupt.hpp"
#include "calibration/command/trusted_here.hpp"
#include "calibration/feel/asking_person.hpp"
#include "calibration/feel/background_loop.hpp"
#include "calibration/feel/felt_device.hpp"
#include "calibration/feel/material_watch.hpp"
#include "calibration/feel/rehearsal.hpp"
#include "compiler/command/options.hpp"
#include "compiler/command/print.hpp"
#include "compiler/declarations/declared_devices.hpp"
#include "compiler/modules/load_modules.hpp"
#include "compiler/solve/level_scale.hpp"
#include "compiler/text/readable.hpp"
#include "schema/built_for.hpp"
#include "schema/spelling.hpp"

namespace wale::command {
namespace {

/// Writes the table and the report of a finished run of so many versions of the file, the report also where the table
/// fails. Returns the exit status.
int report_run(const FeelOptions& options, const RunResult& result, const Bank& bank, FeltDevice felt,
               std::optional<OutputFile> table, long versions) {
  Result<> tabled;
  if (table) {
    write_csv(table->stream(), result.record);
    tabled = table->finish();
  }
  if (static_cast<std::size_t>(result.ticks_run) > result.record.ticks.size())
    say(readable("the last {:.4g} s are measured", measured_seconds));
  RunManner manner = felt.manner();
  manner.versions = versions;
  manner.most = options.max_force.value_or(HUGE_VAL);
  FeltReport report = felt_report(bank, result, bank.program().description().device, std::move(manner));
  tell_read_percepts(report, bank, common_modules()->declarations);
  felt.device.reset();  // the pointer restores the terminal
  print_out(options.json ? felt_json(report) : felt_text(report));
  if (!tabled) return refuse(tabled.error());
  return result.record_problem ? refuse(*result.record_problem) : done;
}

/// How long to run, s: as the person said, as usual, or as long as a simulated hand needs.
double seconds_of_run(const FeelOptions& options, const PreparedRun& prepared, const std::atomic<bool>& stop) {
  if (options.seconds || options.watch) return options.seconds.value_or(HUGE_VAL);
  if (prepared.device.chosen.plugged) return usual_seconds;
  const auto felt = open_prepared(options, prepared, stop);
  if (!felt) return usual_seconds;
  const double most_newton = options.max_force.value_or(HUGE_VAL);
  const double needed = seconds_needed(*felt, prepared.material, usual_seconds, most_newton, stop);
  if (needed > usual_seconds)
    say(fmt::format("the run takes {:.0f} s, so that the hand crosses the texture {} times", needed, least_crossings));
  return needed;
}

int feel_one(const FeelOptions& options, const std::atomic<bool>& stop) {
  const auto prepared_run = prepared(options, stop);
  if (!prepared_run) return prepared_run.status();
  const Choice& built = prepared_run->built;
  const BlindMaterial& material = prepared_run->material;
  const PatchProgram& program = material.program.description();
  auto table = table_of(options);
  if (!table) return refuse(table.error());
  auto felt = open_prepared(options, *prepared_run, stop);
  if (!felt) return felt.status();
  Stage stage(*felt->device, stage_options(options, felt->manner()));
  Result<Patch> added = stage.add(material.program);
  if (!added) return refuse(added.error());
  Patch patch = *added;
  for (std::size_t i = 0; i < material.parameters.size(); ++i)
    if (const auto set = patch.set(program.parameters[i].name, material.parameters[i]); !set)
      return refuse(set.error());

  const bool live = isatty(fileno(stderr));
  RunOptions run = run_options(options, stop);
  run.seconds = seconds_of_run(options, *prepared_run, stop);
  if (live)
    run.progress = [vibrates = program.vibrates()](const Now& now) {
      print_as_is(stderr, "\r" + progress_line(now, vibrates));
    };
  MaterialWatch watch(built, patch, material.program, options.settings,
                      [live](const std::string& said) { print_as_is(stderr, (live ? "\r\033[K" : "") + said); });
  std::optional<BackgroundLoop> watching;
  if (options.watch) watching.emplace([&] { watch.attend(std::chrono::milliseconds(100)); }, ask_to_stop);
  const auto result = stage.run(run);
  if (watching) watching->finish();
  if (live) print_as_is(stderr, "\r\033[K");
  if (!result) {
    Error error = result.error();
    if (error.place.name == "seconds") error.place.name = "--seconds";
    return refuse(error);
  }
  return report_run(options, *result, *patch.bank(), *std::move(felt), *std::move(table), watch.versions());
}

/// Checks that two materials can be compared blindly on this device. Errors: W0607, W0608; W0801 if they are the same.
Result<> can_be_blind(const PreparedRun& run, const BlindMaterial& b) {
  const BlindMaterial& a = run.material;
  if (a.parameters == b.parameters &&
      write_patch_program(a.program.description()) == write_patch_program(b.program.description()))
    return Error{Code::malformed_value,
                 fmt::format("expected another material than A, found `{}` again", b.program.description().material),
                 "name another one, or give a parameter of A another value with --set",
                 {.name = "--against"}};
  const DeviceProfile& device = run.material.program.description().device;
  const std::string& other = b.program.description().device.name;
  if (other != device.name)
    return Error{Code::other_device, fmt::format("A is built for `{}` and B for `{}`", device.name, other),
                 "build both for one device"};
  if (auto built = is_built_for(b.program.description(), device); !built) return built;
  if (device.shaker)
    return Error{Code::other_device,
                 fmt::format("`{}` only vibrates, but a blind comparison needs forces", device.name),
                 "choose a joystick"};
  const auto& plugged = run.device.chosen.plugged;
  if (plugged && !plugged->driver->is_felt)
    return Error{Code::other_device, fmt::format("the {} only shows forces", device.name),
                 "choose a joystick, or `--device simulated`"};
  return {};
}

/// Runs a blind comparison and reports it. Returns the exit status.
int feel_blind(const FeelOptions& options, const std::atomic<bool>& stop) {
  const auto run = prepared(options, stop);
  if (!run) return run.status();
  Choice against = run->built;
  const NamedMaterial named = named_material(options.against);
  against.file = named.file, against.material = named.material;
  const BlindMaterial& a = run->material;
  against.device_option.clear(), against.material_option.clear();  // they were named for A
  against.file_option = "--against";
  if (!named.material.empty()) against.material_option = "--against";
  const auto programs = load_programs(against, false);
  if (!programs) return programs.status();
  const auto b = material_to_feel(programs->front(), {});
  if (!b) return refuse(b.error());
  if (const auto able = can_be_blind(*run, *b); !able) return refuse(able.error());
  auto felt = open_prepared(options, *run, stop);
  if (!felt) return felt.status();

  const std::shared_ptr<const CommonModules> common = declared_everywhere();
  const auto cues = [&](const BlindMaterial& material) {
    return cues_of(Bank(material.program, material.parameters, material.program.default_size()), common->declarations);
  };
  BlindOptions blind;
  if (options.trials) blind.trials = static_cast<int>(*options.trials);
  blind.seed = options.seed ? *options.seed : std::random_device{}();
  blind.seconds = options.seconds.value_or(blind.seconds);
  blind.most_newton = options.max_force.value_or(HUGE_VAL);
  blind.virtual_time = options.virtual_time;
  blind.stop = &stop;
  const std::string& device = a.program.description().device.name;
  BlindReport report{.a = a.program.description().material,
                     .b = b->program.description().material,
                     .device = device,
                     .seed = blind.seed,
                     .asked = blind.trials,
                     .session = {},
                     .predicted = Comparer(common->declarations, device).compare(cues(a), cues(*b))};
  AskingPerson person(std::cin, std::cerr, report.a, report.b, blind.trials, isatty(fileno(stdin)));
  report.session = wale::feel_blind(*felt->device, a, *b, blind, person);
  if (report.session.trials.empty()) {
    Error error = *report.session.ended;
    error.sentence = "no trial was answered: " + error.sentence;
    return refuse(error);
  }
  print_out(options.json ? blind_json(report) : blind_text(report));
  return done;
}

int feel(const FeelOptions& options) {
  const std::string& record = options.record;
  if (!record.empty() && !has_ending(record, ".wrec") && !has_ending(record, ".csv") && !is_written_as_it_comes(record))
    return refuse(Error{Code::malformed_value,
                        fmt::format("expected a file NAME.wrec or NAME.csv, found `{}`", record),
                        "NAME.wrec is a recording for `wale replay`, NAME.csv a table",
                        {.name = "--record"}});
  if (options.virtual_time && options.seconds && std::isinf(*options.seconds))
    return refuse(Error{Code::malformed_value,
                        "a run in virtual time needs an end, found \"inf\"",
                        "give its length, as in `--seconds \"5 s\"`, or leave out --virtual-time",
                        {.name = "--seconds"}});
  const std::atomic<bool>& stop = stop_on_signals();
  return status_after_signals(options.blind && !is_workspace_file(options)               ? feel_blind(options, stop)
                              : is_workspace_file(options) || !options.workspace.empty() ? feel_workspace(options, stop)
                                                                                         : feel_one(options, stop));
}

void offer_blind(CLI::App& verb, FeelOptions& options, CLI::Option* record) {
  auto* against = verb.add_option("--against", options.against,
                                  "the other material (B), as in denim: a file, FILE:MATERIAL, or a material by name; "
                                  "--set is for A only")
                      ->type_name("FILE");
  auto* blind = verb.add_flag("--blind", options.blind,
                              "a test of whether you can tell FILE (A) from the other (B): you feel both in random "
                              "order, and say which was A")
                    ->needs(against)
                    ->excludes(record);
  against->needs(blind);
  offer_count(verb, "--trials", options.trials, {.least = 1, .most = 1000},
              "how many answers --blind asks for, 1 to 1000 (default: 12)")
      ->needs(blind);
  offer_count(verb, "--seed", options.seed, {},
              "repeats the random order of an earlier --blind, whose report names its "
              "seed (default: a new order each time)")
      ->needs(blind);
}

Run declare_feel(CLI::App& verb) {
  const auto options = std::make_shared<FeelOptions>();
  offer_material(
      verb, options->choice,
      {.device_option = "--built-for",
       .about_device = "the device to build a Wale file for, as in falcon: it is felt on that one alone, or on a "
                       "simulation of it (default: the one that it is felt on; sandpaper where that is a simulation "
                       "without a name)"});
  offer_settings(verb, options->settings);
  auto* workspace = must_say(verb.add_option("--workspace", options->workspace,
                                             "a workspace of the file, with all its patches, instead of a material")
                                 ->type_name("NAME"),
                             "the name of a workspace")
                        ->excludes("--material")
                        ->excludes("--set");
  verb.add_option(
          "--device", options->device,
          "where to feel it: auto (default), the best joystick plugged in, else a simulated one; simulated; "
          "simulated:falcon; a device of `wale devices`, of --devices or of the file itself; usb, the best on USB; "
          "vendor and product, as in 1209:ffb0; a port, as in 1-2. A real device that is not plugged in is waited for; "
          "with --virtual-time or --hand, a name means its simulation")
      ->type_name("NAME");
  offer_trusted_files(verb, options->trusted);
  offer_name(verb, "--transport", options->transport, transport_names(),
             "the way to drive a real device, if it has several (default: the first that works; see `wale devices`)");
  propose(
      verb.add_option(
              "--hand", options->hand,
              "how the hand on a simulated device moves: lateral (default), to and fro; circular; press, in and out; "
              "rest; then along x, y or an angle, and at a place, as in \"lateral along 30 deg at 20 mm, 5 mm\"; or "
              "a CSV file with columns t (s), x (m), y (m)")
          ->type_name("HAND"),
      {"lateral", "circular", "press", "rest"}, true);
  offer_duration(
      verb, "--seconds", options->seconds, {.endless = true},
      "how long to feel, as in 10, \"10 s\", \"2 min\" or inf (default: 5 s, or up to a minute where a simulated hand "
      "needs it to cross the texture 50 times; with --watch until Ctrl-C; with --blind 3 s for each of the two); also "
      "the longest wait for a device to be plugged in (default: until "
      "Ctrl-C)");
  auto* virtual_time =
      verb.add_flag("--virtual-time", options->virtual_time,
                    "simulates the device as fast as the computer can, with exactly the same result each time");
  offer_force(
      verb, "--max-force", options->max_force,
      "the largest force at the handle, as in \"3 N\" (default: the device's own); every packet to a real device "
      "keeps within it");
  auto* record =
      verb.add_option("--record", options->record,
                      "records every tick: to NAME.wrec while it runs, for `wale replay`, which never replaces an "
                      "existing file; to NAME.csv, a table, at the end, which replaces one (default: no "
                      "recording)")
          ->type_name("FILE");
  offer_blind(verb, *options, record);
  workspace->excludes("--blind")->excludes("--against");
  verb.add_flag("--watch", options->watch,
                "puts each saved version of the file in your hand at once; until Ctrl-C, or for --seconds")
      ->excludes("--blind")
      ->excludes(workspace)
      ->excludes(virtual_time);
  virtual_time->excludes("--blind");  // nobody feels it
  offer_json(verb, options->json, "the report as a JSON object");
  verb.footer(
      "FILE may also be a workspace file, NAME.wws, of `wale build --workspace`;  for example: wale feel velvet "
      "--against denim --blind");
  return [options] {
    if (!options->choice.device_option.empty()) options->built_for = options->choice.device;
    return feel(*options);
  };
}

}  // namespace

extern const Verb feel_verb{"feel", "runs a material on a joystick and measures what comes out of its handle",
                            declare_feel};

}  // namespace wale::command