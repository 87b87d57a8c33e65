#include "calibration/feel/feel.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <cmath>
#include <cstdio>
#include <iostream>
#include <random>
#include <sstream>
#include <thread>

#include "calibration/feel/asking_person.hpp"
#include "calibration/feel/material_watch.hpp"
#include "compiler/modules/load_modules.hpp"
#include "compiler/quantity.hpp"

namespace wale::command {
namespace {

constexpr double usual_seconds = 5;
/// Of a run that is watched or recorded, and so may be as long as one likes: that much of its end is measured.
constexpr double measured_seconds = 600;

/// A material to feel, with its parameters as set.
std::optional<BlindMaterial> material_to_feel(const Choice& choice, const std::vector<std::string>& settings) {
  const auto programs = load_programs(choice, false);
  if (programs.empty()) return std::nullopt;
  auto parameters = chosen_parameters(programs.front(), settings);
  if (!parameters) return std::nullopt;
  return BlindMaterial{programs.front(), *std::move(parameters)};
}

/// The largest force that the user allows, N; nothing when what is wrong has been printed.
std::optional<double> most_allowed(const FeelOptions& options, const PatchProgram& program) {
  if (options.max_force.empty()) return HUGE_VAL;
  if (program.vibrates()) {
    refuse(fmt::format("`{}` only vibrates: it has no force to limit", program.device.name));
    return std::nullopt;
  }
  QuantityReader reader;
  const auto most = reader.force("--max-force", options.max_force);
  if (!most) print_diagnostics(stderr, reader.diagnostics(), reader.sources());
  return most;
}

/// How the run is recorded as it happens, if it is.
std::optional<RecordTo> recording_of(const FeelOptions& options, const RunManner& manner) {
  if (!options.record.ends_with(".wrec")) return std::nullopt;
  return RecordTo{options.record, fmt::format("{}, {}", manner.device, manner.hand)};
}

/// Keeps the stage to what the file says until the run is over.
class Watching {
 public:
  Watching(const FeelOptions& options, const Choice& built, Stage& stage, const Program& felt, bool live)
      : watch_(built, stage, felt,
               [live](const std::string& said) { fmt::print(stderr, "{}{}", live ? "\r\033[K" : "", said); }) {
    if (!options.watch) return;
    thread_ = std::thread([this] {
      while (!over_) watch_.attend(std::chrono::milliseconds(100));
    });
  }
  ~Watching() {
    over_ = true;
    if (thread_.joinable()) thread_.join();
  }

 private:
  MaterialWatch watch_;
  std::atomic<bool> over_ = false;
  std::thread thread_;
};

}  // namespace

int feel(const FeelOptions& options, const FeltOn& on, const std::atomic<bool>& stop) {
  if (!options.record.empty() && options.record != "-" && !options.record.ends_with(".wrec") &&
      !options.record.ends_with(".csv"))
    return refuse(fmt::format("`{}` is neither a recording, NAME.wrec, nor a table, NAME.csv", options.record));
  const Choice built = on.built(options.choice);
  const auto material = material_to_feel(built, options.settings);
  if (!material) return refused;
  const PatchProgram& program = material->program.description();
  auto device = on.open(program);
  if (!device) return refused;
  Stage stage(*device);
  stage.place(material->program);
  for (std::size_t i = 0; i < material->parameters.size(); ++i)
    if (const auto set = stage.set(program.parameters[i].name, material->parameters[i]); !set)
      return refuse(in_words(set.error()));
  const auto most_newton = most_allowed(options, program);
  if (!most_newton) return refused;

  const bool live = isatty(fileno(stderr)), is_recording = options.record.ends_with(".wrec"),
             is_table = !options.record.empty() && !is_recording;
  RunOptions run{.seconds = options.seconds.value_or(options.watch ? HUGE_VAL : usual_seconds),
                 .most_newton = *most_newton,
                 .virtual_time = options.virtual_time,
                 .stop = &stop,
                 .record_to = recording_of(options, on.manner(*device)),
                 .kept_seconds = !is_table && (is_recording || options.watch) ? measured_seconds : HUGE_VAL};
  if (live)
    run.progress = [vibrates = program.vibrates()](const Progress& now) {
      fmt::print(stderr, "\r{}", progress_line(now, vibrates));
    };
  const auto result = [&] {
    const Watching watching(options, built, stage, material->program, live);
    return stage.run(run);
  }();
  if (live) fmt::print(stderr, "\r\033[K");
  if (!result) return refuse(in_words(result.error()));

  const auto& done = *result;
  if (is_table) {
    std::ostringstream csv;
    write_csv(csv, done.record);
    if (const auto problem = write_file(options.record, csv.str())) return refuse(*problem);
  }
  if (static_cast<std::size_t>(done.ticks_run) > done.record.ticks.size())
    fmt::print(stderr, "wale: measured are the last {:.4g} s\n", measured_seconds);
  const FeltReport report = felt_report(*stage.bank(), done, program.device, on.manner(*device));
  device.reset();  // one that draws gives the terminal back
  fmt::print("{}", options.json ? felt_json(report) : felt_text(report));
  return done.record_problem ? refuse(in_words(*done.record_problem)) : command::done;
}

int feel_blind(const FeelOptions& options, const FeltOn& on, const std::atomic<bool>& stop) {
  Choice against = options.choice;
  const NamedMaterial named = named_material(options.against);
  against.file = named.file, against.material = named.material;
  const auto a = material_to_feel(on.built(options.choice), options.settings),
             b = material_to_feel(on.built(against), {});
  if (!a || !b) return refused;
  const DeviceProfile& device = a->program.description().device;
  if (b->program.description().device.name != device.name)
    return refuse(fmt::format("A is built for `{}` and B for `{}`: both are felt on one device", device.name,
                              b->program.description().device.name));
  if (device.shaker) return refuse(fmt::format("`{}` only vibrates: what is compared blindly are forces", device.name));
  if (!on.is_felt) return refuse(fmt::format("nothing is felt on the {}, so there is nothing to compare", device.name));
  const auto most_newton = most_allowed(options, a->program.description());
  if (!most_newton) return refused;
  const auto joystick = on.open(a->program.description());
  if (!joystick) return refused;

  const std::shared_ptr<const CommonModules> common = declared_everywhere();
  const auto cues = [&](const BlindMaterial& material) {
    return cues_of(Bank(material.program, material.parameters, material.program.default_size()), common->declarations);
  };
  BlindReport report{.a = a->program.description().material,
                     .b = b->program.description().material,
                     .device = device.name,
                     .seed = options.seed ? *options.seed : std::random_device{}(),
                     .asked = options.trials,
                     .session = {},
                     .predicted = Comparer(common->declarations, device.name).compare(cues(*a), cues(*b))};
  BlindOptions blind{.trials = options.trials,
                     .seed = report.seed,
                     .most_newton = *most_newton,
                     .virtual_time = options.virtual_time,
                     .stop = &stop};
  blind.seconds = options.seconds.value_or(blind.seconds);
  AskingPerson person(std::cin, std::cerr, report.a, report.b, options.trials, isatty(fileno(stdin)));
  report.session = wale::feel_blind(*joystick, *a, *b, blind, person);
  if (report.session.trials.empty()) return refuse(fmt::format("no trial was answered: {}", report.session.ended));
  fmt::print("{}", options.json ? blind_json(report) : blind_text(report));
  return done;
}

}  // namespace wale::command
