#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <filesystem>
#include <memory>
#include <system_error>

#include "calibration/command/calibrate_study.hpp"
#include "calibration/fit/chart.hpp"
#include "compiler/command/options.hpp"
#include "compiler/command/print.hpp"
#include "compiler/text/readable.hpp"
#include "schema/visible_text.hpp"

namespace wale::command {
namespace {

struct CalibrateFitOptions {
  StudyChoice study;
  std::string out, plots;
  bool json = false;
};

/// Draws all charts of a fit, each as SVG and as PNG.
Result<> write_charts(const FittedStudy& study, const std::string& folder, const InputFiles& inputs) {
  std::error_code failed;
  std::filesystem::create_directories(folder, failed);
  if (failed)
    return Error{.code = Code::unwritable_file,
                 .sentence = "the folder cannot be made: " + failed.message(),
                 .place = {.name = folder}};
  for (const Chart& chart : charts_of(study.fit, study.request.model)) {
    const auto page = draw_chart(chart);
    if (!page) return page.error();
    for (const char* ending : {".svg", ".png"}) {
      const std::string path = (std::filesystem::path(folder) / (chart.file + ending)).string();
      const auto bytes = encode_page(**page, path);
      if (!bytes) return bytes.error();
      const auto written = write_file(path, {reinterpret_cast<const char*>(bytes->data()), bytes->size()}, inputs);
      if (!written) return written;
    }
  }
  return {};
}

int calibrate_fit(const CalibrateFitOptions& options) {
  const auto study = fitted_study(options.study);
  if (!study) return study.status();
  InputFiles inputs = options.study.files;
  if (!options.study.design.empty()) inputs.push_back(options.study.design);
  if (!options.study.stimuli.empty()) inputs.push_back(options.study.stimuli);
  const bool has_record = study->fit.no_record.empty();
  if (study->record_problem) {
    if (!options.out.empty()) {
      refuse(*study->record_problem);
      return refused;  // also where an option's word is at fault: only the record showed that it is
    }
    warn(*study->record_problem);
  }
  if (!options.out.empty() && has_record)
    if (const auto written = write_file(options.out, study->record, inputs); !written) return refuse(written.error());
  if (!options.plots.empty())
    if (const auto drawn = write_charts(*study, options.plots, inputs); !drawn) return refuse(drawn.error());
  if (options.json) {
    print_out(fit_json(study->study, study->fit, study->request, study->record));
    return has_record ? done : refused;
  }
  if (options.out == "-" && has_record) return done;
  print_out(fit_text(study->study, study->fit, study->request));
  if (!has_record)
    return refuse(Error{.code = Code::not_measured,
                        .sentence = fmt::format("no {} is made: {}", study->fit.magnitudes          ? "map"
                                                                          : study->fit.settings.empty() && study->fit.thresholds.empty()
                                                                              ? "rule"
                                                                              : "threshold",
                                                study->fit.no_record),
                        .mend = "look at the answers; collect more, or vary the sizes more",
                        .place = {.name = options.study.files.front()}});
  if (!options.out.empty())
    print_out("{} has the {}\n", visible_text(options.out),
              study->fit.magnitudes           ? "map"
              : study->fit.thresholds.empty() && study->fit.settings.empty() ? "rule"
                                                                             : "threshold");
  return done;
}

Run declare_calibrate_fit(CLI::App& verb) {
  const auto options = std::make_shared<CalibrateFitOptions>();
  offer_study(verb, options->study);
  offer_output(verb, options->out, "the Wale file with the map, threshold or rule");
  must_say(verb.add_option("--plots", options->plots, "a folder for plots, each as SVG and PNG")->type_name("FOLDER"),
           "the path of a folder");
  offer_json(verb, options->json, "prints estimates, exclusions and the record as JSON");
  verb.footer(
      "Magnitude estimates become a map, forced choices and adjustments a threshold, ratings, sorts and descriptions a\n"
      "rule. What a planted observer says, and what anybody says on a simulated device, is graded `simulated`, the worst\n"
      "grade.\n"
      "for example: wale calibrate fit crossed-*.trials -o crossed.wale --plots plots\n"
      "             wale calibrate fit study.csv --task magnitude_estimation --answer slider.response --size "
      "amplitude=amp:N");
  return [options] { return calibrate_fit(*options); };
}

}  // namespace

extern const Verb calibrate_fit_verb{"calibrate-fit", "makes a map, a threshold or a rule of the trials of a study",
                                     declare_calibrate_fit};

}  // namespace wale::command
