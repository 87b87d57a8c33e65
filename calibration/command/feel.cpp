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

#include "calibration/command/devices_here.hpp"
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
#include "runtime/device/built_for.hpp"
#include "schema/spelling.hpp"

namespace wale::command {
namespace {

constexpr double usual_seconds = 5;
/// s; of a watched or recorded run, which may be long, only the last part is measured.
constexpr double measured_seconds = 600;

struct FeelOptions {
  Choice choice;
  std::vector<std::string> settings;
  std::vector<std::string> trusted;  ///< files whose declarations may scale a real device
  std::string device;                ///< empty: `auto`
  std::string built_for;             ///< empty: the device that is felt on
  std::optional<std::string> hand;   ///< how a simulated person moves
  std::string transport;             ///< of a real device; empty: its driver chooses
  std::string record;
  std::optional<double> seconds, max_force;
  bool virtual_time = false, json = false, watch = false;
  std::string against;
  bool blind = false;
  std::optional<std::uint64_t> trials, seed;
};

void say(const std::string& what) { print_error("wale: {}\n", what); }

/// A material to feel, with its parameters as set.
Result<BlindMaterial> material_to_feel(const Program& program, const std::vector<std::string>& settings) {
  auto parameters = chosen_parameters(program, settings);
  if (!parameters) return parameters.error();
  return BlindMaterial{program, *std::move(parameters)};
}

/// A material, and the device that it is built for and felt on.
struct PreparedRun {
  DeviceToFeel device;
  Choice built;  ///< of the material, with that device
  BlindMaterial material;
};

/// Checks that `name`, if it is not empty, is a device to build for. Error: W0601.
Result<> can_be_built_for(const std::string& name, const std::vector<DeclaredDevice>& known) {
  std::vector<std::string> names;
  for (const DeclaredDevice& each : known) names.push_back(each.profile.name);
  if (name.empty() || std::ranges::find(names, name) != names.end()) return {};
  const auto near = nearest_spelling(name, names);
  return Error{Code::unknown_device,
               fmt::format("no device is called `{}`", name),
               near ? fmt::format("did you mean `{}`?", *near) : "`wale devices` lists them",
               {.name = "--built-for", .text = name}};
}

/// Checks that no file of `files` keeps a device to itself that an option names. Error: W0215.
Result<> are_exported(const FeelOptions& options, const std::vector<DeclaredDevice>& known,
                      const std::vector<DeviceFile>& files) {
  constexpr std::string_view prefix = "simulated:";
  const std::string asked = options.device.starts_with(prefix) ? options.device.substr(prefix.size()) : options.device;
  for (const auto& [option, name] : {std::pair{"--device", asked}, {"--built-for", options.built_for}}) {
    const auto is_named = [&name = name](const DeclaredDevice& each) { return each.profile.name == name; };
    if (std::ranges::any_of(known, is_named)) continue;
    if (auto hidden = private_device(name, files, option)) return *std::move(hidden);
  }
  return {};
}

/// An option that cannot apply to a run.
struct Inapplicable {
  const char* option;
  bool is_so;
  std::string why;  ///< it cannot apply
  const char* mend;
};

/// Checks that none of them is so. Error: W0801, which means wrong usage.
Result<> all_apply(std::initializer_list<Inapplicable> options) {
  for (const auto& [option, is_so, why, mend] : options)
    if (is_so) return Error{Code::malformed_value, why, mend, {.name = option}};
  return {};
}

/// Checks that options about the file apply to it.
Result<> apply_to_file(const FeelOptions& options, const OpenedFile& opened) {
  return all_apply({{"--watch", options.watch && !opened.is_on_disk,
                     fmt::format("expected a file on disk, found `{}`, which is only inside wale", opened.name),
                     "leave out --watch, or save the material in a file of your own"}});
}

/// Checks that options about the device apply to the chosen one.
Result<> apply_to_device(const FeelOptions& options, const ChosenDevice& chosen) {
  return all_apply(
      {{"--transport", !options.transport.empty() && !chosen.plugged, "expected a real device, found a simulated one",
        "leave out --transport, or name a real device with --device"}});
}

/// Checks that options about forces and hands apply to the program.
Result<> apply_to_program(const FeelOptions& options, const PatchProgram& program) {
  return all_apply(
      {{"--max-force", options.max_force && program.vibrates(),
        fmt::format("`{}` only vibrates: it has no force to limit", program.device.name), "leave out --max-force"},
       {"--hand", options.hand && !program.device.has_position(),
        fmt::format("`{}` does not measure the hand's position, so no hand moves on it", program.device.name),
        "leave out --hand"}});
}

/// Whether a person asks for a device that may be a real one, and names it.
bool may_name_a_real_device(const FeelOptions& options) {
  if (options.virtual_time || options.hand || options.device.empty() || options.device == "auto") return false;
  if (options.device.starts_with("simulated")) return false;
  const DeviceDeclaration* shipped = common_modules()->declarations.devices.find(options.device);
  return shipped == nullptr || !shipped->wiring.usb.empty() || shipped->wiring.is_generic;
}

/// What this person trusts. An error in the owner's own file is only warned of where the run may do without it.
Result<TrustedDeclarations> trusted_for(const FeelOptions& options) {
  auto trusted = trusted_here(options.trusted);
  if (!trusted) return trusted;
  if (trusted->owners_problem && may_name_a_real_device(options)) return *std::move(trusted->owners_problem);
  warn_of_unused(*trusted);
  return trusted;
}

/// The devices that a file knows.
struct KnownDevices {
  std::vector<DeclaredDevice> devices;
  std::string only_in_program;  ///< the one among them that only the patch program brings; may be empty
};

KnownDevices known_to(const OpenedFile& opened, const Choice& choice) {
  if (opened.module) return {declared_devices(opened.module->declarations()), {}};
  KnownDevices known{devices_here(choice.folders, choice.devices), {}};
  const DeviceProfile& own = opened.program->description().device;
  const auto is_own = [&](const DeclaredDevice& each) { return each.profile.name == own.name; };
  if (std::ranges::any_of(known.devices, is_own)) return known;
  known.devices.push_back({.profile = own});
  known.only_in_program = own.name;
  return known;
}

/// Opens and checks the file, chooses the device among those that the file knows, and compiles the material for it.
OrStatus<PreparedRun> prepared(const FeelOptions& options, const std::atomic<bool>& stop) {
  const auto trusted = trusted_for(options);
  if (!trusted) return refuse(trusted.error());
  Choice built = options.choice;
  built.device.clear(), built.device_option.clear();           // it is not known yet
  built.devices = trusted->files, built.knows_owners = false;  // they are among these
  built.shares_options = !options.against.empty();
  auto opened = open(built);
  if (!opened) return opened.status();
  if (const auto fit = apply_to_file(options, *opened); !fit) return refuse(fit.error());
  if (const auto same = is_as_named(*opened, {}, options.choice); !same) return refuse(same.error());
  if (options.hand) options.choice.inputs->push_back(*options.hand);
  const auto [known, only_in_program] = known_to(*opened, built);
  if (const auto exported = are_exported(options, known, trusted->checked); !exported) return refuse(exported.error());
  if (const auto is_known = can_be_built_for(options.built_for, known); !is_known) return refuse(is_known.error());
  const bool asks = !options.device.empty();
  auto device =
      device_to_feel({.spelling = asks ? options.device : "auto",
                      .built_for = opened->program ? opened->program->description().device.name : options.built_for,
                      .transport = options.transport,
                      .only_simulated = options.virtual_time || options.hand,
                      .only_in_program = only_in_program},
                     known, trusted->devices, options.seconds, say, stop);
  if (!device) return refuse(device.error());
  const ChosenDevice& chosen = device->chosen;
  if (trusted->owners_problem && chosen.plugged) return refuse(*trusted->owners_problem);
  if (const auto fit = apply_to_device(options, chosen); !fit) return refuse(fit.error());
  if (!chosen.said.empty() && (asks || chosen.is_worth_saying)) say(chosen.said);

  built.device = chosen.declared ? chosen.declared->profile.name : options.choice.device;
  if (opened->module) check_levels(opened->module->declarations(), opened->source, built.device, opened->diagnostics);
  const auto programs = programs_of(*opened, built, false);
  if (!programs) return programs.status();
  if (const auto fit = apply_to_program(options, programs->front().description()); !fit) return refuse(fit.error());
  auto material = material_to_feel(programs->front(), options.settings);
  if (!material) return refuse(material.error());
  return PreparedRun{*std::move(device), std::move(built), *std::move(material)};
}

OrStatus<FeltDevice> open_prepared(const FeelOptions& options, const PreparedRun& run, const std::atomic<bool>& stop) {
  const HandDeclaration* person = declared_everywhere()->declarations.hands.find("normal");
  FeltOptions how{.virtual_time = options.virtual_time,
                  .transport = options.transport,
                  .most_newton = options.max_force.value_or(HUGE_VAL)};
  if (options.hand) how.hand = *options.hand;
  auto device = open_to_feel(run.device, run.material.program.description(), *person, how, say, stop);
  if (!device) return refuse(device.error());
  return *std::move(device);
}

/// The recording to make of the run, if the person asked for one.
std::optional<RecordTo> recording_of(const FeelOptions& options, const RunManner& manner) {
  if (!has_ending(options.record, ".wrec")) return std::nullopt;
  return RecordTo{options.record, fmt::format("{}, {}", manner.device, manner.hand)};
}

/// How the stage runs, and what it records.
StageOptions stage_options(const FeelOptions& options, const RunManner& manner) {
  StageOptions how = felt_stage_options(options.max_force.value_or(HUGE_VAL));
  how.record = recording_of(options, manner);
  return how;
}

RunOptions run_options(const FeelOptions& options, const std::atomic<bool>& stop) {
  const bool is_recording = has_ending(options.record, ".wrec"), is_table = !options.record.empty() && !is_recording;
  return {.seconds = options.seconds.value_or(usual_seconds),
          .virtual_time = options.virtual_time,
          .stop = &stop,
          .kept_seconds = !is_table && (is_recording || options.watch) ? measured_seconds : HUGE_VAL};
}

/// Opens the table of a run before it, so that no run is lost to a table that cannot be written. Nothing if the person
/// asked for none.
Result<std::optional<OutputFile>> table_of(const FeelOptions& options) {
  std::optional<OutputFile> table;
  if (options.record.empty() || has_ending(options.record, ".wrec")) return table;
  auto opened = OutputFile::open(options.record, *options.choice.inputs);
  if (!opened) return opened.error();
  table = *std::move(opened);
  return table;
}

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
  const auto& [device, built, material] = *prepared_run;
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
  return status_after_signals(options.blind ? feel_blind(options, stop) : feel_one(options, stop));
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
  verb.add_option(
          "--hand", options->hand,
          "how the hand on a simulated device moves: lateral (default), to and fro; circular; press, in and out; "
          "rest; then along x, y or an angle, and at a place, as in \"lateral along 30 deg at 20 mm, 5 mm\"; or "
          "a CSV file with columns t (s), x (m), y (m)")
      ->type_name("HAND");
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
  verb.add_flag("--watch", options->watch,
                "puts each saved version of the file in your hand at once; until Ctrl-C, or for --seconds")
      ->excludes("--blind")
      ->excludes(virtual_time);
  virtual_time->excludes("--blind");  // nobody feels it
  offer_json(verb, options->json, "the report as a JSON object");
  verb.footer("for example: wale feel velvet --against denim --blind");
  return [options] {
    if (!options->choice.device_option.empty()) options->built_for = options->choice.device;
    return feel(*options);
  };
}

}  // namespace

extern const Verb feel_verb{"feel", "runs a material on a joystick and measures what comes out of its handle",
                            declare_feel};

}  // namespace wale::command
