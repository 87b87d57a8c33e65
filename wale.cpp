// The command line: a table of verbs, each a few calls into the folders.

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <atomic>
#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <memory>
#include <optional>
#include <sstream>
#include <string>
#include <vector>

#include "calibration/felt_report.hpp"
#include "compiler/build_all.hpp"
#include "compiler/build_stage.hpp"
#include "compiler/check_files.hpp"
#include "compiler/compare/compare.hpp"
#include "compiler/compile.hpp"
#include "compiler/describe/describe.hpp"
#include "compiler/describe/describe_module.hpp"
#include "compiler/describe/fates.hpp"
#include "compiler/diagnostics/apply_fixes.hpp"
#include "compiler/diagnostics/explain.hpp"
#include "compiler/diagnostics/render.hpp"
#include "compiler/format/format.hpp"
#include "compiler/image/image_library.hpp"
#include "compiler/measure/sample.hpp"
#include "compiler/modules/library_folders.hpp"
#include "compiler/modules/load_modules.hpp"
#include "compiler/open_file.hpp"
#include "compiler/preview/preview.hpp"
#include "compiler/quantity.hpp"
#include "compiler/text/replace_file.hpp"
#include "compiler/text/spelling.hpp"
#include "library/device_report.hpp"
#include "wale/felt.hpp"
#include "wale/library.hpp"
#include "wale/simulated_pad.hpp"
#include "wale/stage.hpp"

namespace {

using namespace wale;

/// What was asked cannot be done: already said why.
constexpr int refused = 1;
/// The words of the command make no sense.
constexpr int misused = 2;

std::atomic<bool> interrupted{false};

int refuse(const std::string& reason) {
  fmt::print(stderr, "wale: {}{}", reason, reason.ends_with('\n') ? "" : "\n");
  return refused;
}

/// Carets in colour where a person reads them.
bool colour(FILE* stream) { return isatty(fileno(stream)) && !std::getenv("NO_COLOR"); }

void print_diagnostics(FILE* stream, const Diagnostics& diagnostics, const SourceSet& sources) {
  for (const auto& diagnostic : diagnostics.all())
    fmt::print(stream, "{}\n", render_text(diagnostic, sources, colour(stream)));
}

/// Writes a whole file or says why not; "-" is standard output.
std::optional<std::string> write_file(const std::string& path, std::string_view bytes) {
  if (path == "-") {
    std::cout.write(bytes.data(), static_cast<std::streamsize>(bytes.size())).flush();
    return std::cout ? std::nullopt : std::optional<std::string>("cannot write to standard output");
  }
  std::ofstream file(path, std::ios::binary);
  if (file) file.write(bytes.data(), static_cast<std::streamsize>(bytes.size())).flush();
  if (!file) return fmt::format("cannot write `{}`: {}", path, std::strerror(errno));
  return std::nullopt;
}

/// A material named on the command line: a Wale file to compile, or a patch program to load.
struct Choice {
  std::string file, material, device = default_device;
  std::vector<std::string> folders;

