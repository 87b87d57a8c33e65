#include <fmt/chrono.h>
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <ctime>
#include <memory>

#include "compiler/command/options.hpp"
#include "compiler/command/print.hpp"
#include "library/command/misused_option.hpp"
#include "schema/spelling.hpp"
#include "wale/thesis_files.hpp"

namespace wale::command {
namespace {

constexpr std::uint64_t most_columns = 65535;    // two bytes of the file
constexpr int least_step = 4, most_across = 2;    // of 255: a seam is more than so many times the steps beside it
constexpr std::uint64_t columns_of_a_wave = 256;  // "a height map array of width 256" (5.2.2)

struct ExportOptions {
  Choice choice;
  std::vector<std::string> settings;
  std::string movie, shuffled, date, time;
  bool wave = false;
  std::optional<double> size;  // m
  std::optional<std::uint64_t> columns;
  std::optional<HeightsBetween> heights;
  std::string out;
};

Result<> written(const ExportOptions& options, std::string_view bytes) {
  return write_file(options.out, bytes, *options.choice.inputs);
}

/// How the patch of a program is sampled.
Result<ThesisSampling> sampling_of(const ExportOptions& options, const Bank& bank) {
  const PatchSize size = bank.size();
  const bool is_length = bank.program().description().picture.relief_is_length;
  std::optional<std::pair<double, double>> heights;
  if (options.heights) {
    if (options.heights->is_length != is_length)
      return misused_option("--heights",
                            is_length ? "expected two lengths, since the relief is one, found plain numbers"
                                      : "expected two plain numbers, since the relief is one, found lengths",
                            is_length ? "for example, `--heights \"0 mm, 1 mm\"`" : "for example, `--heights \"0, 1\"`");
    heights = {options.heights->low, options.heights->high};
  }
  // Beyond the patch nothing is felt.
  if (options.size && *options.size > size.width * (1 + 1e-6))
    return misused_option("--size", fmt::format("expected at most the patch's width of {:.6g} mm, found {:.6g} mm", 1000 * size.width,
                                                1000 * *options.size),
                          "leave it out for the whole patch");
  if (options.wave) {
    if (!options.size)
      return misused_option("--size", "expected the length of one wave", "for example, `--size \"2.5 mm\"`");
    const auto columns = static_cast<std::uint16_t>(options.columns.value_or(columns_of_a_wave));
    return ThesisSampling{.width = columns, .height = 1, .cell = *options.size / columns, .heights = heights};
  }
  const double width = options.size.value_or(size.width), height = width * size.height / size.width;
  const double columns = options.columns ? static_cast<double>(*options.columns) : std::max(1.0, std::round(width / thesis_cell));
  const double cell = width / columns, rows = std::max(1.0, std::round(height / cell));
  if (columns > most_columns || rows > most_columns)
    return Error{.code = Code::image_size,
                 .sentence = fmt::format("expected at most {0} by {0} cells, found {1:g} by {2:g}", most_columns, columns, rows),
                 .mend = "take fewer --columns"};
  return ThesisSampling{.width = static_cast<std::uint16_t>(columns), .height = static_cast<std::uint16_t>(rows), .cell = cell,
                        .heights = heights};
}

/// By how much the height steps from the last cell of a wave to the first of the next one, and at most within it.
std::pair<int, int> steps_of(const ThesisArray& wave) {
  int within = 0;
  for (std::size_t i = 1; i < wave.width; ++i) within = std::max(within, std::abs(wave.cells[i] - wave.cells[i - 1]));
  return {std::abs(wave.cells[wave.width - 1] - wave.cells.front()), within};
}

int export_material(const ExportOptions& options) {
  auto opened = open(options.choice);
  if (!opened) return opened.status();
  const auto programs = programs_of(*opened, options.choice, false);
  if (!programs) return programs.status();
  const Program& program = programs->front();
  const auto parameters = chosen_parameters(program, options.settings);
  if (!parameters) return refuse(parameters.error());
  const Bank bank(program, *parameters, program.default_size());
  const auto sampling = sampling_of(options, bank);
  if (!sampling) return refuse(sampling.error());
  const auto array = has_ending(options.out, ".shade") ? shading_of(bank, *sampling) : surface_of(bank, *sampling);
  if (!array) return refuse(array.error());
  if (options.wave)
    if (const auto [across, within] = steps_of(*array); across > most_across * std::max(within, least_step))
      print_error("wale: --size: the wave has a seam: from its last cell to its first the height steps by {} of 255, and by {} at most "
                  "within it; is its period another one?\n", across, within);
  const auto bytes = write_thesis_array(*array);
  if (!bytes) return refuse(bytes.error());
  const auto done_so = written(options, {reinterpret_cast<const char*>(bytes->data()), bytes->size()});
  return done_so ? done : refuse(done_so.error());
}

/// The frames of a movie of the file that an option names.
Result<ThesisMovie> movie_of(const OpenedFile& opened, const char* option, const std::string& name) {
  std::vector<std::string> known;
  for (const CheckedMovie& each : opened.module->movies) {
    known.push_back(each.named.name);
    if (each.named.name != name) continue;
    ThesisMovie movie;
    for (const auto& frame : each.frames) movie.workspaces.push_back(frame.name);
    return movie;
  }
  const auto near = nearest_spelling(name, known);
  return Error{.code = Code::unknown_name,
               .sentence = fmt::format("the file has no movie `{}`", name),
               .mend = near            ? fmt::format("did you mean `{}`?", *near)
                       : known.empty() ? "it has none: `movie NAME { frames … }` declares one"
                                       : fmt::format("its movies: {}", fmt::join(known, ", ")),
               .place = {.name = option, .text = name}};
}

int export_movie(const ExportOptions& options) {
  auto opened = open(options.choice);
  if (!opened) return opened.status();
  if (opened->program)
    return refuse(misused_option("--movie", "expected a Wale file, found a patch program", "name the Wale file that it was built from"));
  print_diagnostics(stderr, opened->diagnostics, opened->sources);
  const auto movie = movie_of(*opened, "--movie", options.movie);
  if (!movie) return refuse(movie.error());
  Result<std::string> text = std::string();
  if (options.shuffled.empty()) {
    text = write_thesis_movie(*movie);
  } else {
    const auto other = movie_of(*opened, "--shuffled", options.shuffled);
    if (!other) return refuse(other.error());
    auto shuffle = shuffle_of(*movie, *other);
    if (!shuffle) {
      shuffle.error().place.name = "--shuffled";
      return refuse(shuffle.error());
    }
    const std::time_t now = std::time(nullptr);
    std::tm here{};
    localtime_r(&now, &here);
    shuffle->movie = options.movie;
    shuffle->date = options.date.empty() ? fmt::format("{:%Y-%m-%d}", here) : options.date;
    shuffle->time = options.time.empty() ? fmt::format("{:%H:%M}", here) : options.time;
    text = write_thesis_shuffle(*shuffle);
  }
  if (!text) return refuse(text.error());
  const auto done_so = written(options, *text);
  return done_so ? done : refuse(done_so.error());
}

int export_file(const ExportOptions& options) {
  if (options.out.empty())
    return refuse(misused_option("-o", "expected the name of the file to write",
                                 options.movie.empty() ? "for example, `wale export corduroy -o corduroy.depth`"
                                                       : "for example, `wale export my.wale --movie demo -o demo.movie`"));
  if (options.shuffled.empty() && (!options.date.empty() || !options.time.empty()))
    return refuse(misused_option(options.date.empty() ? "--time" : "--date", "only a shuffle has a date and a time",
                                 "leave it out, or add --shuffled"));
  return options.movie.empty() ? export_material(options) : export_movie(options);
}

Run declare_export(CLI::App& verb) {
  const auto options = std::make_shared<ExportOptions>();
  offer_material(verb, options->choice);
  must_say(offer_output(verb, options->out,
                        "the file to write: an array of heights (.depth) or of what is seen (.shade); a movie or a shuffle"),
           "the name of the file to write", "for example, `wale export corduroy -o corduroy.depth`");
  offer_settings(verb, options->settings);
  auto* size = offer_length(verb, "--size", options->size,
                            "the width that is sampled, around the middle (default: the patch's), or the length of one wave");
  auto* columns = offer_count(verb, "--columns", options->columns, {.least = 1, .most = most_columns, .example = 256},
                              "how many cells that width has (default: of 0.37 mm, a pixel of the thesis's screen; of a wave 256)");
  auto* heights = offer_heights_between(verb, "--heights", options->heights,
                                        "the heights of 0 and 255, lengths or plain numbers as the relief's are: --heights \"0 mm, 1 mm\" "
                                        "of an import, --heights \"0, 1\" of a grating (default: its least and greatest)");
  auto* wave = verb.add_flag("--wave", options->wave, "one row of cells, which the thesis repeats");
  auto* movie = must_say(verb.add_option("--movie", options->movie, "writes a movie of the file instead")->type_name("NAME"),
                         "the name of a movie");
  for (CLI::Option* each : {size, columns, heights, wave}) movie->excludes(each);
  movie->excludes("--material")->excludes("--set");
  must_say(verb.add_option("--shuffled", options->shuffled,
                           "writes as which shuffle of --movie this movie of the file was shown, with the same frames in another order")
               ->type_name("NAME"),
           "the name of a movie")
      ->needs(movie);
  verb.add_option("--date", options->date, "the date in a shuffle (default: today)")->type_name("TEXT");
  verb.add_option("--time", options->time, "the time in a shuffle (default: now)")->type_name("TEXT");
  verb.footer(
      "for example: wale export corduroy -o corduroy.depth;  wale export corduroy --wave --size \"2.5 mm\" -o corduroy.wave;  "
      "wale export my.wale --movie demo -o demo.movie");
  return [options] { return export_file(*options); };
}

}  // namespace

extern const Verb export_verb{"export", "writes a relief, a movie or a shuffle as files of the Sandpaper of 1995", declare_export};

}  // namespace wale::command
