#include "compiler/preview/preview.hpp"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cmath>
#include <map>
#include <memory>
#include <numbers>

#include "compiler/command/options.hpp"
#include "compiler/command/print.hpp"
#include "compiler/command/workspace_choice.hpp"
#include "compiler/describe/describe_workspace.hpp"
#include "compiler/measure/coarseness.hpp"
#include "compiler/preview/preview.hpp"
#include "compiler/preview/workspace_page.hpp"
#include "compiler/text/readable.hpp"
#include "compiler/typed_number.hpp"

namespace wale::command {
namespace {

struct PreviewOptions {
  Choice choice;
  std::vector<std::string> settings;
  std::string out;
  std::string workspace;          ///< to draw instead of a material; empty for none
  std::string along;              ///< "x", "y" or an angle in degrees; empty: where the surface changes
  std::optional<Hand> at;         ///< of which only the place counts; by default the patch's centre
  std::optional<double> seconds;  ///< of the trace
  bool small = false;             ///< the surface and its force alone
};

/// The direction and the place of the section, or why they make no sense.
Result<SectionChoice> section_of(const PreviewOptions& options, PatchSize size) {
  SectionChoice section;
  if (options.along == "x" || options.along == "y") {
    section.along = options.along == "x" ? 0 : std::numbers::pi / 2;
    section.name = options.along;
  } else if (!options.along.empty()) {
    std::string number = options.along;
    for (const std::string_view unit : {" deg", "deg", "°"})
      if (number.ends_with(unit)) number.resize(number.size() - unit.size());
    const auto angle = read_number("--along", number, {.least = -360, .most = 360, .example = 30});
    if (!angle)
      return Error{.code = angle.error().code,
                   .sentence = fmt::format("expected x, y, or an angle in degrees, {}", found_typed(options.along)),
                   .mend = "for example, `--along 30`, 30 degrees to the left of x",
                   .place = {.name = "--along"}};
    section.along = *angle * std::numbers::pi / 180;
    section.name = typeable("{:.4g}°", *angle);
  }
  if (!options.at) return section;
  const glm::dvec2 place(options.at->position);
  if (std::abs(place.x) > size.width / 2 || std::abs(place.y) > size.height / 2)
    return Error{.code = Code::value_out_of_range,
                 .sentence = readable("this place is outside the patch, {:.4g} mm by {:.4g} mm around its centre",
                                      1e3 * size.width, 1e3 * size.height),
                 .place = {.name = "--at"}};
  section.at = place;
  return section;
}

/// Writes a finished page, and says what it lacks.
int write_page(const Canvas& page, const PreviewOptions& options) {
  if (!page.has_text())
    print_error("wale: no font is installed, so the picture has no words (Debian: fonts-dejavu-core)\n");
  const auto bytes = encode_page(page, options.out);
  if (!bytes) return refuse(bytes.error());
  const auto written =
      write_file(options.out, {reinterpret_cast<const char*>(bytes->data()), bytes->size()}, *options.choice.inputs);
  if (!written) return refuse(written.error());
  return done;
}

int preview(const PreviewOptions& options) {
  auto opened = open(options.choice);
  if (!opened) return opened.status();
  const auto programs = programs_of(*opened, options.choice, false);
  if (!programs) return programs.status();
  const Program& program = programs->front();
  const auto parameters = chosen_parameters(program, options.settings);
  if (!parameters) return refuse(parameters.error());
  const auto declarations = declarations_of(*opened, options.choice);
  const Bank bank(program, *parameters, program.default_size());
  const auto section = section_of(options, bank.size());
  if (!section) return refuse(section.error());
  const auto drawing =
      draw_preview(bank, preview_text(bank, *declarations), *declarations, {*section, options.seconds, options.small});
  if (!drawing) return refuse(drawing.error());
  const PatchProgram& described = program.description();
  if (const std::size_t coarseness = coarseness_of(described); coarseness > 1)
    print_error("wale: {}\n", coarseness_note(described.material, coarseness));
  if (drawing->coarseness > 1)
    print_error(
        "wale: this program is so large that its surface is drawn in squares of {0} x {0} pixels, each of one "
        "sample\n",
        drawing->coarseness);
  return write_page(*drawing->page, options);
}

/// Draws a workspace of the file.
int preview_workspace(const PreviewOptions& options) {
  auto opened = open(options.choice);
  if (!opened) return opened.status();
  const auto workspace = compiled_workspace(*opened, options.workspace, options.choice);
  if (!workspace) return workspace.status();
  const std::string& device = options.choice.device;
  const auto declarations = declarations_of(*opened, options.choice);
  const WorkspaceDescription described =
      describe_workspace(*workspace->checked, workspace->laid, device, *declarations);
  std::map<const Program*, std::optional<double>> felt;
  std::vector<PatchWords> words;
  for (std::size_t i = 0; i < workspace->laid.size(); ++i) {
    const Program& program = *workspace->laid[i].program;
    const auto [level, is_new] = felt.try_emplace(&program);
    if (is_new)
      level->second =
          preview_text(Bank(program, program.default_parameters(), program.default_size()), *declarations).felt;
    words.push_back({described.patches[i].feels, level->second});
  }
  const DeviceDeclaration* declared = opened->module->declarations().devices.find(device);
  const auto page = draw_workspace(workspace->made(), declared->profile, words);
  return page ? write_page(**page, options) : refuse(page.error());
}

Run declare_preview(CLI::App& verb) {
  const auto options = std::make_shared<PreviewOptions>();
  offer_material(verb, options->choice);
  offer_settings(verb, options->settings);
  offer_output(
      verb, options->out,
      "the picture to write, as in corduroy.png; also .svg, .jpg, .tif and the other formats that OpenImageIO writes")
      ->required();
  auto* workspace = must_say(verb.add_option("--workspace", options->workspace,
                                             "a workspace of the file from above, instead of a material")
                                 ->type_name("NAME"),
                             "the name of a workspace")
                        ->excludes("--material")
                        ->excludes("--set");
  must_say(verb.add_option("--along", options->along,
                           "the direction of the section: x, y, or an angle to the left of x in degrees, as in 30 "
                           "(default: the axis along which the surface changes)"),
           "x, y or an angle")
      ->excludes(workspace);
  offer_hand(verb, "--at", options->at,
             "a place on the section, from the patch's centre: \"10 mm, 5 mm\" (default: the centre)");
  offer_duration(verb, "--seconds", options->seconds, {.most = 60, .example = 3},
                 "how long the hand rubs before the picture is taken, and strokes for the spectrum (default: 1 s to 5 "
                 "s, and 2 s)");
  verb.add_flag("--small", options->small, "the surface and its force alone, to be shown beside a text");
  for (const char* of_material : {"--at", "--seconds", "--small"}) workspace->excludes(of_material);
  verb.footer("for example: wale preview corduroy -o corduroy.png --along 30 --at \"10 mm, 5 mm\"");
  return [options] { return options->workspace.empty() ? preview(*options) : preview_workspace(*options); };
}

}  // namespace

extern const Verb preview_verb{"preview", "draws a material: its relief, its forces and its percepts", declare_preview};

}  // namespace wale::command