  void offer(CLI::App& verb, const char* device_option = "--device") {
    verb.add_option("FILE", file, "a Wale file, or a patch program (.wpp)")->required();
    verb.add_option("--material", material, "which material of the file (default: its first)");
    verb.add_option(device_option, device, "the device to build for (default: sandpaper; see `wale devices`)");
    offer_library(verb);
  }
  void offer_library(CLI::App& verb) {
    verb.add_option("--library", folders, "a folder to look for imports in, after the file's own; may be repeated")
        ->type_name("DIR")
        ->expected(1)
        ->take_all();
  }
  FileRequest request() const { return {file, device, library_folders(folders, std::getenv("WALE_LIBRARY"))}; }
};

/// Opens a file; nothing when it cannot be read or its text is wrong, which has been said.
std::optional<OpenedFile> open(const Choice& choice) {
  OpenedFile opened = open_file(choice.request());
  if (!opened.refusal.empty()) return refuse(opened.refusal), std::nullopt;
  if (!opened.diagnostics.has_errors()) return opened;
  print_diagnostics(stderr, opened.diagnostics, opened.sources);
  return std::nullopt;
}

/// The programs of an opened file: one, or all of its materials; what is wrong has been printed when there is none.
std::vector<Program> programs_of(OpenedFile& opened, const Choice& choice, bool all) {
  if (opened.program) return {*opened.program};
  std::vector<std::string> names{choice.material};
  if (all && choice.material.empty() && opened.module->materials.size() > 1) names = materials_of(opened);
  std::vector<Program> programs;
  for (const auto& name : names) {
    if (opened.diagnostics.has_errors()) break;
    if (auto program = compile_opened(opened, choice.request(), name, opened.diagnostics)) programs.push_back(*program);
  }
  print_diagnostics(stderr, opened.diagnostics, opened.sources);
  if (opened.diagnostics.has_errors()) programs.clear();
  return programs;
}

std::vector<Program> load_programs(const Choice& choice, bool all) {
  auto opened = open(choice);
  return opened ? programs_of(*opened, choice, all) : std::vector<Program>{};
}

/// The program's parameters with the `--set` options applied, or nothing, when what is wrong has been printed.
std::optional<std::vector<float>> chosen_parameters(const Program& program, const std::vector<std::string>& settings) {
  auto values = program.default_parameters();
  QuantityReader reader;
  for (const auto& setting : settings) {
    const auto equals = setting.find('=');
    const std::string name = setting.substr(0, equals);
    const auto index = program.parameter(name);
    if (equals == std::string::npos || !index) {
      std::string known;
      for (const auto& parameter : program.description().parameters)
        known += (known.empty() ? "" : ", ") + parameter.name;
      refuse(equals == std::string::npos
                 ? fmt::format("--set takes NAME=VALUE, not `{}`", setting)
                 : fmt::format("`{}` has no parameter `{}`; it has: {}", program.description().material, name,
                               known.empty() ? "none" : known));
      return std::nullopt;
    }
    const auto value =
        reader.parameter("--set " + name, program.description().parameters[*index], setting.substr(equals + 1));
    if (!value) {
      print_diagnostics(stderr, reader.diagnostics(), reader.sources());
      return std::nullopt;
    }
    values[*index] = *value;
  }
  print_diagnostics(stderr, reader.diagnostics(), reader.sources());  // warnings
  return values;
}

std::optional<Trace> load_trace(const std::string& path) {
  const auto read = read_file(path);
  if (const auto* problem = std::get_if<ResolveProblem>(&read)) {
    refuse(fmt::format("`{}` cannot be read: {}", path, problem->reason));
    return std::nullopt;
  }
  auto trace = read_trace(std::get<ResolvedFile>(read).bytes);
  if (const auto* error = std::get_if<TraceError>(&trace)) {
    refuse(fmt::format("{}:{}: expected {}, found {}", path, error->line, error->expected, error->found));
    return std::nullopt;
  }
  return std::get<Trace>(std::move(trace));
}

/// Mends files before they are checked, and says what was done on standard error, which leaves the output to the check.
bool mend(const std::vector<std::string>& files, const std::vector<std::string>& roots) {
  bool written = true;
  for (const auto& file : mend_files(files, roots)) {
    for (const auto& mend : file.mends)
      fmt::print(stderr, "mended {}:{}:{}: {}\n", file.file, mend.place.line, mend.place.column, mend.title);
    if (file.problem) refuse(fmt::format("cannot write `{}`: {}", file.file, *file.problem));
    written = written && !file.problem;
  }
  return written;
}

int check(const std::vector<std::string>& files, const std::vector<std::string>& folders, bool json, bool fix) {
  const auto roots = library_folders(folders, std::getenv("WALE_LIBRARY"));
  const bool mended = !fix || mend(files, roots);
  const auto [sources, diagnostics] = check_files(files, roots);
  if (json) {
    fmt::print("{}\n", render_json(diagnostics, sources));
  } else {
    print_diagnostics(stdout, diagnostics, sources);
    const std::size_t warnings = diagnostics.all().size() - diagnostics.error_count();
    const std::size_t mendable = safe_fixes(diagnostics.all()).size();
    const auto count = [](std::size_t n, const char* what) {
      return fmt::format("{} {}{}", n, what, n == 1 ? "" : "s");
    };
    fmt::print("{}: {}{}, {}{}\n", count(files.size(), "file"), count(diagnostics.error_count(), "error"),
               diagnostics.is_full() ? " and more that are not listed" : "", count(warnings, "warning"),
               mendable > 0 && !fix ? fmt::format("; `wale check --fix` mends {}", mendable) : "");
  }
  return diagnostics.has_errors() || !mended ? refused : 0;
}

int explain(const std::string& name) {
  if (name.empty()) {
    fmt::print("{}", codes_text());
    return 0;
  }
  const auto code = code_named(name);
  if (!code) return refuse(unknown_code_text(name));
  fmt::print("{}", explanation_text(*code));
  return 0;
}

/// "-" reads standard input and writes standard output. With `check_only` nothing is written but the names of the files
/// that formatting would change.
int format(const std::vector<std::string>& files, bool check_only) {
  int status = 0;
  for (const auto& file : files) {
    const bool standard = file == "-";
    auto read = read_file(standard ? "/dev/stdin" : file);
    if (const auto* problem = std::get_if<ResolveProblem>(&read)) {
      status = refuse(fmt::format("`{}` cannot be read: {}", file, problem->reason));
      continue;
    }
    SourceSet sources;
    Diagnostics diagnostics;
    const SourceId source = sources.add(file, std::move(std::get<ResolvedFile>(read).bytes));
    const auto formatted = format(sources, source, diagnostics);
    print_diagnostics(stderr, diagnostics, sources);
    const bool changes = formatted && *formatted != sources[source].text;
    if (!formatted || (check_only && changes)) status = refused;
    if (check_only && changes) fmt::print("{}\n", file);
    if (!formatted || check_only) continue;
    std::optional<std::string> problem;
    if (standard) problem = write_file("-", *formatted);
    if (!standard && changes) problem = replace_file(file, *formatted);
    if (problem) status = refuse(standard ? *problem : fmt::format("cannot write `{}`: {}", file, *problem));
  }
  return status;
}

int build(const Choice& choice, const std::string& out) {
  const auto programs = load_programs(choice, false);
  if (programs.empty()) return refused;
  const auto bytes = write_patch_program(programs.front().description());
  if (const auto problem = write_file(out, {reinterpret_cast<const char*>(bytes.data()), bytes.size()}))
    return refuse(*problem);
  return 0;
}

/// What a material is after one of the compiler's stages.
int show_stage(const Choice& choice, const std::string& name, const std::string& out) {
  const auto known = std::ranges::find(stage_names, name, &StageName::name);
  auto opened = open(choice);
  if (!opened) return refused;
  std::string refusal;
  const auto text = build_stage(*opened, choice.request(), choice.material, known->stage, opened->diagnostics, refusal);
  print_diagnostics(stderr, opened->diagnostics, opened->sources);
  if (!refusal.empty()) return refuse(refusal);
  if (!text) return refused;
  if (const auto problem = write_file(out, *text)) return refuse(*problem);
  return 0;
}

/// Every material of a file to a program of its own; says of each what became of it.
int build_collection(const Choice& choice, const std::string& folder) {
  const auto opened = open(choice);
  if (!opened) return refused;
  if (opened->program) return refuse("--all builds the materials of a Wale file, and this is a program already");
  print_diagnostics(stderr, opened->diagnostics, opened->sources);
  const BuiltCollection collection = build_all(*opened, choice.request(), folder);
  if (!collection.refusal.empty()) return refuse(collection.refusal);
  for (const auto& built : collection.materials) {
    print_diagnostics(stderr, built.diagnostics, opened->sources);
    if (!built.problem.empty()) refuse(built.problem);
    if (built.path.empty())
      refuse(fmt::format("`{}` is not built", built.material));
    else
      fmt::print("{}  {} bytes\n", built.path, built.bytes);
  }
  const std::size_t all = collection.materials.size(), built = collection.built();
  fmt::print("{} of {} material{} built\n", built, all, all == 1 ? "" : "s");
  return built == all ? 0 : refused;
}

/// What every device makes of a file's materials.
int describe_fates(const Choice& choice, bool json) {
  const auto opened = open(choice);
  if (!opened) return refused;
  if (opened->program) return refuse(fmt::format("`{}` is built for one device already", choice.file));
  const auto names = choice.material.empty() ? materials_of(*opened) : std::vector<std::string>{choice.material};
  std::vector<DeviceFates> all;
  for (const std::string& material : names)
    for (const DescribedDevice& device : Library().devices()) {
      FileRequest request = choice.request();
      request.device = device.profile.name;
      DeviceFates fates{.material = material, .device = request.device, .fates = {}, .refusal = {}};
      Diagnostics diagnostics;
      if (const auto program = compile_opened(*opened, request, material, diagnostics))
        fates.fates = program->description().fates;
      else
        for (const Diagnostic& each : diagnostics.all())
          if (fates.refusal.empty() && severity_of(each.code) == Severity::error) fates.refusal = each.message;
      all.push_back(std::move(fates));
    }
  if (all.empty()) return refuse("there is no material to describe");
  fmt::print("{}", json ? fates_json(all) : fates_text(all));
  return 0;
}

int describe(const Choice& choice, const std::vector<std::string>& settings, bool exports, bool json) {
  if (choice.device == "all") return describe_fates(choice, json);
  auto opened = open(choice);
  if (!opened) return refused;
  if (opened->module && choice.material.empty() && (exports || opened->module->materials.empty())) {
    const ModuleDescription module = describe_module(*opened->module, opened->sources);
    if (exports || !module.empty()) {
      print_diagnostics(stderr, opened->diagnostics, opened->sources);
      fmt::print("{}", json ? module_json(module) : module_text(module));
      return 0;
    }
  }
  const auto programs = programs_of(*opened, choice, true);
  if (programs.empty()) return refused;
  const std::shared_ptr<const CommonModules> common = common_modules();
  std::vector<Description> descriptions;
  for (const auto& program : programs) {
    const auto parameters = chosen_parameters(program, settings);
    if (!parameters) return refused;
    descriptions.push_back(describe(Bank(program, *parameters, program.default_size()), &common->declarations));
  }
  if (json) {
    fmt::print("{}", descriptions_json(descriptions));
    return 0;
  }
  for (std::size_t i = 0; i < descriptions.size(); ++i)
    fmt::print("{}{}", i == 0 ? "" : "\n", description_text(descriptions[i]));
  return 0;
}

/// Each file is one to compare with its materials, or FILE:MATERIAL.
int compare(Choice choice, const std::vector<std::string>& files, bool json) {
  const std::shared_ptr<const CommonModules> common = common_modules();
  std::vector<Cues> materials;
  for (const std::string& named : files) {
    choice.file = named, choice.material.clear();
    if (const auto colon = named.rfind(':'); colon != std::string::npos && !std::filesystem::exists(named))
      choice.file = named.substr(0, colon), choice.material = named.substr(colon + 1);
    auto opened = open(choice);
    if (!opened) return refused;
    // Among many files are some that only lend functions to others.
    if (opened->module && opened->module->materials.empty() && files.size() > 2) {
      fmt::print(stderr, "wale: `{}` has no material and is left out\n", choice.file);
      continue;
    }
    const auto programs = programs_of(*opened, choice, true);
    if (programs.empty()) return refused;
    for (const Program& program : programs) {
      if (!materials.empty() && program.description().device.name != materials.front().device)
        return refuse(fmt::format("`{}` is built for `{}` and `{}` for `{}`: what is felt is compared on one device",
                                  materials.front().material, materials.front().device, program.description().material,
                                  program.description().device.name));
      if (program.description().vibrates())
        return refuse(
            fmt::format("`{}` is built for `{}`, which only vibrates: the cues that are compared are of forces",
                        program.description().material, program.description().device.name));
      materials.push_back(cues_of(Bank(program), common->declarations));
    }
  }
  if (materials.size() < 2) return refuse("there is only one material; name another to compare it with");
  const ComparisonMatrix matrix = compare_all(std::move(materials), common->declarations);
  fmt::print("{}", json ? comparison_json(matrix) : comparison_text(matrix));
  return 0;
}

int sample(const Choice& choice, const std::vector<std::string>& settings, const std::string& at,
           const std::string& trace_file, const std::string& out, bool json) {
  const auto programs = load_programs(choice, false);
  if (programs.empty()) return refused;
  const auto parameters = chosen_parameters(programs.front(), settings);
  if (!parameters) return refused;
  std::vector<SampledHand> hands;
  if (!trace_file.empty()) {
    const auto trace = load_trace(trace_file);
    if (!trace) return refused;
    for (const auto& point : trace->points)
      hands.push_back({point.time, {glm::vec2(point.position), glm::vec2(point.velocity)}});
  } else {
    QuantityReader reader;
    const auto hand = reader.hand("--at", at);
    if (!hand) {
      print_diagnostics(stderr, reader.diagnostics(), reader.sources());
      return refused;
    }
    hands.push_back({0, *hand});
  }
  const Bank bank(programs.front(), *parameters, programs.front().default_size());
  const bool vibrates = programs.front().description().vibrates();
  const std::string text =
      json ? samples_json(sample(bank, hands), vibrates) : samples_csv(sample(bank, hands), vibrates);
  if (const auto problem = write_file(out, text)) return refuse(*problem);
  return 0;
}

int preview(const Choice& choice, const std::vector<std::string>& settings, const std::string& out) {
  const auto programs = load_programs(choice, false);
  if (programs.empty()) return refused;
  const auto parameters = chosen_parameters(programs.front(), settings);
  if (!parameters) return refused;
  const Bank bank(programs.front(), *parameters, programs.front().default_size());
  try {
    const Drawing drawing = draw_preview(bank, preview_text(bank));
    if (!drawing.has_text)
      fmt::print(stderr, "wale: no font is installed, so the picture has no words (Debian: fonts-dejavu-core)\n");
    if (const auto problem = save_drawing(drawing, out)) return refuse(problem->reason);
  } catch (const NoImageLibrary& missing) {
    return refuse(missing.what());
  }
  return 0;
}

struct FeelOptions {
  Choice choice;
  std::vector<std::string> settings;
  std::string device = "simulated", hand = "lateral", record;
  double seconds = 5;
  bool virtual_time = false, json = false;
};

int feel(const FeelOptions& options) {
  // A declared device is simulated, and built for.
  const auto declared = Library().devices();
  const bool known = std::ranges::any_of(declared, [&](const auto& one) { return one.profile.name == options.device; });
  if (options.device != "simulated" && !known)
    return refuse(
        fmt::format("there is no device `{}`; this version drives: simulated, and every device that materials "
                    "are built for, simulated (see `wale devices`)",
                    options.device));
  Choice choice = options.choice;
  if (known) choice.device = options.device;
  const auto programs = load_programs(choice, false);
  if (programs.empty()) return refused;
  const Program& program = programs.front();
  const auto parameters = chosen_parameters(program, options.settings);
  if (!parameters) return refused;

  const auto person = std::get<SimulatedPerson>(Library().person());
  Motion motion = person.lateral;
  if (options.hand == "circular")
    motion = person.circular;
  else if (options.hand == "rest")
    motion = Rest{};
  else if (options.hand != "lateral") {
    auto trace = load_trace(options.hand);
    if (!trace) return refused;
    motion = *std::move(trace);
  }
  const DeviceProfile& profile = program.description().device;
  if (known && profile.name != options.device)
    return refuse(fmt::format("`{}` is built for `{}`; feel it there, or build it for `{}`",
                              program.description().material, profile.name, options.device));
  const bool vibrates = program.description().vibrates();
  std::unique_ptr<Device> device;
  if (vibrates)
    device = std::make_unique<SimulatedPad>(profile, std::move(motion));
  else
    device = std::make_unique<SimulatedJoystick>(profile, person.hand, std::move(motion));
  Stage stage(*device);
  stage.place(program);
  for (std::size_t i = 0; i < parameters->size(); ++i)
    if (const auto refusal = stage.set(program.description().parameters[i].name, (*parameters)[i]))
      return refuse(refusal->reason);

  std::signal(SIGINT, [](int) { interrupted = true; });
  std::signal(SIGTERM, [](int) { interrupted = true; });
  RunOptions run{
      .seconds = options.seconds, .virtual_time = options.virtual_time, .progress = {}, .stop = &interrupted};
  const bool live = isatty(fileno(stderr));
  if (live)
    run.progress = [vibrates](const Progress& now) { fmt::print(stderr, "\r{}", progress_line(now, vibrates)); };
  const auto result = stage.run(run);
  if (live) fmt::print(stderr, "\r\033[K");
  if (const auto* refusal = std::get_if<Refusal>(&result)) return refuse(refusal->reason);

  const auto& done = std::get<RunResult>(result);
  if (!options.record.empty()) {
    std::ostringstream csv;
    write_csv(csv, done.record);
    if (const auto problem = write_file(options.record, csv.str())) return refuse(*problem);
  }
  const FeltReport report =
      felt_report(*stage.bank(), done, profile, {"simulated", options.hand, options.virtual_time});
  fmt::print("{}", options.json ? felt_json(report) : felt_text(report));
  return 0;
}

int devices(bool json) {
  fmt::print("{}", json ? devices_json(Library().devices()) : devices_text(Library().devices()));
  return 0;
}

constexpr const char* about =
    R"(Wale: a language for how things feel, and the runtime that makes a force-feedback joystick feel that way.

