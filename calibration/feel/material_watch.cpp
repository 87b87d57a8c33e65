#include "calibration/feel/material_watch.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <utility>

#include "compiler/diagnostics/render.hpp"
#include "compiler/modules/load_modules.hpp"
#include "compiler/quantity.hpp"
#include "compiler/text/readable.hpp"
#include "schema/built_for.hpp"
#include "schema/visible_text.hpp"
#include "schema/without_place.hpp"

namespace wale {

namespace {

/// A value in a parameter's own unit: "1.5 N".
std::string in_its_unit(const Parameter& parameter, double value) {
  return readable("{:.6g}{}{}", value / parameter.unit_in_si, parameter.unit.empty() ? "" : " ", parameter.unit);
}

}  // namespace

MaterialWatch::MaterialWatch(command::Choice choice, Patch patch, const Program& felt,
                             std::vector<std::string> settings, std::function<void(const std::string&)> say)
    : choice_(std::move(choice)),
      patch_(std::move(patch)),
      settings_(std::move(settings)),
      say_(std::move(say)),
      felt_(write_patch_program(felt.description())),
      device_(felt.description().device) {}

MaterialWatch::Outcome MaterialWatch::attend(std::chrono::milliseconds wait) {
  if (std::exchange(begun_, true) && !files_.changed(wait)) return Outcome::nothing;
  return look();
}

MaterialWatch::Outcome MaterialWatch::look() {
  std::vector<std::string> looked_for;
  FileRequest request = choice_.request();
  request.looked_for = &looked_for;
  Result<OpenedFile> opened = OpenedFile{};
  std::optional<Program> program;
  do {
    looked_for.clear();
    opened = open_file(request);
    if (opened) program = opened->program;
    if (opened && opened->module && !opened->diagnostics.has_errors())
      program = compile_opened(*opened, request, choice_.material, opened->diagnostics);
    looked_for.push_back(opened ? opened->name : choice_.file);
  } while (files_.follow(looked_for));  // again if a folder was not watched while its file was read

  if (!opened) {
    Error error = opened.error();
    if (error.code == Code::unreadable_file) error.mend = "save it again, or end with Ctrl-C";
    return refuse(fmt::format("wale: {}\n", command::error_text(error)));
  }
  std::string said;
  for (const auto& diagnostic : opened->diagnostics.all())
    said += render_text(diagnostic, opened->sources, isatty(fileno(stderr)) != 0) + "\n";
  if (!program || opened->diagnostics.has_errors()) return refuse(said);
  const PatchProgram& now = program->description();
  if (now.device.name != device_.name)
    return refuse(fmt::format("wale: `{}` is now built for `{}`, but the device is a `{}`\n", now.material,
                              now.device.name, device_.name));
  if (const auto built = is_built_for(now, device_); !built)
    return refuse(fmt::format("wale: {}\n", command::error_text(built.error())));
  auto bytes = write_patch_program(now);
  const bool was_refused = !std::exchange(refused_, {}).empty();
  if (bytes == felt_) {
    if (was_refused) say_(fmt::format("wale: this version of `{}` is active already\n", now.material));
    return Outcome::nothing;
  }
  if (const auto done = patch_.replace(*program); !done)
    return refuse(fmt::format("wale: {}\n", in_words(done.error())));
  felt_ = std::move(bytes);
  ++versions_;
  wait_until_felt();
  say_(said + apply_settings(now) + fmt::format("wale: the new version of `{}` is active\n", now.material));
  return Outcome::replaced;
}

/// Only the memory of the tick that serves the patch tells which version it has. A run that begins later, or has ended,
/// serves none.
void MaterialWatch::wait_until_felt() const {
  constexpr int most_looks = 100;  // each takes a period or two
  for (int looks = 0; looks < most_looks; ++looks) {
    const auto now = patch_.snapshot();
    if (!now || write_patch_program(now->bank.program().description()) == felt_) return;
  }
}

/// Sets the parameters of the version on the stage as the person has set those of the first one. Returns what is new
/// about settings that cannot hold, in lines.
std::string MaterialWatch::apply_settings(const PatchProgram& now) {
  std::string news;
  for (const std::string& setting : settings_) {
    const std::string name = command::setting_name(setting);
    const auto parameter = std::ranges::find(now.parameters, name, &Parameter::name);
    std::string said;
    if (parameter == now.parameters.end()) {
      said = fmt::format("`{}` is gone: `--set {}` has no effect", name, setting);
    } else if (const auto meant = read_parameter_anyway(common_modules()->declarations, "--set", *parameter,
                                                        setting.substr(setting.find('=') + 1));
               !meant) {
      said = fmt::format("`--set {}` does not fit `{}` now: {}", setting, name, meant.error().sentence);
    } else {
      const float used = std::clamp(static_cast<float>(*meant), parameter->low, parameter->high);
      if (used != static_cast<float>(*meant))
        said = readable("`--set {}` is outside {:.6g} .. {} now: {} is used", setting,
                        parameter->low / parameter->unit_in_si, in_its_unit(*parameter, parameter->high),
                        in_its_unit(*parameter, used));
      if (const auto set = patch_.set(name, used); !set) said = in_words_without_place(set.error());
    }
    if (std::exchange(said_of_settings_[setting], said) != said && !said.empty())
      news += fmt::format("wale: {}\n", visible_text(said));
  }
  return news;
}

MaterialWatch::Outcome MaterialWatch::refuse(std::string why) {
  if (why != refused_) say_(why + "wale: the previous version stays active\n");
  refused_ = std::move(why);
  return Outcome::refused;
}

}  // namespace wale
