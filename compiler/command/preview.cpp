#include "compiler/preview/preview.hpp"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <memory>

#include "compiler/command/options.hpp"
#include "compiler/command/print.hpp"
#include "compiler/measure/coarseness.hpp"
#include "compiler/modules/load_modules.hpp"

namespace wale::command {
namespace {

struct PreviewOptions {
  Choice choice;
  std::vector<std::string> settings;
  std::string out;
};

int preview(const PreviewOptions& options) {
  const auto programs = load_programs(options.choice, false);
  if (!programs) return programs.status();
  const Program& program = programs->front();
  const auto parameters = chosen_parameters(program, options.settings);
  if (!parameters) return refuse(parameters.error());
  const auto common = common_modules();
  const Bank bank(program, *parameters, program.default_size());
  const auto drawing = draw_preview(bank, preview_text(bank, common->declarations), common->declarations);
  if (!drawing) return refuse(drawing.error());
  if (!drawing->has_text)
    print_error("wale: no font is installed, so the picture has no words (Debian: fonts-dejavu-core)\n");
  const PatchProgram& described = program.description();
  if (const std::size_t coarseness = coarseness_of(described); coarseness > 1)
    print_error("wale: {}\n", coarseness_note(described.material, coarseness));
  if (drawing->coarseness > 1)
    print_error(
        "wale: this program is so large that its surface is drawn in squares of {0} x {0} pixels, each of one "
        "sample\n",
        drawing->coarseness);
  const auto bytes = encode_drawing(*drawing, options.out);
  if (!bytes) return refuse(bytes.error());
  const auto written =
      write_file(options.out, {reinterpret_cast<const char*>(bytes->data()), bytes->size()}, *options.choice.inputs);
  if (!written) return refuse(written.error());
  return done;
}

Run declare_preview(CLI::App& verb) {
  const auto options = std::make_shared<PreviewOptions>();
  offer_material(verb, options->choice);
  offer_settings(verb, options->settings);
  offer_output(
      verb, options->out,
      "the picture to write, as in corduroy.png; also .jpg, .tif and the other formats that OpenImageIO writes")
      ->required();
  verb.footer("for example: wale preview corduroy -o corduroy.png");
  return [options] { return preview(*options); };
}

}  // namespace

extern const Verb preview_verb{"preview", "draws a material: its relief, its forces and its percepts", declare_preview};

}  // namespace wale::command