  designers    write a material, then:   wale check my.wale;  wale describe my.wale;  wale feel my.wale
  curators     compare and trust:        wale compare A.wale B.wale;  wale describe --json FILE;  wale preview FILE -o OUT.png
  programmers  take a program along:     wale build FILE -o OUT.wpp;  wale sample FILE --at "10 mm, 5 mm"
                                         examples/roughness_by_name asks for a roughness by name from C++

Begin with library/fabric/corduroy.wale; schema/LANGUAGE.md is the language.)";

}  // namespace

int main(int argc, char** argv) {
  CLI::App app(about, "wale");
  app.set_version_flag("--version", "wale " WALE_VERSION ", language version 1");
  app.require_subcommand(1);
  int status = 0;

  std::vector<std::string> files, settings;
  Choice choice;
  FeelOptions feeling;
  std::string out, at, trace, code;
  bool json = false, fix = false;
  const auto with_settings = [&](CLI::App* verb, std::vector<std::string>& into) {
    verb->add_option("--set", into, "a parameter's value, as in --set wale=5mm; may be repeated")
        ->type_name("NAME=VALUE")
        ->expected(1)
        ->take_all();
  };

  auto* verb = app.add_subcommand("check", "says what is wrong with Wale files, and where, and how to mend it");
  verb->add_option("FILE", files, "Wale files")->required();
  choice.offer_library(*verb);
  verb->add_flag("--json", json, "diagnostics as a JSON array");
  verb->add_flag("--fix", fix, "first writes the mends that are beyond doubt into these files");
  verb->callback([&] { status = check(files, choice.folders, json, fix); });

  verb = app.add_subcommand("explain", "tells what a diagnostic's code means, with an example and its mend");
  verb->add_option("CODE", code, "as in W0301 (default: lists all codes)");
  verb->callback([&] { status = explain(code); });

  verb = app.add_subcommand("format", "writes Wale files in the language's one style");
  bool check_only = false;
  verb->add_option("FILE", files, "Wale files; - for standard input to standard output")->required();
  verb->add_flag("--check", check_only,
                 "changes nothing; lists the files that would change and fails if there are any");
  verb->callback([&] { status = format(files, check_only); });

  verb = app.add_subcommand("build", "compiles a material to a patch program, or shows what a stage makes of it");
  choice.offer(*verb);
  bool all = false, exports = false;
  std::string stage;
  std::vector<std::string> stages;
  for (const auto& known : stage_names) stages.emplace_back(known.name);
  verb->add_option("-o,--output", out,
                   "the patch program to write (.wpp); with --all, a folder for them; with --emit, the text (default: "
                   "standard output)");
  verb->add_flag("--all", all, "builds every material of the file, each to NAME.wpp in the folder")
      ->excludes("--material");
  verb->add_option("--emit", stage,
                   "writes the material as it is after a stage instead: its tree, checked, its values (ir), the "
                   "machine's listing, or C++")
      ->check(CLI::IsMember(stages))
      ->type_name("STAGE")
      ->excludes("--all");
  verb->callback([&] {
    if (out.empty() && stage.empty()) throw CLI::RequiredError("--output");
    status = !stage.empty() ? show_stage(choice, stage, out.empty() ? "-" : out)
             : all          ? build_collection(choice, out)
                            : build(choice, out);
  });

  verb =
      app.add_subcommand("describe", "tells what materials will feel like, on what evidence, and how hard they push");
  choice.offer(*verb);
  with_settings(verb, settings);
  verb->add_flag("--exports", exports,
                 "what the file offers to those that import it (default where it has no material)")
      ->excludes("--material");
  verb->add_flag("--json", json, "an object for one material, an array for several");
  verb->callback([&] { status = describe(choice, settings, exports, json); });

  verb = app.add_subcommand("compare", "tells by what people would tell materials apart, and how plainly");
  verb->add_option("FILE", files, "Wale files or patch programs, with all of their materials; FILE:MATERIAL for one")
      ->required();
  verb->add_option("--device", choice.device, "the device to build for (default: sandpaper; see `wale devices`)");
  choice.offer_library(*verb);
  verb->add_flag("--json", json, "an object with every material's cues and every pair");
  verb->callback([&] { status = compare(choice, files, json); });

  verb = app.add_subcommand("feel", "runs a material on a joystick and measures what comes out of its handle");
  feeling.choice.offer(*verb, "--built-for");
  with_settings(verb, feeling.settings);
  verb->add_option("--device", feeling.device, "the joystick or pad (default: simulated; see `wale devices`)");
  verb->add_option("--hand", feeling.hand,
                   "how the simulated hand moves: lateral (default), circular, rest, or a CSV trace of t, x, y");
  verb->add_option("--seconds", feeling.seconds, "how long (default: 5)");
  verb->add_flag("--virtual-time", feeling.virtual_time, "as fast as possible, the same bit for bit each time");
  verb->add_option("--record", feeling.record, "writes every tick to a CSV file");
  verb->add_flag("--json", feeling.json, "the report as a JSON object");
  verb->callback([&] { status = feel(feeling); });

  verb = app.add_subcommand("sample", "the program's force at given hands, open loop; outside the patch it is zero");
  choice.offer(*verb);
  with_settings(verb, settings);
  auto* places = verb->add_option_group("hands", "where the hand is")->require_option(1);
  places->add_option("--at", at, "one hand from the patch's centre: \"10 mm, 5 mm[, 0.1 m/s, 0 m/s]\"");
  places->add_option("--trace", trace,
                     "a CSV file with t, x, y in s and m, and vx, vy in m/s if it has them; a line is a tick");
  verb->add_option("-o,--output", out, "where to write (default: standard output)");
  verb->add_flag("--json", json, "a JSON array instead of CSV");
  verb->callback([&] { status = sample(choice, settings, at, trace, out.empty() ? "-" : out, json); });

  verb = app.add_subcommand("preview", "draws the picture a designer would pin to the wall");
  choice.offer(*verb);
  with_settings(verb, settings);
  verb->add_option("-o,--output", out, "the picture to write (.png)")->required();
  verb->callback([&] { status = preview(choice, settings, out); });

  verb = app.add_subcommand("devices", "lists the joysticks that materials can be felt on and built for");
  verb->add_flag("--json", json, "as a JSON array");
  verb->callback([&] { status = devices(json); });

  // A newcomer's bare `wale` gets the overview; a misspelt verb is told so, not that a verb is missing.
  if (argc == 1) {
    fmt::print(stderr, "{}", app.help());
    return misused;
  }
  std::vector<std::string> verbs;
  for (const auto* known : app.get_subcommands({})) verbs.push_back(known->get_name());
  if (const std::string first = argv[1]; !first.starts_with('-') && std::ranges::find(verbs, first) == verbs.end()) {
    const auto near = nearest_spelling(first, verbs);
    fmt::print(stderr, "wale: there is no verb `{}`; {}\n", first,
               near ? fmt::format("did you mean `{}`?", *near) : fmt::format("there are: {}", fmt::join(verbs, ", ")));
    return misused;
  }
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? 0 : misused;
  }
  return status;
}
