#include <fmt/format.h>
#include <fmt/ranges.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <memory>

#include "compiler/build_all.hpp"
#include "compiler/build_stage.hpp"
#include "compiler/command/options.hpp"
#include "compiler/command/print.hpp"
#include "compiler/command/workspace_choice.hpp"
#include "compiler/text/readable.hpp"
#include "schema/visible_text.hpp"

namespace wale::command {
namespace {

struct BuildOptions {
  Choice choice;
  std::string out;        ///< a file, or with `all` a folder
  std::string stage;      ///< stage to show instead of building; empty to build
  std::string workspace;  ///< to build instead of a material; empty for none
  bool all = false;
  std::vector<std::string> live;  ///< of the C++: parameters, `size` or `all`
};

int build_one(const BuildOptions& options) {
  auto opened = open(options.choice);
  if (!opened) return opened.status();
  if (opened->program)
    return refuse(Error{.code = Code::malformed_value,
                        .sentence = fmt::format("this is a patch program already, built for `{}`",
                                                opened->program->description().device.name),
                        .mend = "name the Wale file that it was built from",
                        .place = {.name = opened->name}});
  const auto programs = programs_of(*opened, options.choice, false);
  if (!programs) return programs.status();
  const auto bytes = write_patch_program(programs->front().description());
  if (const auto written =
          write_file(options.out, {reinterpret_cast<const char*>(bytes.data()), bytes.size()}, *options.choice.inputs);
      !written)
    return refuse(written.error());
  return done;
}

/// Builds a workspace of the file, with all its programs, to one file.
int build_workspace(const BuildOptions& options) {
  auto opened = open(options.choice);
  if (!opened) return opened.status();
  const auto workspace = compiled_workspace(*opened, options.workspace, options.choice);
  if (!workspace) return workspace.status();
  const auto bytes = write_workspace(workspace->made());
  const std::string_view text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  const auto written = write_file(options.out, text, *options.choice.inputs);
  return written ? done : refuse(written.error());
}

int show_stage(const BuildOptions& options) {
  const auto known = std::ranges::find(stage_names, options.stage, &StageName::name);
  if (known == stage_names.end()) {
    std::vector<std::string_view> names;
    for (const StageName& each : stage_names) names.push_back(each.name);
    return refuse(Error{.code = Code::malformed_value,
                        .sentence = fmt::format("no stage is called `{}`", options.stage),
                        .mend = fmt::format("the stages are {}", fmt::join(names, ", ")),
                        .place = {.name = "--emit", .text = options.stage}});
  }
  const bool of_no_device = known->stage == BuildStage::tree || known->stage == BuildStage::checked;
  if (of_no_device && !options.choice.device_option.empty())
    return refuse(Error{.code = Code::malformed_value,
                        .sentence = fmt::format("the stage `{}` is the same for all devices", options.stage),
                        .mend = "leave out --device, or show ir, listing or cpp",
                        .place = {.name = "--device"}});
  const bool is_option = !options.choice.material.empty();
  if (known->stage == BuildStage::tree && (is_option || !named_material(options.choice.file).material.empty()))
    return refuse(
        Error{.code = Code::malformed_value,
              .sentence = "the stage `tree` is of the whole file",
              .mend = fmt::format("leave out {}, or show another stage", is_option ? "--material" : "the material"),
              .place = {.name = is_option ? "--material" : options.choice.file}});
  auto opened = open(options.choice);
  if (!opened) return opened.status();
  const auto text = build_stage(*opened, options.choice.recording_request(), options.choice.material, known->stage,
                                opened->diagnostics, options.live);
  print_diagnostics(stderr, opened->diagnostics, opened->sources);
  if (!text) return refuse(text.error());
  if (!*text) return refused;
  if (const auto written =
          write_file(options.out.empty() ? "-" : options.out, visible_lines(**text), *options.choice.inputs);
      !written)
    return refuse(written.error());
  return done;
}

/// Builds every material to a program of its own, and reports each.
int build_collection(const BuildOptions& options) {
  const auto opened = open(options.choice);
  if (!opened) return opened.status();
  if (opened->program)
    return refuse(Error{.code = Code::malformed_value,
                        .sentence = fmt::format("expected a Wale file, found the patch program `{}`", opened->name),
                        .mend = "leave out --all, or name the Wale file that it was built from",
                        .place = {.name = "--all"}});
  print_diagnostics(stderr, opened->diagnostics, opened->sources);
  const auto collection = build_all(*opened, options.choice.recording_request(), options.out, *options.choice.inputs,
                                    options.stage.empty() ? as_patch_program() : as_cpp_header(options.live));
  if (!collection) return refuse(collection.error());
  for (const auto& built : collection->materials) {
    print_diagnostics(stderr, built.diagnostics, opened->sources);
    if (!built.written) refuse(built.written.error());
    if (built.path.empty())
      refuse(fmt::format("`{}` is not built", built.material));
    else
      print_out("{}  {}\n", visible_text(built.path), readable("{} bytes", built.bytes));
  }
  const std::size_t all = collection->materials.size(), built = collection->built();
  print_out("{} of {} material{} built\n", built, all, all == 1 ? "" : "s");
  return built == all ? done : refused;
}

int build(const BuildOptions& options) {
  const bool as_cpp = options.stage == "cpp";
  if (!options.live.empty() && !as_cpp)
    return refuse(Error{.code = Code::malformed_value,
                        .sentence = "only C++ has live parts",
                        .mend = "leave out --live, or add --emit cpp",
                        .place = {.name = "--live"}});
  if (options.all && !options.stage.empty() && !as_cpp)
    return refuse(Error{.code = Code::malformed_value,
                        .sentence = fmt::format("with --all only C++ can be written, found `{}`", options.stage),
                        .mend = "leave out --all, or write --emit cpp",
                        .place = {.name = "--emit", .text = options.stage}});
  if (!options.stage.empty() && !options.all) return show_stage(options);
  if (options.out.empty())
    return refuse(
        Error{.code = Code::malformed_value,
              .sentence = fmt::format("expected the name of the {} to write", options.all ? "folder" : "file"),
              .mend = options.all ? "for example, `wale build my.wale --all -o programs`"
                                  : "for example, `wale build corduroy -o corduroy.wpp`",
              .place = {.name = "-o"}});
  if (!options.workspace.empty()) return build_workspace(options);
  return options.all ? build_collection(options) : build_one(options);
}

Run declare_build(CLI::App& verb) {
  const auto options = std::make_shared<BuildOptions>();
  offer_material(verb, options->choice);
  must_say(offer_output(verb, options->out,
                        "the patch program to write, as in corduroy.wpp; with --all, a folder for them; with --emit, "
                        "the file for the text, which otherwise goes to standard output"),
           "the name of the file or folder to write", "for example, `wale build corduroy -o corduroy.wpp`");
  verb.add_flag("--all", options->all,
                "builds every material of the file, each to NAME.wpp in the folder; with --emit cpp, to NAME.hpp")
      ->excludes("--material");
  must_say(verb.add_option("--workspace", options->workspace,
                           "builds a workspace of the file with all its patches, to one file, NAME.wws")
               ->type_name("NAME"),
           "the name of a workspace")
      ->excludes("--material")
      ->excludes("--all");
  propose(verb.add_option("--emit", options->stage,
                          "writes the output of a stage instead: tree (as parsed), checked, ir (its values), "
                          "listing (its instructions), cpp (a C++17 header for firmware)")
              ->type_name("STAGE")
              ->excludes("--workspace"),
          {"tree", "checked", "ir", "listing", "cpp"});
  verb.add_option("--live", options->live,
                  "with --emit cpp: the parameters that stay adjustable, separated by commas; size: the patch's size; "
                  "all: everything. The rest is computed when the header is written")
      ->type_name("NAME,...")
      ->delimiter(',');
  verb.footer(
      "for example: wale build corduroy -o corduroy.wpp;  wale build my.wale --all -o programs;  "
      "wale build corduroy --emit cpp --live roughness -o corduroy.hpp");
  return [options] { return build(*options); };
}

}  // namespace

extern const Verb build_verb{"build", "compiles a material to a patch program, or shows the output of a stage",
                             declare_build};

}  // namespace wale::command
