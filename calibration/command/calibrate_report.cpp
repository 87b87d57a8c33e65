#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <memory>
#include <system_error>

#include "calibration/command/calibrate_study.hpp"
#include "calibration/command/experiment_file.hpp"
#include "calibration/fit/chart.hpp"
#include "calibration/fit/study_page.hpp"
#include "compiler/command/options.hpp"
#include "compiler/command/print.hpp"
#include "compiler/preview/preview.hpp"
#include "compiler/solve/level_scale.hpp"
#include "compiler/text/readable.hpp"
#include "schema/visible_text.hpp"

namespace wale::command {
namespace {

namespace fs = std::filesystem;

/// More pictures of stimuli than this make a page that takes long to draw.
constexpr std::size_t most_pictures = 36;

struct CalibrateReportOptions {
  StudyChoice study;
  std::vector<std::string> materials;
  std::string out;
};

/// Draws the stimuli of the design, as far as they can be built.
Result<> draw_stimuli(const FittedStudy& study, const StudyChoice& choice, StudyPageParts& parts) {
  if (!study.design) {
    parts.stimuli_note = "The design was not named, so its stimuli are not drawn.";
    return {};
  }
  Choice built = choice.opened;
  built.file = choice.design;
  const auto& devices = study.design->module->declarations().devices;
  if (devices.find(study.study.device) != nullptr) built.device = study.study.device;
  const auto ready =
      ready_experiment(*study.design, choice.experiment.empty() ? study.study.experiment : choice.experiment, built);
  if (!ready) {
    parts.stimuli_note = "The stimuli of the design cannot be built.";
    return {};
  }
  const std::size_t count = std::min(ready->stimuli.size(), most_pictures);
  if (count < ready->stimuli.size())
    parts.stimuli_note = readable("The first {} of {} stimuli are drawn.", count, ready->stimuli.size());
  const auto declarations = declarations_of(*study.design, built);
  for (std::size_t i = 0; i < count; ++i) {
    const Program& program = ready->stimuli[i];
    const Bank bank(program, program.default_parameters(), program.default_size());
    const auto drawn = draw_preview(bank, preview_text(bank, *declarations), *declarations,
                                    {.section = {}, .seconds = {}, .small = true});
    if (!drawn) return drawn.error();
    auto bytes = encode_page(*drawn->page, "stimulus.png");
    if (!bytes) return bytes.error();
    parts.stimuli.push_back({ready->experiment->stimuli[i].name, "image/png", *std::move(bytes)});
  }
  return {};
}

/// The Wale files that are named, and those in folders, in the order of their names.
Result<std::vector<std::string>> files_in(const std::vector<std::string>& paths) {
  std::vector<std::string> files;
  for (const std::string& path : paths) {
    std::error_code failed;
    if (!fs::is_directory(path, failed)) {
      files.push_back(path);
      continue;
    }
    std::vector<std::string> found;
    for (auto at = fs::recursive_directory_iterator(path, failed); !failed && at != fs::recursive_directory_iterator();
         at.increment(failed))
      if (at->path().extension() == ".wale") found.push_back(at->path().string());
    if (failed)
      return Error{.code = Code::unreadable_file,
                   .sentence = "this folder cannot be read: " + failed.message(),
                   .place = {.name = path}};
    std::ranges::sort(found);
    files.insert(files.end(), found.begin(), found.end());
  }
  return files;
}

/// Compares each material's size for its level with that of the new map. Levels are magnitudes over that of the
/// reference stimulus, so a power law's level is a power of the size over the reference's.
Result<> find_moved(const FittedStudy& study, const CalibrateReportOptions& options, StudyPageParts& parts) {
  if (!study.fit.magnitudes || options.materials.empty()) {
    parts.moved_note = "No materials were named for comparison.";
    return {};
  }
  const double exponent = chosen_law(*study.fit.magnitudes, study.request.model).exponent.value;
  const std::string percept = study.request.about.empty() ? "roughness" : study.request.about;
  if (!(exponent > 0)) {
    parts.moved_note = "The exponent is not above zero, so no level has a size by this map.";
    return {};
  }
  const auto files = files_in(options.materials);
  if (!files) return files.error();
  std::size_t compared = 0, unbuilt = 0;
  for (const std::string& file : *files) {
    Choice choice = options.study.opened;
    choice.file = file, choice.shares_options = true;
    auto opened = open(choice);
    if (!opened || !opened->module) {
      ++unbuilt;
      continue;
    }
    const auto programs = programs_of(*opened, choice, true);
    if (!programs) {
      ++unbuilt;
      continue;
    }
    const auto declarations = declarations_of(*opened, choice);
    const Percept* declared = declarations->percepts.find(percept);
    const DeviceDeclaration* device = declarations->devices.find(choice.device);
    if (declared == nullptr || device == nullptr) continue;
    for (const Program& program : *programs)
      for (const PerceptRecord& record : program.description().percepts) {
        if (record.name != percept || !record.parameter || !(record.one > 0)) continue;
        const auto maps = declarations->maps();
        const auto map = std::ranges::find_if(
            maps, [&](const Map* each) { return each->percept == percept && each->source == record.source; });
        if (map == maps.end()) continue;
        const double level = program.description().parameters[*record.parameter].value;
        const LevelScale scale(*declared, **map, *declarations, *device);
        const double before = scale.size_of(level);
        if (!(level > 0) || !(before > 0)) continue;
        ++compared;
        const double after = std::min(record.one * std::pow(level, 1 / exponent), scale.most_size());
        const double noticeable = record.weber > 0 ? std::abs(std::log(after / before)) / std::log1p(record.weber) : 0;
        if (noticeable > 1 || (record.weber <= 0 && after != before))
          parts.moved.push_back({program.description().material, level, before, after, record.unit, noticeable,
                                 std::pow(before / record.one, exponent)});
      }
  }
  std::ranges::stable_sort(parts.moved, std::ranges::greater(), &MovedMaterial::noticeable);
  parts.moved_note =
      readable("{} materials ask for {}; with this map {} of them change by more than a just noticeable difference.",
               compared, percept, parts.moved.size());
  if (unbuilt > 0) parts.moved_note += readable(" {} files could not be built.", unbuilt);
  return {};
}

int calibrate_report(const CalibrateReportOptions& options) {
  const auto study = fitted_study(options.study);
  if (!study) return study.status();
  StudyPageParts parts;
  if (const auto drawn = draw_stimuli(*study, options.study, parts); !drawn) return refuse(drawn.error());
  for (const Chart& chart : charts_of(study->fit, study->request.model)) {
    const auto page = draw_chart(chart);
    if (!page) return refuse(page.error());
    auto bytes = encode_page(**page, "chart.svg");
    if (!bytes) return refuse(bytes.error());
    parts.charts.push_back({chart.title, "image/svg+xml", *std::move(bytes)});
  }
  if (const auto found = find_moved(*study, options, parts); !found) return refuse(found.error());
  InputFiles inputs = options.study.files;
  if (!options.study.design.empty()) inputs.push_back(options.study.design);
  if (!options.study.stimuli.empty()) inputs.push_back(options.study.stimuli);
  // What the compared materials are made of.
  if (const auto files = files_in(options.materials)) inputs.insert(inputs.end(), files->begin(), files->end());
  const InputFiles& opened = *options.study.opened.inputs;
  inputs.insert(inputs.end(), opened.begin(), opened.end());
  const auto written =
      write_file(options.out, study_page(study->study, study->fit, study->request, study->record, parts), inputs);
  if (!written) return refuse(written.error());
  if (options.out != "-")
    print_out("{}", readable("{} has {} trials, {} excluded rows, {} and {} charts\n", visible_text(options.out),
                             study->fit.trials.size(), study->fit.trials.exclusions.size(),
                             study->design ? readable("{} drawn stimuli", parts.stimuli.size())
                                           : std::string("no drawn stimuli (name the --design)"),
                             parts.charts.size()));
  return done;
}

Run declare_calibrate_report(CLI::App& verb) {
  const auto options = std::make_shared<CalibrateReportOptions>();
  offer_study(verb, options->study);
  offer_output(verb, options->out, "the HTML file, which needs no other file")->required();
  must_say(
      verb.add_option(
              "--materials", options->materials,
              "Wale files, or folders of them, whose levels are compared with those of the new map; may be repeated")
          ->type_name("PATH"),
      "the path of a Wale file or a folder");
  verb.footer(
      "Shows design, stimuli (with --design), raw data, fits, residuals, exclusions, the record as it will be used, "
      "and what it\n"
      "changes in materials (with --materials).\n"
      "for example: wale calibrate report crossed-*.trials --design crossed.wale --materials library -o crossed.html");
  return [options] { return calibrate_report(*options); };
}

}  // namespace

extern const Verb calibrate_report_verb{"calibrate-report", "makes one page of HTML of a study and its fit",
                                        declare_calibrate_report};

}  // namespace wale::command
